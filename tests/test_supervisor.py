"""The one table of states: every pair of state and act either moves as written or is refused and changes nothing."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.core.errors import NotReady
from rig.supervisor import TABLE, Act, State, Supervisor

ENERGISED = {State.ENABLED, State.RUNNING, State.STOPPING}


@given(st.lists(st.sampled_from(list(Act)), max_size=60))
def test_any_sequence_of_acts_keeps_the_promises(acts: list[Act]) -> None:
    supervisor = Supervisor()
    for act in acts:
        before = supervisor.state
        try:
            after = supervisor.act(act, "because")
        except NotReady as refusal:
            assert "possible now" in str(refusal)
            assert supervisor.state is before
            continue
        assert after is TABLE[(before, act)]
        if after in ENERGISED and before not in ENERGISED:
            assert (before, act) == (State.READY, Act.ENABLE)
        if before is State.FAULT and after is not State.FAULT:
            assert (act, after) == (Act.RESET, State.CONNECTED)


@pytest.mark.parametrize("state", list(State))
def test_a_trip_and_a_halt_are_possible_in_every_state_and_twice(state: State) -> None:
    for act in (Act.TRIP, Act.HALT):
        supervisor = Supervisor()
        supervisor.state = state
        supervisor.act(act)
        supervisor.act(act)
        assert supervisor.state not in ENERGISED


def test_the_first_cause_of_a_fault_stays_until_the_reset() -> None:
    supervisor = Supervisor()
    supervisor.act(Act.TRIP, "motor too fast")
    supervisor.act(Act.TRIP, "and then stale")
    assert supervisor.fault == "motor too fast"
    supervisor.act(Act.RESET)
    assert supervisor.fault == ""


def test_every_change_is_announced_once() -> None:
    seen: list[State] = []
    supervisor = Supervisor(lambda state, act, why: seen.append(state))
    for act in (Act.CONNECT, Act.CHECK, Act.ENABLE, Act.RUN, Act.STOP, Act.STOP, Act.FINISH):
        supervisor.act(act)
    assert seen == [State.CONNECTED, State.READY, State.ENABLED, State.RUNNING, State.STOPPING, State.READY]
