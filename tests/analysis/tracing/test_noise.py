"""Floors of runs that were never repeated, and how far a single run may exceed its floor by chance."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Noise
from rig.analysis.tracing.floor import noise, of_a_run
from rig.analysis.tracing.floor.friction import Scattering
from rig.analysis.tracing.floor.noise import Measured, _alone, _as_sensors_tell, _quietest, finest
from rig.analysis.tracing.floor.of_a_run import floor_of, leniency
from rig.analysis.tracing.floor.offsets import own_offset
from rig.analysis.tracing.floor.outlying import outlying
from rig.analysis.tracing.floor.repeats import Scatter, effective
from rig.analysis.tracing.floor.steady import steady
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.thresholds import BEYOND, LENIENT

SPEEDS = (12.0, 12.0, 20.0, 20.0, 30.0, 30.0, 40.0, 1.0)  # rad/s; the last two were never repeated
JITTER = 5e-5  # N·m per rad/s


LOADS = (5.0, 5.0, 10.0, 10.0, 20.0, 20.0, 40.0, 0.1)  # N·m; the last two were never repeated
GAIN = 2e-3  # relative


def run_at(speed: float, load: float) -> Any:
    pieces = (SimpleNamespace(torque=np.full(9, load)),)
    said = f"speed {speed} load {load}"
    motion = {"turning": speed, "mean_torque": load}
    return SimpleNamespace(procedure="speed", said=said, **motion, locked=False, is_wound=False, has=(), pieces=pieces)


def campaign() -> Any:
    return SimpleNamespace(runs=[run_at(w, 0.0) for w in SPEEDS], rows={})


def measured(freedom: float, jitter: float = JITTER) -> Measured:
    by_run = {(i, "M"): float(np.hypot(1e-3, jitter * w)) for i, w in enumerate(SPEEDS[:6])}
    noise = Noise({"M": 5e-4}, {"M": 1.0}, {"M": 1e-3})
    return Measured(noise, by_run, {}, {}, dict.fromkeys(by_run, freedom))


def floor(of: Measured, run: int) -> float:
    eq = campaign()
    eq.rows = {(run, "M"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool))}
    eq.runs[run].counts_m = 0.0
    return floor_of(of, eq, (run, "M"))


def test_a_clock_that_jitters_is_carried_to_speeds_that_were_never_repeated() -> None:
    assert floor(measured(500.0), 6) == pytest.approx(np.hypot(1e-3, 40 * JITTER), rel=1e-3)
    assert floor(measured(500.0), 7) == pytest.approx(1e-3, rel=1e-2)


def test_friction_that_scatters_is_in_the_floor_of_a_staircase_that_was_never_repeated() -> None:
    runs = [*(run_at(w, 0.0) for w in SPEEDS[:6]), run_at(12.0, 0.0)]
    runs[6].procedure = runs[6].said = "friction"
    runs[6].counts_m, scatters = 0.0, 2e-3
    rows = {(6, "M"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool))}
    eq: Any = SimpleNamespace(runs=runs, rows=rows)
    of = replace(measured(500.0, jitter=0.0), friction=Scattering(scatters**2, 6))
    for way, expected in (([1.0, -1.0], np.hypot(5e-4, scatters)), ([1.0, 1.0], 5e-4)):
        runs[6].pieces[0].way = np.array(way)
        assert floor_of(of, eq, (6, "M")) == pytest.approx(expected)


def test_the_gain_of_a_torque_sensor_is_carried_to_loads_that_were_never_repeated() -> None:
    runs = [run_at(12.0, load) for load in LOADS]
    by_run = {(i, "L"): float(np.hypot(0.03, GAIN * load)) for i, load in enumerate(LOADS[:6])}
    of = Measured(Noise({"L": 0.02}, {"L": 1.0}, {"L": 1e-3}), by_run, {}, {}, dict.fromkeys(by_run, 500.0))
    for run, floor_there in ((6, np.hypot(0.03, GAIN * 40.0)), (7, 0.03)):
        runs[run].counts_m = 0.0
        rows = {(run, "L"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool))}
        eq: Any = SimpleNamespace(runs=runs, rows=rows)
        assert floor_of(of, eq, (run, "L")) == pytest.approx(floor_there, rel=1e-2)


@pytest.mark.parametrize("wanders", [1e-6, 0.06, np.inf])
def test_how_far_a_zero_wanders_is_read_the_same_whatever_is_believed_of_it(wanders: float) -> None:
    """A residual has lost as much of its mean as the offset is believed to wander; the rows have not."""
    zeros, rng = (0.05, -0.03, 0.08, -0.06, 0.02, -0.07), np.random.default_rng(3)
    rows = {
        (i, "L"): SimpleNamespace(y=zero + 0.01 * rng.standard_normal(500), z=np.zeros((500, 1)), at=(0,))
        for i, zero in enumerate(zeros)
    }
    runs = [SimpleNamespace(ratio=50.0, look=SimpleNamespace(steady=False)) for _ in zeros]
    noise = Noise({"L": 0.01}, {"L": 1.0}, {"L": wanders})
    eq = SimpleNamespace(rows=rows, own={}, runs=runs, noise=noise)
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=eq), x=np.zeros(1))
    pairs: Any = [SimpleNamespace(pair=(i, i + 1), rows=500) for i in (0, 2, 4)]
    want = np.sqrt(np.mean([(zeros[i] - zeros[i + 1]) ** 2 / 2 for i in (0, 2, 4)]))
    assert own_offset(s, "L", pairs, 1e-4) == pytest.approx(want, rel=0.05)


def test_noise_that_does_not_grow_stays_as_it_is() -> None:
    assert floor(measured(500.0, jitter=0.0), 6) == pytest.approx(1e-3, rel=1e-6)


@pytest.mark.parametrize(("pairs", "same", "expected"), [(1, False, LENIENT), (1, True, 1.0), (3, False, 1.0)])
def test_of_a_condition_that_one_pair_stands_for_nothing_is_known(
    monkeypatch: pytest.MonkeyPatch, pairs: int, same: bool, expected: float
) -> None:
    monkeypatch.setattr(of_a_run, "alike", lambda a, b: same)
    of = replace(measured(500.0), freedom={(i, "M"): 500.0 for i in range(2 * pairs)})
    assert leniency(of, campaign(), (6, "M")) == expected


def test_a_single_run_may_exceed_a_floor_of_few_independent_parts_by_more() -> None:
    eq, at = campaign(), (6, "M")
    assert leniency(measured(500.0), eq, at) == 1.0
    assert 1.0 < leniency(measured(12.0), eq, at) <= LENIENT
    assert leniency(measured(2.0), eq, at) == LENIENT
    assert leniency(measured(2.0), eq, (6, "A")) == 1.0  # nothing is known of that channel


def test_what_lock_tests_differ_by_is_no_floor_of_runs_that_turn_freely() -> None:
    """A gain that is never twice the same makes ten times as much under the torques of a lock test."""
    runs = [run_at(12.0 + 5.0 * i, 1.0) for i in range(8)]
    runs[6].locked = runs[7].locked = True
    by_run = {(i, "L"): 0.4 if run.locked else 0.04 for i, run in enumerate(runs)}
    of = Measured(Noise({"L": 0.2}, {"L": 1.0}, {"L": 1e-3}), by_run, {}, {}, dict.fromkeys(by_run, 500.0))
    for run in runs:
        run.counts_m = 0.0
    rows = {(i, "L"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool)) for i in range(8)}
    eq: Any = SimpleNamespace(runs=runs, rows=rows)
    assert floor_of(of, eq, (0, "L")) == pytest.approx(0.04)
    assert floor_of(of, eq, (6, "L")) == pytest.approx(0.4)
    few: Any = SimpleNamespace(runs=runs, rows={key: rows[key] for key in [*rows][3:]})
    assert floor_of(of, few, (3, "L")) == pytest.approx(0.2)  # three free ones tell too little by themselves


def test_a_procedure_of_which_enough_was_compared_has_a_floor_of_its_own() -> None:
    """Strokes of a slow run are compared within a turn of few, and their noise is half as large again."""
    runs = [run_at(12.0 + 5.0 * i, 1.0) for i in range(12)]
    for run in runs[6:]:
        run.procedure = "kinematic_error"
    by_run = {(i, "A"): 0.6 if run.procedure == "speed" else 0.9 for i, run in enumerate(runs)}
    of = Measured(Noise({"A": 0.8}, {"A": 1.0}, {"A": 1e-3}), by_run, {}, {}, dict.fromkeys(by_run, 500.0))
    for run in runs:
        run.counts_m = 0.0
    rows = {(i, "A"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool)) for i in range(12)}
    eq: Any = SimpleNamespace(runs=runs, rows=rows)
    assert floor_of(of, eq, (0, "A")) == pytest.approx(0.6)
    assert floor_of(of, eq, (6, "A")) == pytest.approx(0.9)
    few: Any = SimpleNamespace(runs=runs, rows={key: rows[key] for key in [*rows][1:]})
    assert floor_of(of, few, (1, "A")) == pytest.approx(np.sqrt((5 * 0.36 + 6 * 0.81) / 11))  # five tell too little


def pairs_at(rms: tuple[float, ...], freedom: float = 100.0) -> list[int]:
    """Which of pairs of repeats at 12, 20, 30, 40 rad/s with those RMS are outlying."""
    found: Any = [SimpleNamespace(pair=(2 * i, 2 * i + 1), rms=x, freedom=freedom) for i, x in enumerate(rms)]
    eq: Any = SimpleNamespace(runs=[run_at(w, 0.0) for w in (12.0, 12.0, 20.0, 20.0, 30.0, 30.0, 40.0, 40.0)])
    return [found.index(s) for s in outlying(eq, found)]


def test_repeats_that_hunt_at_one_speed_tell_no_other_speeds_floor() -> None:
    assert pairs_at((1.2e-3, 1.2e-3, 9.8e-3)) == [2]
    assert pairs_at((1.2e-3, 9.8e-3)) == []  # which of two is the usual one nobody can tell
    assert pairs_at((1.2e-3, 2.0e-3, 3.0e-3, 4.0e-3)) == []  # a clock that jitters
    assert pairs_at((1.2e-3, 1.2e-3, 9.8e-3), freedom=1.0) == []  # a gain, once alike and once not


def test_one_cycle_about_zero_is_compared_turn_by_turn(
    rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No two of its strokes pass the same angles; the noise of lock tests, compared in pairs, is another one."""
    theta = np.concatenate([np.linspace(0, 25, 3000), np.linspace(25, -25, 6000), np.linspace(-25, 0, 3000)])
    monkeypatch.setattr(noise, "as_fast", lambda a, b: a is b)
    run = SimpleNamespace(locked=False, ratio=50.0, step_m=1e-4, step_l=1e-6)
    eq: Any = SimpleNamespace(rows={(0, "A"): SimpleNamespace(theta_m=theta)}, runs=[run, SimpleNamespace()])
    left = {(0, "A"): 3e-6 * rng.standard_normal(theta.size)}
    lock = Scatter((1, 1), 2e-6, 500, 0.0, np.ones(61), 500.0)
    (found,) = _alone(eq, left, "A", [0], [lock])
    assert found.pair == (0, 0)
    assert found.rms == pytest.approx(3e-6, rel=0.05)
    assert _alone(eq, left, "M", [0], [lock]) == []


