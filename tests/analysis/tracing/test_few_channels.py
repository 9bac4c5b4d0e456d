"""Campaigns that lack sensors, ways or runs: traced without a fault, with what cannot be told in words."""

from __future__ import annotations

import itertools
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.floor import own
from rig.analysis.tracing.outcome.record import document
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.cannot import cannot, together
from rig.analysis.tracing.trace import trace
from rig.core.errors import UsageError
from rig.core.units import RPM, TURN

pytestmark = pytest.mark.xdist_group("few channels")  # what the module makes is made once, not for every worker

FEW = ("slow_ke_1", "slow_ke_2", "load_20nm_1", "speed_120rpm_1", "speed_300rpm_1", "speed_300rpm_2", "lock_60_1")
KEYS = ("schema", "runs", "noise_floor", "baseline", "residual", "candidates", "verdict", "effects", "before", "after")


@pytest.fixture(scope="module")
def open_1(shared: Path) -> Path:
    """The reference campaign whose gear is what the paper's model says."""
    return shared / "cases" / "open-1"


def reduced(to: Path, campaign: Path, runs: Sequence[str], drop: Sequence[str]) -> Path:
    """Some runs of a campaign without some of their columns."""
    for name in runs:
        source, target = campaign / name, to / name
        target.mkdir(parents=True)
        table = pq.read_table(source / "samples.parquet")
        pq.write_table(table.drop_columns(list(drop)), target / "samples.parquet")
        (target / "manifest.json").write_text((source / "manifest.json").read_text())
    return to


def checked(found: Trace) -> Trace:
    """The same, once its document has all keys and holds no number JSON has not."""
    d = document(found)
    assert set(KEYS) <= set(d)
    assert set(d["before"]) == set(d["after"]) == {"per_run", "pooled"}
    json.dumps(d, allow_nan=False)
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("drop", "said"),
    [
        pytest.param(("tau_l",), "No shaft torque", marks=pytest.mark.long),
        pytest.param(("theta_l",), "No load angle", marks=pytest.mark.long),
        pytest.param(("theta_m", "tau_m"), "No motor angle", marks=pytest.mark.long),
        pytest.param(("t",), "No run has a time column", marks=pytest.mark.long),
        pytest.param(("theta_l", "tau_l"), "No load angle", marks=pytest.mark.long),
        pytest.param(("tau_m", "tau_l"), "No motor torque", marks=pytest.mark.long),
    ],
)
def test_a_missing_channel_is_said_and_the_rest_is_traced(
    tmp_path: Path, open_1: Path, drop: tuple[str, ...], said: str
):
    found = checked(trace(reduced(tmp_path, open_1, FEW, drop)))
    assert any(sentence.startswith(said) for sentence in found.cannot)
    assert "channel_time_skew" not in found.verdict.effects


@pytest.mark.slow
def test_without_a_load_encoder_the_torque_at_speed_gives_the_kinematic_error(tmp_path: Path, open_1: Path):
    runs = [*FEW, "speed_200rpm_1", "speed_400rpm_1", "speed_minus400rpm_1"]
    folder = reduced(tmp_path, open_1, runs, ("theta_l",))
    values = prepare(read_campaign(folder), ()).baseline.values
    truth = json.loads((open_1.parent / "TRUTH.json").read_text())["open-1"]
    assert values["a2"] == pytest.approx(truth["kinematic_error_a_rad"][2], rel=0.08)
    assert values["b4"] == pytest.approx(truth["kinematic_error_b_rad"][4], rel=0.25)


LOADS = ("load_10nm_1", "load_40nm_1", "speed_60rpm_1", "speed_200rpm_1", "speed_400rpm_1")


@pytest.mark.slow
@pytest.mark.parametrize(
    "drop", [("theta_l", "tau_l"), ("theta_m",), pytest.param(("theta_m", "tau_l"), marks=pytest.mark.long)]
)
def test_of_a_side_that_nobody_read_orders_are_told_by_slow_runs_under_load(
    tmp_path: Path, open_1: Path, drop: tuple[str, ...]
) -> None:
    """At speed the side that was not read answers them by a resonance that nothing tells; a motor that was not read is
    ahead by the wind-up."""
    p = prepare(read_campaign(reduced(tmp_path, open_1, [*FEW, *LOADS], drop)), ())
    truth = json.loads((open_1.parent / "TRUTH.json").read_text())["open-1"]
    of = {c: np.array(truth[f"kinematic_error_{c}_rad"]) for c in "ab"}
    for order in (2, 4):
        told = complex(*(p.baseline.value(f"{c}{order}") for c in "ab"))
        true = complex(*(of[c][order] for c in "ab"))
        assert abs(told - true) < 0.2 * abs(true)
    left = [np.sqrt(np.mean(p.baseline.residual(key) ** 2)) / p.floors[key] for key in p.baseline.keys]
    assert max(left) < 1.4


