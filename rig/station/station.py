"""One process, one thread, one bench: takes acts while nothing runs, watches the line while something does."""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, final

from rig.core.errors import HdrigError, NotReady, with_notes
from rig.core.operator import Change
from rig.core.way_out import internal
from rig.live.switches import Counts, Switches
from rig.session import Session
from rig.station.analysis import Analysis
from rig.station.chain import SILENT_DRIVE, Chain
from rig.station.channel import Channel
from rig.station.interrupts import Panel
from rig.station.person import PagePerson
from rig.station.rules import why_not
from rig.station.silence import Silence
from rig.station.status import Status
from rig.station.telling import Teller
from rig.supervisor import UNCONFIRMED, Act, State

IDLE = 0.05  # s between two readings while nothing runs: 20 a second
WORDS = {
    "connect": "connecting",
    "disconnect": "disconnecting",
    "check": "checking machine, bus and bench",
    "prove": "sign-and-scale proof",
    "tare": "taring the torque sensor",
    "start": "starting a run",
    "campaign": "planning the campaign",
    "reset": "resetting the fault",
}  # what is being carried out, until the job itself says more
WAKES = ("hold", "stop", "halt")  # the switches say what; the packet only wakes

LATCHED = " (latched before the bench was disconnected)"

Job = Callable[["Station", Mapping[str, Any]], None]


def forget(text: str) -> None:
    """There is no campaign whose book it would go into."""