def test_a_floor_leaves_out_what_is_told_apart() -> None:
    calm = {(i, "M"): 1.2e-3 for i in range(4)}
    by_run = {**calm, (4, "M"): 9.8e-3, (5, "M"): 9.8e-3}
    noise = Noise({"M": 1.2e-3}, {"M": 1.0}, {"M": 1e-3})
    of = Measured(noise, by_run, {}, {}, dict.fromkeys(by_run, 500.0), frozenset({(4, "M"), (5, "M")}))
    assert floor(of, 6) == pytest.approx(1.2e-3)  # at another speed
    assert floor(of, 5) == pytest.approx(9.8e-3)  # of its own


def test_made_up_numbers_and_a_coarse_encoder_have_a_floor_all_the_same() -> None:
    """Without noise every turn is the one before: a floor of nothing ended a trace in a division by it."""
    run = SimpleNamespace(step_m=0.005, step_l=0.0, ratio=50.0, locked=True, turning=0.0, pieces=[None], has={"t"})
    y = {"A": 1e-4 * np.sin(np.arange(1000.0)), "M": 0.3 + 0.1 * np.sin(np.arange(1000.0))}
    eq: Any = SimpleNamespace(runs=[run], rows={(0, c): SimpleNamespace(y=x) for c, x in y.items()})
    assert finest(eq, "A") == pytest.approx(1e-4 / 12**0.5 / 4, rel=1e-3)  # of a count of 0.1 mrad at the output
    assert finest(eq, "M") == pytest.approx(0.1e-5 / 2**0.5, rel=0.01)
    assert finest(eq, "L") > 0.0
    assert effective(np.zeros(20)) == 1.0


