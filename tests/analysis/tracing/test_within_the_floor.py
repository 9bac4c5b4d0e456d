"""What is not above the floor of repeats and is there all the same: it is named, or where it lives is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.channels import CHANNEL, WHOLE
from rig.analysis.tracing.residual import in_the_floor
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.in_the_floor import _in_channel, _waves
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.selection import hidden, next_run
from rig.analysis.tracing.selection.next_run import Alone, _as_good
from tests.analysis.tracing.spiked import RATIO, Columns, spiked, under

PERIOD = 230.0  # s, between the shortest run and the campaign
EVERY = 84.0  # s
SEAL = 2.6  # s
PUMP = 48.0  # s
STROKES = 6.2  # s, more than a fast run takes
REFILL = 31.0  # s
CAGE = 0.4512  # orders of the motor
SEGMENTS = 11  # of the scale of a load encoder
NO_REPEATS = ("slow_ke_1", "speed_120rpm_1", "speed_200rpm_1", "speed_300rpm_1", "lock_60_1")


def breathing(c: Columns, began: float) -> Columns:
    wave = 6e-5 * np.sin(2 * np.pi * (began + c["t"]) / PERIOD)  # rad
    return {"theta_l": c["theta_l"] + wave}


def rubbing(c: Columns, began: float) -> Columns:
    on = np.mod(began + c["t"], EVERY) < EVERY / 3
    return under(c, 0.3 * on * np.sign(np.gradient(c["theta_m"])))


def pumping(c: Columns, began: float) -> Columns:
    on = np.mod(began + c["t"], STROKES) < STROKES / 2
    return {"tau_m": c["tau_m"] + 0.009 * on * np.sign(np.gradient(c["theta_m"]))}


def refilled(c: Columns, began: float) -> Columns:
    gone = np.mod(began + c["t"], REFILL)
    pressure = np.where(gone < 0.85 * REFILL, 1 - gone / (0.85 * REFILL), (gone / REFILL - 0.85) / 0.15)
    return under(c, 0.8 * pressure * np.sign(np.gradient(c["theta_m"])))


def swelling(c: Columns, began: float) -> Columns:
    wave = 4e-5 * np.cos(2 * c["theta_m"]) * np.sin(2 * np.pi * (began + c["t"]) / PUMP)  # rad
    return {"theta_l": c["theta_l"] - wave}


def untrue(c: Columns, began: float) -> Columns:
    return {"theta_l": c["theta_l"] - 3e-5 * np.cos(CAGE * c["theta_m"] + 0.3)}


def stitched(c: Columns, began: float) -> Columns:
    along = SEGMENTS * c["theta_l"] / (2 * np.pi)
    return {"theta_l": c["theta_l"] + 4e-5 * (2 * (along - np.floor(along)) - 1)}


def dragging(c: Columns, began: float) -> Columns:
    on = np.mod(1.7 * began + c["t"], SEAL) < SEAL / 2  # a phase of each run's own
    return {"tau_m": c["tau_m"] + 0.009 * on * np.sign(np.gradient(c["theta_m"]))}


def pulled(c: Columns, began: float) -> Columns:
    return under(c, 0.06 * c["theta_l"])


def loaded(c: Columns, began: float) -> Columns:
    return {"tau_m": c["tau_m"] + 2.4e-3 * np.abs(c["tau_l"]) / RATIO * np.sign(np.gradient(c["theta_m"]))}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "period"),
    [
        pytest.param(breathing, PERIOD, marks=pytest.mark.long),
        pytest.param(rubbing, EVERY, marks=pytest.mark.long),
        pytest.param(swelling, PUMP, marks=pytest.mark.long),
        pytest.param(pumping, STROKES, marks=pytest.mark.long),
        pytest.param(refilled, REFILL, marks=pytest.mark.long),
    ],
)
def test_what_follows_the_clock_makes_the_floor_and_is_told(
    tmp_path: Path, shared: Path, law: Callable[[Columns, float], Columns], period: float
) -> None:
    verdict = spiked(tmp_path, shared / "cases" / "open-1", law).verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "time_periodic")
    assert verdict.frequency_hz is not None
    assert 1 / verdict.frequency_hz == pytest.approx(period, rel=0.03)


@pytest.mark.slow
@pytest.mark.long
def test_a_seal_that_rubs_within_every_run_is_told(tmp_path: Path, shared: Path) -> None:
    verdict = spiked(tmp_path, shared / "cases" / "open-1", dragging).verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "time_periodic")
    assert verdict.frequency_hz is not None
    assert 1 / verdict.frequency_hz == pytest.approx(SEAL, rel=0.01)


@pytest.mark.long
def test_an_order_that_is_none_of_the_gears_is_told_where_nothing_was_repeated(tmp_path: Path, shared: Path) -> None:
    verdict = spiked(tmp_path, shared / "cases" / "open-1", untrue, NO_REPEATS).verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "motor_angle")
    assert verdict.order == pytest.approx(CAGE, abs=2e-3)


@pytest.mark.slow
@pytest.mark.long
def test_a_scale_that_is_stitched_is_told_where_nothing_was_repeated(tmp_path: Path, shared: Path) -> None:
    verdict = spiked(tmp_path, shared / "cases" / "open-1", stitched, NO_REPEATS).verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "load_angle")
    assert verdict.order == pytest.approx(SEGMENTS, abs=0.02)


@pytest.mark.slow
@pytest.mark.long
def test_a_cable_that_pulls_along_the_way_gone_is_told(tmp_path: Path, shared: Path) -> None:
    verdict = spiked(tmp_path, shared / "cases" / "open-1", pulled).verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "load_angle")


@pytest.mark.slow
@pytest.mark.long
def test_an_effect_that_stays_below_the_floor_is_named_when_it_is_plain(tmp_path: Path, shared: Path) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", loaded)
    assert found.verdict.effects == ("load_dependent_friction",)
    mu = next(p for p in found.effects[0].parameters if p.name == "mu_L")
    assert mu.ci95[0] <= 2.4e-3 <= mu.ci95[1]


def test_a_rival_explains_as_much_and_leaves_no_more() -> None:
    fitted: Any = None
    best = Alone(fitted, 1000.0, 0.93, 1.0)
    assert _as_good(Alone(fitted, 990.0, 0.95, 1.1), best)
    assert not _as_good(Alone(fitted, 600.0, 0.98, 1.1), best)  # the floor is too high to show it: the evidence does
    assert not _as_good(Alone(fitted, 1700.0, 6.5, 7.2), best)  # explains more, of something else
    assert not _as_good(None, best)


@pytest.mark.parametrize(("together", "instead"), [(4050.0, True), (4950.0, False)])
def test_what_explains_as_much_of_another_channel_is_no_rival(
    monkeypatch: pytest.MonkeyPatch, together: float, instead: bool
) -> None:
    """A fall of friction in the motor torque, 1000, beside what a resonance makes of the shaft torque's noise, 4000."""
    alone: Any = SimpleNamespace(design=SimpleNamespace(terms=("law",)), gain=4000.0)
    monkeypatch.setattr(next_run, "extended", lambda design, term, runs: (design, term))
    monkeypatch.setattr(next_run, "fit", lambda design: SimpleNamespace(gain=together))
    p: Any = SimpleNamespace(split=SimpleNamespace(fitted=()))
    assert next_run._instead(p, Alone(alone, 4000.0, 0.9, 1.0), Alone(alone, 1000.0, 0.9, 1.0)) is instead
    assert not next_run._instead(p, None, Alone(alone, 1000.0, 0.9, 1.0))


