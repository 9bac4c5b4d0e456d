"""Between any two riggings the changes lead from one to the other, and load nothing on the way that must not be."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from rig.campaign.changes import ByHand, changes_between, deeds
from rig.core.operator import FreeOutput, HangWeight, LockOutput, Reassemble, Rigging
from tests.campaign.plans import LOADED, LOCKED, REST, campaign

LOADS = st.sampled_from([0.0, 2.5, -15.0])
DEPTHS = st.sampled_from([0.0, 0.3])


@st.composite
def riggings(draw: st.DrawFn, assembly: int) -> Rigging:
    locked = draw(st.booleans())
    return Rigging(0.0 if locked else draw(LOADS), locked, draw(DEPTHS), assembly)


@given(riggings(assembly=1), st.integers(1, 2).flatmap(lambda n: riggings(assembly=n)))
def test_they_lead_where_they_should_and_never_load_a_pin_or_an_open_gear(now: Rigging, wanted: Rigging) -> None:
    if wanted.assembly == now.assembly and wanted.depth_mm != now.depth_mm:
        return  # a depth changes only with the assembly
    for change in changes_between(now, wanted):
        match change:
            case LockOutput():
                assert now.tau_ext == 0.0
            case HangWeight() | Reassemble():
                assert not now.output_locked
        if isinstance(change, Reassemble):
            assert now.tau_ext == 0.0
        now = change.applied(now)
    assert now == wanted


@given(riggings(assembly=1))
def test_nothing_is_asked_for_where_nothing_changes(now: Rigging) -> None:
    assert changes_between(now, now) == []


def test_from_one_weight_to_the_next_is_one_change() -> None:
    assert changes_between(Rigging(tau_ext=2.0), Rigging(tau_ext=5.0)) == [HangWeight(5.0)]


def test_a_campaign_leaves_the_rig_bare() -> None:
    done = deeds(list(enumerate(campaign(REST, LOADED, LOCKED).items)), Rigging())
    by_hand = [deed.change for deed in done if isinstance(deed, ByHand)]
    assert by_hand == [HangWeight(2.0), HangWeight(0.0), LockOutput(), FreeOutput()]