def log_at(speed: float) -> Any:
    """A log that says nothing of how it moved."""
    t = np.arange(0.0, 20.0, 0.02)
    piece = SimpleNamespace(t=t, dt=0.02, theta_m=speed * t, omega_m=np.full(t.size, speed), way=np.ones(t.size))
    run = run_at(speed, 0.0)
    run.said, run.procedure, run.counts_m = "other []", "other", 0.0
    run.input_locked, run.wound = False, lambda piece: piece.theta_m
    piece.torque = run.pieces[0].torque
    run.pieces = (piece,)
    return run


def test_logs_that_say_nothing_have_the_floor_of_those_that_move_alike() -> None:
    """A joint's logs have no conditions in their manifests: a fast one is not as quiet as a slow one for that."""
    runs = [log_at(w) for w in (12.0, 40.0, 12.2, 40.5)]
    noise = Noise({"M": 5e-4}, {"M": 1.0}, {"M": 1e-3})
    of = Measured(noise, {(0, "M"): 1e-3, (1, "M"): 5e-3}, {}, {}, {(0, "M"): 500.0, (1, "M"): 500.0})
    for run, there in ((2, 1e-3), (3, 5e-3)):
        eq: Any = SimpleNamespace(runs=runs, rows={(run, "M"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool))})
        assert floor_of(of, eq, (run, "M")) == pytest.approx(there)


