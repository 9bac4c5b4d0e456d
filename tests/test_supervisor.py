"""The one table of states: every pair of state and act either moves as written or is refused and changes nothing."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.core.errors import NotReady
from rig.supervisor import TABLE, Act, State, Supervisor

ENERGISED = {State.ENABLED, State.RUNNING, State.HOLDING, State.STOPPING}


@pytest.mark.slow
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


def test_a_fault_is_told_in_more_words_and_what_is_none_is_not_made_one() -> None:
    supervisor = Supervisor()
    with pytest.raises(NotReady, match="no fault to say more of"):
        supervisor.amend("; the motor turns on")
    assert supervisor.fault == ""
    supervisor.act(Act.TRIP, "motor too fast")
    supervisor.amend("; the motor turns on")
    assert supervisor.fault == "motor too fast; the motor turns on"


def test_every_change_is_announced_once() -> None:
    seen: list[State] = []
    supervisor = Supervisor(lambda state, act, why: seen.append(state))
    for act in (Act.CONNECT, Act.CHECK, Act.ENABLE, Act.RUN, Act.STOP, Act.STOP, Act.FINISH):
        supervisor.act(act)
    assert seen == [State.CONNECTED, State.READY, State.ENABLED, State.RUNNING, State.STOPPING, State.READY]


HOLDS = [  # (from, act, to): a hold is left by a stop, a halt, a trip or its end; never back to what ran
    (State.RUNNING, Act.HOLD, State.HOLDING),
    (State.HOLDING, Act.HOLD, State.HOLDING),
    (State.HOLDING, Act.STOP, State.STOPPING),
    (State.HOLDING, Act.HALT, State.READY),
    (State.HOLDING, Act.FINISH, State.READY),
    (State.HOLDING, Act.TRIP, State.FAULT),
    (State.HOLDING, Act.DISCONNECT, State.DISCONNECTED),
]


@pytest.mark.parametrize(("before", "act", "after"), HOLDS)
def test_a_hold_is_an_act_beside_stop_and_halt(before: State, act: Act, after: State) -> None:
    supervisor = Supervisor()
    supervisor.state = before
    assert supervisor.act(act) is after


def test_the_table_has_no_other_way_into_or_out_of_a_hold() -> None:
    rows = {(s, a, t) for (s, a), t in TABLE.items() if State.HOLDING in (s, t)}
    assert rows == set(HOLDS)


def test_a_rig_connected_in_fault_is_in_fault_from_the_start_and_says_why() -> None:
    wrong = ["under-voltage"]
    supervisor = Supervisor(causes=lambda: wrong[0])
    assert supervisor.act(Act.CONNECT) is State.FAULT
    assert supervisor.fault == "under-voltage"
    for act in (Act.CHECK, Act.ENABLE, Act.RUN, Act.HOLD, Act.STOP, Act.FINISH, Act.CONNECT):
        with pytest.raises(NotReady, match="possible now"):
            supervisor.act(act)


def test_a_fault_is_left_by_a_reset_once_its_causes_are_gone_and_not_by_their_going() -> None:
    wrong = ["under-voltage"]
    supervisor = Supervisor(causes=lambda: wrong[0])
    supervisor.act(Act.CONNECT)
    with pytest.raises(NotReady, match="the fault stays: under-voltage"):
        supervisor.act(Act.RESET)
    wrong[0] = ""
    assert supervisor.state is State.FAULT
    assert supervisor.act(Act.RESET) is State.CONNECTED
    assert supervisor.fault == ""