@pytest.mark.parametrize("apart", [0.0, 1e6])
def test_a_campaign_of_seconds_or_of_days_has_no_waves_of_its_clock(apart: float) -> None:
    run = np.repeat(np.arange(4), 500)
    time = np.tile(np.arange(500) / 50, 4) + apart * run  # s; runs without a date all begin at once
    at = {"time": time, "direction": np.ones(2000)}
    none = np.zeros((2000, 0))
    assert _waves(Rest(np.ones(2000), run, at, 0.02, none, none[:0]), lambda r: np.ones(r.e.size)) is None


@pytest.mark.parametrize("period", [40.0, 12.5, STROKES, 2.1])
def test_waves_of_the_campaigns_clock_are_found_slow_and_fast(rng: np.random.Generator, period: float) -> None:
    """Runs of five seconds, about half a minute apart: each shows a part of one period, or two."""
    run = np.repeat(np.arange(80), 250)
    time = np.tile(np.arange(250) / 50, 80) + np.cumsum(rng.uniform(20, 45, 80))[run]
    way = np.where(run % 2, -1.0, 1.0)
    e = way * ((np.mod(time, period) < period / 2) - 0.5) + rng.standard_normal(time.size)
    none = np.zeros((time.size, 0))
    made = Rest(e, run, {"time": time, "direction": way}, 0.02, none, none[:0], own_zeros=False)
    found = _waves(made, lambda r: r.at["direction"])
    assert found is not None
    assert 1 / found[1] == pytest.approx(period, rel=2e-3)