def test_turns_that_are_rounded_alike_are_as_noisy_as_their_sensors() -> None:
    """Of a run without a repeat no less is believed than the noise of its readings, or of those of its procedure."""
    runs = [SimpleNamespace(procedure="speed"), SimpleNamespace(procedure="speed"), SimpleNamespace(procedure="lock")]
    eq: Any = SimpleNamespace(runs=runs)

    def scatter_of(*pair: int) -> Scatter:
        return Scatter((pair[0], pair[-1]), 1e-3, 500, 0.0, np.ones(20), 100.0)

    white = {(0, "L"): 2e-3, (0, "M"): 5.0}
    found, said = _as_sensors_tell(eq, [scatter_of(0), scatter_of(1), scatter_of(2)], "L", white)
    assert [s.rms for s in found] == [2e-3, 2e-3, 1e-3]
    assert "less than the noise of the readings" in said
    found, said = _as_sensors_tell(eq, [scatter_of(0, 1)], "L", white)  # repeats begin at other angles
    assert ([s.rms for s in found], said) == ([1e-3], "")
    assert _as_sensors_tell(eq, [scatter_of(0)], "L", {(0, "L"): 1.1e-3})[1] == ""


def test_a_load_torque_many_times_as_noisy_as_its_sensors_is_no_floor() -> None:
    """What begins anew in every turn, as a rub at one angle of the output that is passed once, is no noise of it."""
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(procedure="speed")] * 3)
    found = [Scatter((i, i), rms, 500, 0.0, np.ones(20), 100.0) for i, rms in enumerate((1.2e-3, 5e-3, 2e-3))]
    white = {(0, "L"): 1e-3}
    made, _ = _as_sensors_tell(eq, found, "L", white, BEYOND)
    assert [s.rms for s in made] == pytest.approx([1.2e-3, 1.6e-3, 2e-3])  # as much as the other runs have
    assert made[1].swollen == pytest.approx(5.0 / 1.6)
    assert [s.rms for s in _as_sensors_tell(eq, found, "L", white)[0]] == [1.2e-3, 5e-3, 2e-3]
    alone, _ = _as_sensors_tell(eq, found[1:2], "L", white, BEYOND)
    assert alone[0].rms == pytest.approx(BEYOND * 1e-3)  # nobody tells what is usual
    repeated = [replace(s, pair=(0, 1)) for s in found]
    assert [s.rms for s in _as_sensors_tell(eq, repeated, "L", white, BEYOND)[0]] == [1.2e-3, 5e-3, 2e-3]


