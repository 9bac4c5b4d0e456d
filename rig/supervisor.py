"""The states of the rig and the one table of what may follow what. Faults latch; only an explicit reset leaves them."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum

from rig.core.errors import NotReady

UNCONFIRMED = "the drive did not confirm that its torque is off"  # of a fault: there may be torque still
KEEP_CLEAR = "keep clear of it"  # of what turns on or is wound up without the motor's torque: it is ready for nothing
PRESS = "press the hard-wired stop, there may be torque still"


class State(StrEnum):
    """What the rig may do now."""

    DISCONNECTED = "disconnected"
    CONNECTED = "connected"  # readable, nothing energised
    READY = "ready"  # checks passed
    ENABLED = "enabled"  # energised, torque zero
    RUNNING = "running"  # a procedure commands it
    HOLDING = "holding"  # at rest, energised, held where it is; what ran is not gone on with
    STOPPING = "stopping"  # being brought to rest, then torque off
    FAULT = "fault"  # torque-free, latched


class Act(StrEnum):
    """What can happen to it."""

    CONNECT = "connect"
    CHECK = "check"  # all checks passed
    ENABLE = "enable"
    RUN = "run"
    HOLD = "hold"  # category 2: to rest, held, torque on
    STOP = "stop"  # category 1: to rest, then torque off
    HALT = "halt"  # category 0: torque off now
    FINISH = "finish"  # the procedure or the stop is over, torque off
    TRIP = "trip"
    RESET = "reset"
    DISCONNECT = "disconnect"


_S, _A = State, Act
TABLE: dict[tuple[State, Act], State] = {
    (_S.DISCONNECTED, _A.CONNECT): _S.CONNECTED,
    (_S.CONNECTED, _A.CHECK): _S.READY,
    (_S.READY, _A.ENABLE): _S.ENABLED,
    (_S.ENABLED, _A.RUN): _S.RUNNING,
    (_S.ENABLED, _A.FINISH): _S.READY,
    (_S.RUNNING, _A.HOLD): _S.HOLDING,
    (_S.HOLDING, _A.HOLD): _S.HOLDING,
    (_S.HOLDING, _A.STOP): _S.STOPPING,
    (_S.HOLDING, _A.FINISH): _S.READY,
    (_S.RUNNING, _A.STOP): _S.STOPPING,
    (_S.RUNNING, _A.FINISH): _S.READY,
    (_S.STOPPING, _A.STOP): _S.STOPPING,
    (_S.STOPPING, _A.FINISH): _S.READY,
    (_S.FAULT, _A.RESET): _S.CONNECTED,  # checks have to be passed again: never straight back to running
    **{(s, _A.TRIP): _S.FAULT for s in State},
    **{(s, _A.HALT): _S.READY for s in (_S.READY, _S.ENABLED, _S.RUNNING, _S.HOLDING, _S.STOPPING)},
    (_S.CONNECTED, _A.HALT): _S.CONNECTED,
    (_S.DISCONNECTED, _A.HALT): _S.DISCONNECTED,
    (_S.FAULT, _A.HALT): _S.FAULT,
    **{(s, _A.DISCONNECT): _S.DISCONNECTED for s in State if s is not _S.FAULT},
    (_S.FAULT, _A.DISCONNECT): _S.FAULT,  # pulling the cable does not clear a fault
}


class Supervisor:
    """Holds the state; every change goes through the table and is announced.

    `causes` says, in words, what is still wrong with the devices: while anything is, a reset is refused.
    """

    def __init__(
        self,
        announce: Callable[[State, Act, str], None] = lambda state, act, why: None,
        causes: Callable[[], str] = lambda: "",
    ) -> None:
        self.state = State.DISCONNECTED
        self.fault = ""  # why it latched, in words
        self.announce = announce
        self.causes = causes

    def act(self, act: Act, why: str = "") -> State:
        """Make the change. Raises NotReady, and changes nothing, when the table has no such row, or when the fault to
        be reset is still there. A rig that is connected in fault is in FAULT from the start.
        """
        following = TABLE.get((self.state, act))
        if following is None:
            possible = ", ".join(sorted(a for s, a in TABLE if s is self.state))
            raise NotReady(f"cannot {act} while {self.state}; possible now: {possible}")
        if act is Act.RESET and (why_not := self.causes()):
            raise NotReady(f"the fault stays: {why_not}")
        if act is Act.TRIP and self.state is not State.FAULT:
            self.fault = why  # the first cause stays; what follows from it does not replace it
        if act is Act.RESET:
            self.fault = ""
        if following is not self.state:
            self.state = following
            self.announce(following, act, why)
        if act is Act.CONNECT and (wrong := self.causes()):
            return self.act(Act.TRIP, wrong)
        return self.state

    def amend(self, seen: str) -> None:
        """What was `seen` since, behind the fault that latched: its cause stays. Raises NotReady without a fault."""
        if self.state is not State.FAULT:
            raise NotReady(f"there is no fault to say more of while {self.state}")
        self.fault += seen
        self.announce(self.state, Act.TRIP, self.fault)
