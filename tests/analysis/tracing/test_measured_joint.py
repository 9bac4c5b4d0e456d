"""One measured run of a robot's joint, whose torque is a model of the arm: much is left. The arm's weight is
named, what is put in is given back where the run can tell it, and no other name is made up."""

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.trace import trace
from rig.core.errors import UsageError
from tests.studies.lara8 import friction, imported, runout, spiked, steps, traced

ARM = {"gravity_unbalance"}  # the arm's weight, which the baseline has no term for


@pytest.mark.slow
@pytest.mark.long
def test_the_weight_is_named_and_what_is_left_goes_with_the_angle_of_the_joint(shared: Path, tmp_path: Path) -> None:
    """Nor is a wave in angle named, though it takes all that is left there: under the arm's weight it is one with the
    spring, whose stiffness it makes four times what the catalogue of the gear says."""
    d = traced(imported(tmp_path))
    verdict = d["verdict"]
    assert (verdict["status"], verdict["coordinate"]) == ("unknown_effect", "load_angle")
    assert set(verdict["effects"]) == ARM
    low, high = d["baseline"]["parameters"]["K"]["ci95"]
    assert low < 37_000 < high  # N·m/rad, the slope of torsion over torque


def test_a_log_of_two_seconds_is_refused_with_what_is_missing(shared: Path, tmp_path: Path) -> None:
    campaign = imported(tmp_path)
    samples = next(campaign.glob("**/samples.parquet"))
    samples.parent.chmod(0o755)
    samples.chmod(0o644)
    pq.write_table(pq.read_table(samples).slice(0, 500), samples)
    with pytest.raises(UsageError, match=r"lasts 1\.\d s, 1\d\d rows at \d+ Hz, expected at least 250"):
        trace(campaign)


def test_a_campaign_that_is_called_here_has_its_folders_name(
    shared: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    campaign = imported(tmp_path)
    monkeypatch.chdir(campaign)
    assert read_campaign(Path()).name == campaign.name


@pytest.mark.long
def test_friction_of_an_order_that_was_put_in_is_given_back(shared: Path, tmp_path: Path) -> None:
    d = traced(spiked(imported(tmp_path), tmp_path / "spiked", friction, 0.3))
    assert set(d["verdict"]["effects"]) == ARM | {"position_dependent_friction"}
    low, high = d["effects"]["position_dependent_friction"]["parameters"]["order_3_amplitude"]["ci95"]
    assert low < 0.3 < high


@pytest.mark.slow
@pytest.mark.long
def test_a_large_runout_is_named_beside_a_rest(shared: Path, tmp_path: Path) -> None:
    d = traced(spiked(imported(tmp_path), tmp_path / "spiked", runout, 2e-3))
    assert set(d["verdict"]["effects"]) == ARM | {"output_once_per_rev"}
    # where nine tenths are explained the verdict may be either; what stays stands in the document and in the report
    assert d["verdict"]["status"] in ("unknown_effect", "explained")
    assert max(d["residual"]["over_floor_after"].values()) > 2.0


@pytest.mark.long
def test_no_effect_is_named_where_a_channel_it_acts_in_is_not_explained(shared: Path, tmp_path: Path) -> None:
    verdict = traced(spiked(imported(tmp_path), tmp_path / "spiked", steps, 5e-4))["verdict"]
    assert verdict["status"] == "unknown_effect"
    assert set(verdict["effects"]) == ARM