@final
class Station:
    """`serve` until told to close, or the other end of the line is gone and nothing runs any more."""

    def __init__(self, channel: Channel, switches: Switches, panel: Panel, root: Path, jobs: Mapping[str, Job]) -> None:
        self.channel, self.switches, self.panel, self.root, self.jobs = channel, switches, panel, root, jobs
        self.status = Status()
        self.teller = Teller(channel, switches, self.status, self.watch)
        self.session: Session | None = None
        self.stack = contextlib.ExitStack()  # leaving it takes the torque off and lets go of the devices
        self.person: PagePerson | None = None
        self.analysis: Analysis | None = None
        self.chain, self.silence = Chain(), Silence()
        self.latched: dict[str, str] = {}  # the fault that a bench was let go of in, by its name
        self.closing = False
        self.keep: Callable[[str], None] = forget  # where a note goes that no run may follow
        self._next_reading = 0.0
        self._halts = switches.pressed.halt

    # ---- idle ----

    def serve(self) -> None:
        """Acts, one after the other."""
        self.teller.tell()
        try:
            while not (self.closing or self.channel.closed or self.panel.signalled):
                self.attend(self.take)
        finally:
            if self.analysis is not None:
                self.analysis.end()
            self.disconnect()

    def attend(self, take: Callable[[Mapping[str, Any]], None] | None = None) -> None:
        """Whatever there is to do while the loop does not run, for at most 50 ms; acts go to `take`."""
        pause = max(self._next_reading - time.monotonic(), 0.001)
        for message in self.channel.receive(min(pause, IDLE)):
            (take or self.meanwhile)(message)
        self.channel.flush()
        self._halted()
        self._analysed()
        if self.session is not None and time.monotonic() >= self._next_reading:
            self._next_reading = time.monotonic() + IDLE
            self._read(self.session)

    def _read(self, session: Session) -> None:
        instruments = session.instruments
        clock = instruments.clock
        if instruments.latch is not None:
            instruments.latch()
        sample = instruments.read(clock.wait_until(clock.now() + instruments.lead))
        heard = self.silence.hear(sample, clock.now())
        self.teller.idle(heard, clock.now())
        self._look_at_chain(session, energised=False, silent=math.isnan(heard.theta_m))

    def _look_at_chain(self, session: Session, energised: bool, silent: bool = False) -> None:
        seen = SILENT_DRIVE if silent else self.chain.judge(session.instruments.drive.voltage, energised)
        if seen != self.status.chain:
            self.status.chain = seen
            self.teller.tell()

    def _halted(self) -> None:
        """Halt while nothing runs: nothing should be energised, and it is taken off all the same."""
        pressed = self.switches.pressed
        if pressed != self.switches.seen:
            self.switches.tell_seen(pressed)
        if pressed.halt == self._halts:
            return
        self._halts = pressed.halt
        if self.session is None:
            return
        if self.session.instruments.safe():
            self.teller.say("operator", "halted while nothing ran: torque off, confirmed by the drive")
        else:
            self.teller.say("error", "halted while nothing ran: TORQUE OFF NOT CONFIRMED by the drive: hard-wired stop")
            self.session.supervisor.act(Act.TRIP, f"halted while nothing ran; {UNCONFIRMED}")

    def _analysed(self) -> None:
        done, last = self.analysis, self.status.last_run
        if done is None or not done.done:
            return
        self.analysis, found = None, done.found()
        if last is not None and last["folder"] == str(done.folder):
            self.status.last_run = last | found
        self.teller.say("finding", str(found["sentence"]))
        self.teller.tell()

    # ---- acts ----

    def take(self, message: Mapping[str, Any]) -> None:
        """One act while nothing runs: refused with a sentence, or accepted and carried out."""
        act = str(message.get("act"))
        if act in WAKES:
            return
        if act == "close":
            self.closing = True
            return
        why = self._too_late(message) or why_not(act, self._picture())
        if why:
            self._reply(message, why)
        else:
            self._carry_out(self.jobs[act], message)

    def meanwhile(self, message: Mapping[str, Any]) -> None:
        """One act while another is carried out: notes and answers are taken, the end is noted, all else is refused."""
        act = str(message.get("act"))
        if act in WAKES:
            return
        if act == "close":
            self.closing = True
            return
        why = self._too_late(message) or why_not(act, self._picture())
        if not why and act == "answer" and self.person is not None:
            why = self.person.answer(str(message.get("prompt_id")), bool(message.get("done")))
        elif not why and act == "note":
            self.note(str(message.get("text", "")))
        self._reply(message, why)

    @staticmethod
    def _too_late(message: Mapping[str, Any]) -> str:
        """An act nobody waits for any more: whoever asked was told that it is not done."""
        late = time.monotonic() > float(message.get("until") or "inf")
        return "it was asked for too long ago" if late else ""

    def watch(self) -> None:
        """Called within a tick now and then: reads what has come, never waits."""
        for message in self.channel.receive():
            self.meanwhile(message)
        self.channel.flush()
        if self.channel.closed:
            self.panel.left_alone()
        if self.session is not None:
            self._look_at_chain(self.session, energised=True)

    def note(self, text: str) -> None:
        """What somebody has to say, into the run's events, or the next one's; said while a hand is waited for it goes
        into the campaign's book as well: that may have been the last run.
        """
        if self.session is None:
            return
        self.session.log.event("note", text)
        if self.status.prompt is not None:
            self.keep(text)

    def _carry_out(self, job: Job, message: Mapping[str, Any]) -> None:
        pressed = message.get("pressed") or self.switches.pressed
        self._halts, last = self.switches.pressed.halt, self.status.last_run
        self.panel.arm(Counts(*pressed), self._patience())
        self.busy(WORDS.get(str(message["act"]), str(message["act"])))
        self._reply(message, "")  # after the picture that says so: whoever has it sees a station that is busy
        try:
            job(self, message)
        except HdrigError as error:
            self.teller.say("refused", with_notes(error))
        except Exception as error:  # noqa: BLE001  a defect of ours in one act lets go of no bench, and ends no station
            self._broke_off(error)
        finally:
            self.panel.disarm()
            if self.status.last_run is not last:  # a run saw it: what was halted is not halted again
                self._halts = self.switches.pressed.halt
            self.status.job, self.status.campaign, self.status.run = "", None, None
            self.told()

    def _broke_off(self, error: Exception) -> None:
        """Torque off, and the sentence that the command line would end with."""
        told = "; ".join([internal(error), *getattr(error, "__notes__", [])])
        if self.session is not None and not self.session.instruments.safe():
            told = f"{told}; TORQUE OFF NOT CONFIRMED by the drive: hard-wired stop"
            self.session.supervisor.act(Act.TRIP, f"{internal(error)}; {UNCONFIRMED}")
        self.teller.say("error", told)

    def _patience(self) -> float:
        """s without a page after which a run is stopped."""
        if self.session is None:
            return float("inf")
        console = self.session.bench.file.console
        return console.page_lost_s if console.page_lost == "stop" else float("inf")

    def _reply(self, message: Mapping[str, Any], why: str) -> None:
        self.channel.post({"kind": "reply", "id": message.get("id"), "why": why})

    def _picture(self) -> dict[str, Any]:
        if self.teller.supervisor is not None:
            self.status.state = str(self.teller.supervisor.state)
        return self.status.picture()

    def told(self) -> None:
        """What the session knows, into the picture, and out."""
        session, status = self.session, self.status
        if session is not None:
            status.rigging, status.unsure = session.rigging.conditions(), session.unsure
            status.proof = session.proof.sentence if session.proof else None
            status.tare = session.zero.sentence if session.zero else None
        self.teller.tell()

    def busy(self, job: str) -> None:
        """What is being carried out, in words."""
        self.status.job = job
        self.told()

    # ---- the bench ----

    def need(self) -> Session:
        """The session there is. Raises NotReady."""
        if self.session is None:
            raise NotReady("no bench is connected")
        return self.session

    def connected(self, session: Session) -> None:
        """A session that was entered on `stack`."""
        self.session, self.chain, self.silence = session, Chain(), Silence()
        self.teller.supervisor = session.supervisor
        hand, session.instruments.operator = session.instruments.operator, None
        self.person = PagePerson(self.teller, self.panel, self.attend, hand)
        session.hand = self.person
        if fault := self.latched.pop(session.bench.file.name, ""):
            session.supervisor.act(Act.TRIP, f"{fault.removesuffix(LATCHED)}{LATCHED}")

    def disconnect(self) -> None:
        """Torque off first, then let go of every device. Idempotent; the act it belongs to goes on until it is over. A
        fault stays with the bench: it is reset by somebody who has seen to the rig, not by connecting anew."""
        session = self.session
        self.stack.close()
        if session is not None and session.supervisor.state is State.FAULT:
            self.latched[session.bench.file.name] = session.supervisor.fault
        self.session = self.person = self.teller.supervisor = None
        known = self.status
        self.status = self.teller.status = Status(job=known.job, last_run=known.last_run, checks=known.checks)
        self.teller.tell()

    @property
    def pending(self) -> Change | None:
        """The change by hand that was asked for and could not be shown."""
        return self.person.asked if self.person is not None and self.need().unsure else None

    def ready(self) -> None:
        """From connected to ready, when every check has passed."""
        if self.session is not None and self.session.supervisor.state is State.CONNECTED:
            self.session.supervisor.act(Act.CHECK)