@pytest.mark.slow
@pytest.mark.parametrize(
    "runs",
    [
        ("speed_300rpm_1",),
        *(pytest.param(runs, marks=pytest.mark.long) for runs in (("slow_ke_1",), ("speed_300rpm_1", "slow_ke_1"))),
    ],
)
def test_one_run_or_two_are_traced_with_turns_of_their_own_held_out(
    tmp_path: Path, open_1: Path, runs: tuple[str, ...]
):
    found = checked(trace(reduced(tmp_path, open_1, runs, ())))
    assert found.verdict.status == "no_missing_effect"
    assert "a third of every run" in found.held_out_how
    assert found.verdict.sentence.startswith("Nothing that these runs could show is missing")


def test_one_way_and_one_speed_are_told_and_what_they_mix_up(tmp_path: Path, open_1: Path):
    runs = read_campaign(reduced(tmp_path, open_1, ("speed_300rpm_1",), ())).runs
    said = " ".join(cannot(runs))
    for words in ("One run only", "one way only", "about 3"):
        assert words in said
    assert {("tau_c", "tau_0"), ("tau_c", "B_m")} <= set(together(runs))


def test_a_campaign_of_one_angle_and_no_torque_is_refused_in_words(tmp_path: Path, open_1: Path):
    folder = reduced(tmp_path, open_1, ("slow_ke_1",), ("theta_l", "tau_l", "tau_m"))
    with pytest.raises(UsageError, match="two angles or an angle and a torque"):
        trace(folder)


@pytest.mark.slow
@pytest.mark.parametrize("lacking", [pytest.param(name, marks=pytest.mark.long) for name in ("tau_l", "theta_l")])
def test_one_run_may_lack_a_channel(tmp_path: Path, shared: Path, lacking: str) -> None:
    names = [f"{kind}_{k}" for kind in ("slow_ke", "load_10nm", "speed_120rpm", "speed_400rpm") for k in (1, 2)]
    reduced(tmp_path, shared / "cases" / "open-3", names[1:], ())
    reduced(tmp_path, shared / "cases" / "open-3", names[:1], (lacking,))
    checked(trace(tmp_path))


def test_two_gears_are_no_campaign(tmp_path: Path, shared: Path) -> None:
    for serial, name in (("A", "speed_120rpm_1"), ("B", "speed_120rpm_2")):
        reduced(tmp_path, shared / "cases" / "open-1", [name], ())
        manifest = json.loads((tmp_path / name / "manifest.json").read_text())
        manifest["gear"]["serial"] = serial
        (tmp_path / name / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(UsageError, match=r"2 gears \(A, B\), expected one"):
        trace(tmp_path)


@pytest.mark.slow
def test_without_time_nothing_shakes_at_a_frequency(
    tmp_path: Path, open_1: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    for name in ("find_vibration", "find_interference"):
        monkeypatch.setattr(own, name, lambda *_, name=name: asked.append(name))
    prepare(read_campaign(reduced(tmp_path / "timeless", open_1, FEW, ("t",))), ())
    assert asked == []
    prepare(read_campaign(reduced(tmp_path / "timed", open_1, FEW, ())), ())
    assert set(asked) == {"find_vibration", "find_interference"}


def gauges_alone(to: Path, timed: bool) -> Path:
    """A motor angle and a torque that rides on it, as of gauges on a flexspline: every speed and load on three days."""
    rng, rows = np.random.default_rng(3), np.arange(4000)
    for day, load, rpm in itertools.product(range(3), (0.0, 20.0), (60.0, 150.0, 300.0, -150.0)):
        run = to / f"day{day}-{load:g}-{rpm:g}"
        run.mkdir(parents=True)
        angle = rpm * RPM * rows / 1000 + rng.uniform(0, TURN)
        late = angle - 1e-3 * rpm * RPM
        torque = load + 0.02 * day + (0.5 + 0.01 * load) * np.cos(2 * late) + 0.02 * rng.standard_normal(rows.size)
        columns = {"theta_m": angle, "tau_l": torque} | ({"t": rows / 1000} if timed else {})
        pq.write_table(pa.table(columns), run / "samples.parquet")
        conditions = {"tau_ext": -load, "speed_rpm": abs(rpm)}
        began = f"2024-05-{7 + day:02d}T08:{int(load):02d}:{int(abs(rpm)) // 10:02d}Z"
        manifest = {"schema": "hdrig.run/1", "procedure": "constant_speed", "gear": {"ratio": 100},
                    "started_utc": began, "conditions": conditions}  # fmt: skip
        (run / "manifest.json").write_text(json.dumps(manifest))
    return to


@pytest.mark.slow
@pytest.mark.parametrize("timed", [pytest.param(False, marks=pytest.mark.long), True])
def test_gauges_alone_give_their_ripple_its_lag_and_their_drift_and_no_name(tmp_path: Path, timed: bool) -> None:
    found = checked(trace(gauges_alone(tmp_path, timed)))
    assert found.verdict.effects == ()
    assert found.verdict.frequency_hz is None
    assert found.verdict.coordinate == "motor_angle"
    (two,) = found.ripple
    assert (two.order, two.lag is not None) == (2, True)
    assert two.lag[0] == pytest.approx(1e-3, abs=2 * two.lag[1])
    (drift,) = found.mean_drift
    assert drift.per_day == pytest.approx(0.02, abs=2 * drift.half)