@pytest.mark.parametrize(("left", "expected"), [((3.9e-3, 4.2e-3), 3.9), ((0.8e-3, 4.2e-3), 1.0), ((), 1.0)])
def test_how_noisy_sensors_are_beside_their_roughness_is_told_by_the_quietest_run(
    left: tuple[float, ...], expected: float
) -> None:
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(procedure="speed")] * 2)
    e = {(i, "L"): np.full(9, x) for i, x in enumerate(left)}
    white = {(0, "L"): 1e-3}
    assert _quietest(eq, e, "L", white, ()) == pytest.approx(expected)
    differ = Scatter((0, 1), 2e-3, 500, 0.0, np.ones(20), 100.0)
    assert _quietest(eq, e, "L", white, [differ]) == pytest.approx(min(expected, 2.0) if left else 2.0)


@pytest.mark.parametrize("pink", [False, True])
def test_noise_is_steady_and_a_wave_of_any_shape_or_a_rub_at_one_time_is_none(pink: bool) -> None:
    rng, t = np.random.default_rng(5), np.arange(12000) / 125.0
    noise = rng.standard_normal(t.size)
    if pink:
        hz = np.fft.rfftfreq(t.size, 1 / 125.0)
        noise = np.fft.irfft(np.fft.rfft(noise) / np.sqrt(np.maximum(hz, 0.05)), t.size)
    noise /= np.sqrt(np.mean(noise**2))
    sawtooth = 10.0 * (np.mod(t, 1.7) / 1.7 - 0.5)
    rub = 20.0 * np.exp(-0.5 * ((t - 31.0) / 0.8) ** 2)
    assert steady(noise) == pytest.approx(1.0, rel=0.15)
    assert steady(noise + sawtooth) < 0.5 * np.sqrt(np.mean((noise + sawtooth) ** 2))
    assert steady(noise + rub) < 1.3
    assert steady(noise[:300]) == np.sqrt(np.mean(noise[:300] ** 2))  # too few rows to tell


@pytest.mark.parametrize(("sensors", "expected"), [(0.5e-3, 0.5e-3), (0.9e-3, 0.9e-3), (0.0, 0.933e-3)])
def test_a_run_that_is_read_more_often_has_a_floor_of_its_own(sensors: float, expected: float) -> None:
    """Of seven runs six are as noisy as their sensors and stand for the seventh, whose sensors leave less; unless
    nothing is known of those."""
    runs = [run_at(12.0 + i, 0.0) for i in range(7)]
    runs[6].procedure, runs[6].counts_m = "quick", 0.0
    by_run = {(i, "M"): 1e-3 for i in range(6)} | {(6, "M"): 0.3e-3}
    white = {(0, "M"): 1e-3} | ({(6, "M"): sensors} if sensors else {})
    of = Measured(Noise({"M": 1.03e-3}, {"M": 1.0}, {"M": 1e-3}), by_run, white, {}, dict.fromkeys(by_run, 500.0))
    rows = {(i, "M"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool)) for i in range(7)}
    eq: Any = SimpleNamespace(runs=runs, rows=rows)
    assert floor_of(of, eq, (6, "M")) == pytest.approx(expected, rel=0.05)


def test_a_search_goes_on_below_a_floor_that_is_many_times_the_noise_of_the_sensors() -> None:
    """Repeats of the load torque that differ so much may be what a second mode rings by; friction scatters."""
    floors = {(0, "L"): 1.0, (1, "L"): 0.2, (0, "M"): 1.0}
    white = {(0, "L"): 0.1, (0, "M"): 0.1}
    measured = Measured(Noise({}, {}, {}), {}, white, {}, {}, beyond=BEYOND)
    runs = [SimpleNamespace(procedure="speed"), SimpleNamespace(procedure="lock")]
    p: Any = SimpleNamespace(measured=measured, eq=SimpleNamespace(runs=runs), floors=floors)
    silence = vars(Prepared)["silence"].func(p)
    assert silence == pytest.approx({(0, "L"): BEYOND * 0.1, (1, "L"): 0.2, (0, "M"): 1.0})
