"""What is refused changes nothing; of two clicks on one state one is done."""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, cast

import pytest

from rig.console.desk import ActDesk
from rig.console.gate import Answer, Gate
from rig.console.link import Link
from rig.station.status import Status


class Station:
    """The web process's end of the line, to a station that answers `says` once it is let to."""

    def __init__(self, says: str = "") -> None:
        self.picture = Status().picture()
        self.alive, self.says = True, [says]  # in order; to what comes after them yes
        self.events: list[dict[str, Any]] = []
        self.asked: list[str] = []
        self.lets = asyncio.Event()
        self.lets.set()
        self.told = 0

    async def act(self, message: dict[str, Any]) -> str:
        self.asked.append(message["act"])
        await self.lets.wait()
        return self.says.pop(0) if self.says else ""

    async def press(self, name: str) -> None:
        self.asked.append(name)

    def changed(self) -> None:
        self.told += 1


def desk(station: Station) -> ActDesk:
    return ActDesk(cast(Link, station), Gate(), "twin")


def act(act: str, based_on: int = 1, **more: Any) -> dict[str, Any]:
    return {"id": str(uuid.uuid4()), "act": act, "based_on": based_on, **more}


def with_desk(story: Callable[[ActDesk, Station], Coroutine[Any, Any, None]], says: str = "") -> None:
    async def told() -> None:
        station = Station(says)
        await story(desk(station), station)

    with ThreadPoolExecutor(1) as pool:  # a browser under test leaves a loop running in this thread
        pool.submit(asyncio.run, told()).result()


@pytest.mark.parametrize(("refused", "says"), [
    (act("connect", bench="absent.toml"), ""),  # there is no such file
    (act("connect", clock="sun"), ""),
    (act("check"), "busy: connecting"),  # by the station
    (act("connect", bench=None), "a bench is connected: disconnect it first"),
])  # fmt: skip
def test_a_refused_act_takes_no_control_and_makes_no_new_revision(refused: dict[str, Any], says: str) -> None:
    async def story(desk: ActDesk, station: Station) -> None:
        said = await desk.act(refused, "first")
        assert (said.status, said.body["revision"]) == (409, 1)
        assert (desk.gate.controller, desk.gate.revision, station.told) == (None, 1, 0)
        station.says.clear()
        assert (await desk.act(act("check"), "second")).status == 200  # on the same revision, by another page
        assert (desk.gate.controller, desk.gate.revision) == ("second", 2)

    with_desk(story, says)


def test_of_two_clicks_on_one_state_one_is_done_though_the_first_is_still_being_decided() -> None:
    async def story(desk: ActDesk, station: Station) -> None:
        station.lets.clear()
        both = [asyncio.ensure_future(desk.act(act("check"), "first")) for _ in range(2)]
        await turns()
        assert station.asked == ["check"]
        station.lets.set()
        first, second = await asyncio.gather(*both)
        assert (first.status, second.status) == (200, 409)
        assert "the state has changed" in second.body["why"]
        assert station.asked == ["check"]

    with_desk(story)


def test_a_second_click_is_done_where_the_first_was_refused() -> None:
    async def story(desk: ActDesk, station: Station) -> None:
        station.lets.clear()
        both = [asyncio.ensure_future(desk.act(act("check"), "first")) for _ in range(2)]
        await turns()
        station.lets.set()
        assert [a.status for a in await asyncio.gather(*both)] == [409, 200]

    with_desk(story, "busy: connecting")


def test_a_new_revision_that_the_station_told_of_is_not_told_twice() -> None:
    async def story(desk: ActDesk, station: Station) -> None:
        station.lets.clear()
        asked = asyncio.ensure_future(desk.act(act("check"), "first"))
        await turns()
        desk.gate.passed()  # as `look` does, of a picture that says what is being done
        station.lets.set()
        assert (await asked).body["revision"] == 2

    with_desk(story)


def test_a_page_that_takes_control_keeps_it_though_an_act_of_another_was_under_way() -> None:
    async def story(desk: ActDesk, station: Station) -> None:
        station.lets.clear()
        slow = asyncio.ensure_future(desk.act(act("check"), "first"))
        await turns()
        taken = await desk.act(act("take_control"), "second")  # waits for nobody
        held = await desk.act(act("hold"), "second")
        station.lets.set()
        assert [a.status for a in (taken, held, await slow)] == [200, 200, 200]
        assert desk.gate.controller == "second"

    with_desk(story)


def test_the_same_id_under_way_is_done_once() -> None:
    async def story(desk: ActDesk, station: Station) -> None:
        station.lets.clear()
        body = act("check")
        both: list[asyncio.Future[Answer]] = [asyncio.ensure_future(desk.act(body, "first")) for _ in range(2)]
        await turns()
        station.lets.set()
        first, second = await asyncio.gather(*both)
        assert first == second
        assert station.asked == ["check"]

    with_desk(story)


async def turns() -> None:
    """Everything that can go on goes on."""
    for _ in range(20):
        await asyncio.sleep(0)
