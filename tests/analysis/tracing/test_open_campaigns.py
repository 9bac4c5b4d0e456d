"""Campaigns of an independent plant with known truth: nothing where nothing is hidden, the right name where one is."""

from pathlib import Path

import pytest

from rig.analysis.tracing.fit.channels import AT_REVERSALS
from rig.analysis.tracing.outcome.record import document
from rig.analysis.tracing.trace import trace

pytestmark = pytest.mark.slow


def test_a_clean_campaign_misses_nothing(shared: Path) -> None:
    found = trace(shared / "cases" / "open-1")
    assert found.verdict.status == "no_missing_effect"
    assert found.verdict.effects == ()
    all_along = {name: ratio for name, ratio in found.ratios_before.items() if name != AT_REVERSALS}
    assert all(0.9 < ratio < 1.1 for ratio in all_along.values())
    assert found.ratios_before[AT_REVERSALS] < 1.1  # its floor is no repeats', but a bound


@pytest.mark.long
def test_a_late_load_encoder_is_named_with_its_delay(shared: Path) -> None:
    said = document(trace(shared / "cases" / "open-4"))
    assert said["verdict"]["effects"] == ["channel_time_skew"]
    skew = said["effects"]["channel_time_skew"]["parameters"]["skew_theta_l"]
    assert skew["value"] == pytest.approx(0.8836e-3, rel=0.01)  # s, what was hidden
    assert max(said["residual"]["over_floor_after"].values()) < 1.1