@pytest.mark.parametrize(("rms", "joined"), [(1.0, 0), (1.5, 1)])
def test_runs_are_joined_only_where_unseen_ones_wander(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, rms: float, joined: int
) -> None:
    asked = list[str]()
    floors = {(0, "M"): 1.0, (1, "M"): 1.0}
    monkeypatch.setattr(in_the_floor, "_within_runs", lambda *_: floors)
    monkeypatch.setattr(in_the_floor, "rest", lambda *of: asked.append(of[-1]))
    e = {key: rng.normal(0.0, rms, 5000) for key in floors}
    nothing: Any = None  # the equations, of which nothing is asked
    assert _in_channel(nothing, e, e, floors, "M") is None
    assert len(asked) == joined


@pytest.mark.parametrize("loudest", WHOLE)
def test_every_channel_is_listened_to_whoever_does_it(monkeypatch: pytest.MonkeyPatch, loudest: str) -> None:
    """Two processes share the channels."""

    def ticking(eq: object, fitted: object, unseen: object, channels: Sequence[str]) -> Home | None:
        found = [Home("time_periodic", c, 0.9 if c == loudest else 0.5, frequency_hz=0.5) for c in channels]
        return max(found, key=lambda home: home.share)

    monkeypatch.setattr(hidden, "ticking", ticking)
    monkeypatch.setattr(hidden, "in_the_floor", lambda *_: None)
    monkeypatch.setattr(hidden, "repeats", lambda *_: [])
    nothing: Any = SimpleNamespace(runs=(), fitted=(), floors={}, keys=())
    p: Any = SimpleNamespace(eq=nothing, split=nothing, held_out=nothing)
    conclusion = hidden._in_the_floor(p, nothing, {}, {})
    assert conclusion is not None
    assert CHANNEL[loudest].name in conclusion.verdict.sentence


@pytest.mark.parametrize(("coordinate", "order", "claims"), [
    ("load_angle", 1.0, False), ("load_angle", 2.01, False), ("load_angle", 0.4, True), ("motor_angle", 1.0, True),
])  # fmt: skip
def test_what_comes_back_with_the_outputs_turn_is_not_said_to_be_no_effects(
    monkeypatch: pytest.MonkeyPatch, coordinate: str, order: float, claims: bool
) -> None:
    """A runout and a weight do, and no order is above a floor that has it."""
    monkeypatch.setattr(hidden, "ticking", lambda *_: None)
    monkeypatch.setattr(hidden, "in_the_floor", lambda *_: Home(coordinate, "A", 0.5, order=order))
    monkeypatch.setattr(hidden, "repeats", lambda *_: [])
    nothing: Any = SimpleNamespace(runs=(), fitted=(), floors={}, keys=())
    p: Any = SimpleNamespace(eq=nothing, split=nothing, held_out=nothing)
    conclusion = hidden._in_the_floor(p, nothing, {}, {})
    assert conclusion is not None
    assert ("no effect of the library explains it" in conclusion.verdict.sentence) is claims
