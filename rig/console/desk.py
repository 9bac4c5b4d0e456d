"""What happens to a POST: asked of the gate, then of the station; halt goes straight to the switches.

What is refused changes nothing: control and a new revision come with what is done. That two clicks on one state are not
both done, acts are decided one after the other.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, final

from rig.console.bodies import FORWARDED, OF_CHECK
from rig.console.campaigns import ours
from rig.console.check import WHOLE, check, unread, wrong
from rig.console.gate import CONTROL, Answer, Gate
from rig.console.link import DEAF, Link
from rig.console.state import rights
from rig.core.errors import UsageError
from rig.runfile.manifest import utc_now

PRESSED = ("stop", "halt")  # whatever the id, the page, the revision; the same id again presses again
CLOCKS = ("wall", "virtual", None)  # None: the wall's
LONGEST_TEXT = 2000  # characters of a note


@final
class ActDesk:
    """One for all pages."""

    def __init__(self, link: Link, gate: Gate, offered: str) -> None:
        """`offered`: the bench the server was started for."""
        self.link, self.gate, self.offered = link, gate, offered
        self._under_way: dict[str, tuple[object, asyncio.Future[Answer]]] = {}  # by id: which act
        self._based_on: tuple[object, ...] = ()
        self._turn = asyncio.Lock()

    def look(self) -> None:
        """The station told something: a new revision when it is something that acts are based on."""
        p = self.link.picture
        prompt, run, campaign = p["prompt"] or {}, p["run"] or {}, p["campaign"] or {}
        bench = (p["bench"] or {}).get("source")
        what = (p["state"], p["job"], p["fault"], p["unsure"], bench)
        now = (*what, prompt.get("id"), run.get("uid"), campaign.get("current"), self.link.alive)
        if now != self._based_on:
            self._based_on = now
            self.gate.passed()

    async def act(self, asked: Mapping[str, Any], page: str) -> Answer:
        """Done once per id; the same id again, even while the first is under way, is answered as the first.

        Stop and halt are done each time they come: nobody is kept from stopping a motor for an id.
        """
        act, key = asked.get("act"), str(asked.get("id"))
        if act in PRESSED:
            return self._with_revision(await self._press(str(act)))
        before = self.gate.before(asked)
        if before is not None:
            return self._with_revision(before)
        if key in self._under_way:
            first, answered = self._under_way[key]
            return await asyncio.shield(answered) if first == act else self._with_revision(self.gate.used(first))
        if why := self._against(asked, page):
            return self._with_revision(Answer.no(why))
        waiting: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        self._under_way[key] = (act, waiting)
        try:
            answer = self._with_revision(await self._in_turn(str(act), asked, page))
        except BaseException:
            waiting.cancel()
            raise
        finally:
            del self._under_way[key]
        waiting.set_result(answer)
        return self.gate.remember(asked, answer)

    def _with_revision(self, answer: Answer) -> Answer:
        """The present one, but an answer given before keeps its own."""
        return Answer(answer.status, {"revision": self.gate.revision, **answer.body})

    def _against(self, asked: Mapping[str, Any], page: str) -> str:
        """Why an act does not pass on the state there is now; "" when it does."""
        return self.gate.refuse(asked, page, rights(self.link.picture, self.gate, page))

    async def _in_turn(self, act: str, asked: Mapping[str, Any], page: str) -> Answer:
        """A hold, and who takes control, wait for no other act. Any other one is looked at once more when it is its
        turn: the one before may have been done.
        """
        if act == "hold":
            return await self._press(act)
        if act == CONTROL:
            return self._take_control(page)
        async with self._turn:
            if why := self._against(asked, page):
                return Answer.no(why)
            based_on = self.gate.revision
            why = await self._wrong(act, asked)
            if not why:
                why = await self.link.act({key: asked[key] for key in FORWARDED if key in asked})
            if why:
                return Answer.no(why)
            self._done(page, based_on)
            return Answer.yes()

    def _take_control(self, page: str) -> Answer:
        self.gate.take(page)
        self.gate.passed()
        self.link.events.append({"t": None, "utc": utc_now(), "kind": "said", "text": "another page has taken control"})
        self.link.changed()
        return Answer.yes()

    def _done(self, page: str, based_on: int) -> None:
        """Who had an act done on revision `based_on` holds control, unless another page took it meanwhile; a second
        click is based on what was before the first, also where the station told nothing new.
        """
        if self.gate.holds(page):
            self.gate.take(page)
        if self.gate.revision == based_on:
            self.gate.passed()
        self.link.changed()

    async def _press(self, act: str) -> Answer:
        """Nobody is told that a motor was stopped by a process that is gone."""
        seen = await self.link.press(act)
        return Answer.yes(seen) if self.link.alive else Answer.no(DEAF)

    async def _wrong(self, act: str, asked: Mapping[str, Any]) -> str:
        """What can be said against an act before the station is bothered with it."""
        if act == "note" and not 0 < len(str(asked.get("text") or "").strip()) <= LONGEST_TEXT:
            return f"a note has 1 to {LONGEST_TEXT} characters"
        if act == "connect" and asked.get("clock") not in CLOCKS:
            return f"clock is {str(asked['clock'])[:60]!r}; expected wall or virtual"
        if act == "connect":
            return await asyncio.to_thread(unread, str(asked.get("bench") or ""), asked.get("overrides") or [])
        if act == "answer" and not isinstance(asked.get("done"), bool):
            return "an answer says done: true or false"
        if act == "jog":
            given = {key: asked[key] for key in ("turns", "speed_rpm") if asked.get(key) is not None}
            return await self._problem({"procedure": "jog", "parameters": given})
        if act in ("start", "campaign"):
            return await self._problem({key: asked[key] for key in OF_CHECK if key in asked})
        return ""

    async def _problem(self, asked: Mapping[str, Any]) -> str:
        found = await asyncio.to_thread(self.check, dict(asked))
        return "" if found["ok"] else "; ".join(found["problems"].values())

    def check(self, asked: Mapping[str, Any]) -> dict[str, Any]:
        """As `check.check`, on the bench that is connected, or the one named, or the one the server was started for."""
        if asked.get("resume"):
            try:
                asked = {**asked, "resume": str(ours(self.link.root, asked["resume"]))}
            except UsageError as error:
                return wrong({WHOLE: str(error)})
        bench = self.link.picture["bench"]
        named = asked.get("bench")
        if named is None and bench is not None:
            return check(asked, bench["source"], bench["overrides"])
        return check(asked, str(named or self.offered), [])
