"""Jumps are found where they are, and drift, waves and noise are no jumps."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from rig.analysis.tracing.fit.equations import Equations, Noise
from rig.analysis.tracing.floor import steps
from rig.analysis.tracing.floor.jumps import EDGE, FAR, among, heights, jumps
from rig.analysis.tracing.floor.kept import kept
from rig.analysis.tracing.floor.steps import Steps, _rested, _sure, explained, lost_counts
from rig.analysis.tracing.floor.vibration import _as_one, _heights
from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.analysis.tracing.selection import hidden
from rig.analysis.tracing.thresholds import STEP
from rig.model.effects.missed_counts import LOAD
from tests.analysis.tracing.spiked import RATIO, Columns, spiked, started

ANY = (0.0, np.inf)


def test_a_jump_is_found_at_its_row_with_its_size(rng: np.random.Generator) -> None:
    e = 4e-6 * rng.standard_normal(4000)
    e[2500:] += 3e-5
    (found,) = jumps(e, np.ones(4000, bool), 7.0, ANY)
    assert abs(found[0] - 2500) <= 4
    assert found[1] == pytest.approx(3e-5, rel=0.2)


def test_what_comes_back_within_a_second_is_not_lost(rng: np.random.Generator) -> None:
    e = 4e-6 * rng.standard_normal(4000)
    e[2500:2550] += 3e-5
    assert jumps(e, np.ones(4000, bool), 7.0, ANY) == []


def test_two_losses_in_quick_succession_are_two(rng: np.random.Generator) -> None:
    e = 4e-6 * rng.standard_normal(4000)
    e[2600:] += 3e-5
    e[2700:] += 3e-5
    assert sorted(at for at, _ in jumps(e, np.ones(4000, bool), 7.0, ANY)) == pytest.approx([2600, 2700], abs=4)


def test_a_jump_where_the_motor_turns_back_is_none(rng: np.random.Generator) -> None:
    e = 4e-6 * rng.standard_normal(4000)
    e[2500:] += 3e-5
    assert jumps(e, np.abs(np.arange(4000) - 2500) > 43, 7.0, ANY) == []


def onward_at(theta: np.ndarray, rippling: bool = False) -> np.ndarray:
    """Which rows of one run at these motor angles, 4 ms apart, may show a jump, or one that is certain and stays."""
    row = SimpleNamespace(theta_m=theta, t=0.004 * np.arange(theta.size))
    eq: Any = SimpleNamespace(rows={(0, "A"): row})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(steps, "clock", lambda eq, key: row.t)
        return np.asarray((steps._onward_rippling if rippling else steps._onward)(eq, (0, "A")))


def test_a_jump_where_the_load_is_accelerated_is_none_and_ripple_hides_none() -> None:
    t = 0.004 * np.arange(4000)
    faster = onward_at(np.where(t < 8.0, 30.0 * t, 240.0 + 40.0 * (t - 8.0)))
    assert not faster[1995:2005].any()
    assert faster[500:1900].all()
    assert faster[2100:3500].all()
    assert onward_at(30.0 * t + 0.05 * np.sin(60.0 * t))[100:3900].all()


def test_a_motor_that_cogs_goes_on_where_a_jump_is_certain_and_stays(rng: np.random.Generator) -> None:
    t = 0.004 * np.arange(4000)
    cogging = 1.0 * t + 0.02 * np.sin(24.0 * t)
    assert onward_at(cogging).mean() < 0.2
    assert onward_at(cogging, rippling=True)[100:3900].mean() > 0.8
    faster = onward_at(np.where(t < 8.0, t, 8.0 + 1.5 * (t - 8.0)), rippling=True)
    assert not faster[1995:2005].any()
    e = 4e-6 * rng.standard_normal(4000)
    e[1500:] += 8.7e-5
    going = np.ones(4000, bool)
    (at,) = np.flatnonzero(steps._certain(e, going))
    assert at == pytest.approx(1500, abs=4)
    e[2500:] -= 8.7e-5  # it comes back
    assert not steps._certain(e, going).any()
    assert not steps._certain(e, ~going).any()


def test_noise_drift_and_waves_have_no_jumps(rng: np.random.Generator) -> None:
    n = np.arange(4000)
    for e in (0 * n, 1e-8 * n, 2e-5 * np.sin(n / 60)):
        assert jumps(e + 4e-6 * rng.standard_normal(n.size), n >= 0, 7.0, ANY) == []


def test_jumps_that_stand_in_each_others_windows_are_told_apart(rng: np.random.Generator) -> None:
    """A walk of lost and found counts at 400 rpm: the windows of a single jump hold several of these."""
    count, rows = 3.9e-5, [100, 190, 222, 300, 330, 420, 560, 600, 640, 800, 1000, 1030]
    ways = [1, -1, 1, 2, -1, -1, 1, 1, -1, 2, 1, -1]
    e = np.zeros(1224)
    for row, way in zip(rows, ways, strict=True):
        e[row:] += way * count
    e += 4e-6 * rng.standard_normal(e.size)
    everywhere = np.ones(e.size, dtype=bool)
    alone = jumps(e, everywhere, 4.0, (0.65 * count, 1.35 * count))
    found = [row for row, _ in among(e, everywhere, alone, count)]
    assert len(alone) < 6
    assert len(found) == pytest.approx(len(rows), abs=1)
    assert all(min(abs(row - true) for true in rows) <= EDGE for row in found)


def test_a_jump_that_noise_makes_too_small_in_the_usual_window_is_found_beside_others(rng: np.random.Generator) -> None:
    """Of a loss that a third of a second of wander halves a whole second sees enough."""
    count, everywhere = 4e-6, np.ones(9000, dtype=bool)
    e = 1e-6 * rng.standard_normal(9000)
    e[2000:] += count
    e[6000:] += count
    e[6000:6040] -= 0.5 * count
    first = jumps(e, everywhere, 4.0, (0.65 * count, 9 * count))
    assert [row for row, _ in first] == [pytest.approx(2000, abs=4)]
    assert [row for row, _ in among(e, everywhere, first, count)] == [pytest.approx(r, abs=45) for r in (2000, 6000)]


def test_the_height_of_a_jump_is_taken_from_all_that_is_flat_beside_it_and_has_an_error(
    rng: np.random.Generator,
) -> None:
    """Where it is largest a jump has some noise in its size: over a window it comes out too large."""
    off, within = [], 0
    for _ in range(40):
        e = 4e-6 * rng.standard_normal(6000)
        e[2500:] += 1e-5
        e[4000:] -= 1e-5
        (size, error), (back, _) = heights(e, (2500, 4000))
        off += [size - 1e-5, -back - 1e-5]
        within += abs(size - 1e-5) < 2.2 * error
    assert abs(float(np.mean(off))) < 5e-8
    assert float(np.std(off)) < 2.5e-7
    assert within >= 34
    assert heights(np.r_[0.0, 0.0, 1.0, 1.0], (2,)) == [(1.0, 0.0)]


@pytest.fixture
def plainly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Jumps of one channel alone, of motors that go on one way."""
    for name in ("_onward", "_onward_rippling"):
        monkeypatch.setattr(steps, name, lambda eq, key: np.ones(4000, dtype=bool))
    monkeypatch.setattr(steps, "_of_the_torque", lambda *of: False)
    monkeypatch.setattr(steps, "_lasts", lambda *of: True)
    monkeypatch.setattr(steps, "_placed", lambda eq, e, run, row: (row, LOAD))
    monkeypatch.setattr(steps, "_in_other_parts", lambda *of: {})


def one_way(runs: int) -> Any:
    """Equations of runs whose motors do."""
    return SimpleNamespace(rows={(i, "A"): SimpleNamespace(theta_m=np.arange(4000.0)) for i in range(runs)})


@pytest.mark.usefixtures("plainly")
def test_beside_a_certain_loss_of_three_counts_one_of_two_is_found(rng: np.random.Generator) -> None:
    count, e = 6e-6, {(i, "A"): 4e-6 * rng.standard_normal(4000) for i in range(3)}
    e[0, "A"][2500:] += 3 * count
    wander = 5e-6 * np.sin(np.arange(4000) / 250)
    e[1, "A"] += wander
    e[1, "A"][1500:] += 2 * count
    found = steps.find_steps(one_way(3), e)
    assert {run: len(rows) for run, rows in found.rows.items()} == {0: 1, 1: 1}
    assert found.rows[1][0] == pytest.approx(1500, abs=4)


@pytest.mark.usefixtures("plainly")
def test_groups_of_counts_of_many_sizes_are_all_found(rng: np.random.Generator) -> None:
    count, e = 5e-6, {(i, "A"): 1e-6 * rng.standard_normal(4000) for i in range(3)}
    lost = {0: {900: 5, 3100: -3}, 1: {1400: 6, 2600: 4}, 2: {2000: 10}}
    for run, at in lost.items():
        for row, counts in at.items():
            e[run, "A"][row:] += counts * count
    found = steps.find_steps(one_way(3), e)
    for run, at in lost.items():
        assert found.rows[run] == pytest.approx(tuple(at), abs=4)
        assert found.sizes[run] == pytest.approx([n * count for n in at.values()], rel=0.05)


UP_DOWN_UP = np.concatenate([np.linspace(0, 25, 1500), np.linspace(25, -25, 3000), np.linspace(-25, 0, 1500)])
TURNED_BACK, ONCE_MORE = 1500, 4500


@pytest.mark.parametrize(
    ("rises", "falls", "is_kept"),
    [
        (TURNED_BACK + 50, 6000, True),
        (TURNED_BACK + 50, ONCE_MORE + 50, False),  # what has play goes back over it
        (ONCE_MORE + 50, 6000, False),  # nothing turned back after it
        (3000, 6000, False),  # on the way, where every jump is looked for anyhow
    ],
)
def test_a_jump_at_a_reversal_is_lost_counts_where_the_next_does_not_undo_it(
    rng: np.random.Generator, rises: int, falls: int, is_kept: bool
) -> None:
    e = 1e-6 * rng.standard_normal(6000)
    e[rises:falls] += 2.5e-5
    e[2200:] -= 4e-5  # known by now
    found = kept(e, UP_DOWN_UP, [(2200, -4e-5)])
    assert len(found) == is_kept
    for row, size in found:
        assert row == pytest.approx(rises, abs=4)
        assert size == pytest.approx(2.5e-5, rel=0.1)


@pytest.mark.parametrize(("shown", "left"), [(True, []), (False, [0, 1])])
def test_in_a_lock_test_jumps_are_what_they_are_where_the_torque_tells(
    rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch, shown: bool, left: list[int]
) -> None:
    """A torque sensor whose zero jumps seems to wind the gear up; run 1 is a lock test, with no balance of the load."""
    e = {(i, "A"): 4e-6 * rng.standard_normal(4000) + 3e-5 * (np.arange(4000) > 2500) for i in range(2)}
    e[0, "L"] = np.zeros(4000)
    for name in ("_onward", "_onward_rippling"):
        monkeypatch.setattr(steps, name, lambda eq, key: np.ones(4000, dtype=bool))
    monkeypatch.setattr(steps, "_of_the_torque", lambda eq, e, key, *of: shown and key[0] == 0)
    monkeypatch.setattr(steps, "_lasts", lambda *of: True)
    monkeypatch.setattr(steps, "_placed", lambda eq, e, run, row: (row, LOAD))
    monkeypatch.setattr(steps, "_in_other_parts", lambda *of: {})
    assert sorted(steps.find_steps(one_way(2), e).rows) == left


def test_the_jump_of_a_run_is_in_its_other_parts_too(rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch) -> None:
    """Alternate turns are held out; the load encoder loses three counts in the middle of one of them."""
    t, lost = 0.008 * np.arange(1200), 15e-6
    seen = np.arange(1200) // 150 % 2 == 0
    e = 4e-6 * rng.standard_normal(1200) + lost * (t > t[500])
    times = {0: t[seen], 1: t[~seen], 2: t[~seen]}
    monkeypatch.setattr(steps, "clock", lambda eq, key: times[key[0]])
    names = ("speed_1", f"speed_1 ({HELD_PART})", f"speed_2 ({HELD_PART})")
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(name=name) for name in names])
    at = int(np.searchsorted(times[0], t[500]))
    left = {(0, "A"): e[seen], (1, "A"): e[~seen], (2, "A"): e[~seen]}
    found = steps._in_other_parts(eq, left, {0: (at,)}, {0: (lost,)})
    assert list(found) == [1]  # the third is another run's
    ((row, size),) = found[1]
    assert times[1][row] == pytest.approx(t[500], abs=0.1)
    assert size == pytest.approx(lost, rel=0.2)
    assert not steps._in_other_parts(eq, left, {0: (at,), 1: (row,)}, {0: (lost,), 1: (size,)}), "it is known there"
    left[1, "A"] = left[1, "A"] - np.where(times[1] > t[500], lost, 0.0)  # what came back is not lost
    assert not steps._in_other_parts(eq, left, {0: (at,)}, {0: (lost,)})


def test_a_part_in_which_one_jump_was_found_has_the_others_of_its_run_too(
    rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    t = 0.008 * np.arange(1800)
    seen = np.arange(1800) // 150 % 2 == 0
    e = 4e-6 * rng.standard_normal(1800) + 25e-6 * (t > t[500]) + 15e-6 * (t > t[1400])
    times = {0: t[seen], 1: t[~seen]}
    monkeypatch.setattr(steps, "clock", lambda eq, key: times[key[0]])
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(name=name) for name in ("slow", f"slow ({HELD_PART})")])
    here = tuple(int(np.searchsorted(times[0], t[row])) for row in (500, 1400))
    there = int(np.searchsorted(times[1], t[500]))
    left = {(0, "A"): e[seen], (1, "A"): e[~seen]}
    found = steps._in_other_parts(eq, left, {0: here, 1: (there,)}, {0: (25e-6, 15e-6), 1: (25e-6,)})
    ((row, size),) = found[1]
    assert times[1][row] == pytest.approx(t[1400], abs=0.1)
    assert size == pytest.approx(15e-6, rel=0.2)


def test_a_line_stands_out_of_its_surroundings_at_its_frequency(rng: np.random.Generator) -> None:
    t = np.arange(5000) * 0.008
    grid = np.arange(1.0, 55.0, 0.02)
    heights = _heights(t, np.sin(2 * np.pi * 7.99 * t) + rng.standard_normal(t.size), grid)
    assert grid[int(np.argmax(heights))] == pytest.approx(7.99, abs=0.05)
    assert np.mean(_heights(t, rng.standard_normal(t.size), grid) > 15.0) < 1e-2


def jumped(angles: list[float], turns: float) -> tuple[Any, Steps]:
    """Eight runs over `turns` of the output of a gear of ratio 50, each with a jump at one of its motor `angles`."""
    theta = np.linspace(0.0, 2 * np.pi * 50 * turns, 20000)
    runs = [SimpleNamespace(ratio=50.0)] * len(angles)
    rows = {(i, "A"): SimpleNamespace(theta_m=theta) for i in range(len(angles))}
    at = {i: (int(np.searchsorted(theta, angle)),) for i, angle in enumerate(angles)}
    sizes, sides, errors = (dict.fromkeys(at, (value,)) for value in (3e-5, LOAD, 1e-7))
    return SimpleNamespace(runs=runs, rows=rows), Steps(at, sizes, sides, errors)


def test_jumps_at_one_angle_of_the_output_are_a_scale_with_a_fault_and_no_lost_counts(rng: np.random.Generator) -> None:
    turn = 2 * np.pi * 50
    assert not lost_counts(*jumped([0.3 * turn + 0.1 * i + turn * (i % 2) for i in range(8)], 2.0), [])
    assert lost_counts(*jumped([float(a) for a in rng.uniform(0, 2 * turn, 8)], 2.0), [])


def test_jumps_in_runs_that_saw_a_few_degrees_of_the_output_may_be_lost_counts() -> None:
    assert lost_counts(*jumped([1.0, 9.0, 4.0, 12.0, 2.7, 7.0, 10.1, 5.5], 0.05), [])


def test_steps_are_weighed_by_the_angle_they_explain_whatever_is_left_of_the_torques(rng: np.random.Generator) -> None:
    n = np.arange(1000)
    step = (n > 400) * 1.0
    noise = Noise({"A": 5e-6, "M": 2e-3}, {"A": 1.0, "M": 1.0}, {"A": np.inf, "M": np.inf})
    run: Any = SimpleNamespace(locked=False)
    eq = Equations((run,), {}, noise)
    e = {(0, "A"): 5e-5 * (step - step.mean()), (0, "M"): 5e-3 * rng.standard_normal(1000)}
    columns = {(0, "A"): step[:, None], (0, "M"): np.eye(1000)[:, 400:401]}
    assert explained(eq, e, columns) > 0.9


def test_below_a_floor_that_is_too_high_steps_must_still_take_a_part_of_all_there_is() -> None:
    step = (np.arange(1000) > 400) * 1.0
    noise = Noise({"A": 5e-5}, {"A": 1.0}, {"A": np.inf})
    run: Any = SimpleNamespace(locked=False)
    eq = Equations((run,), {}, noise)
    wander = 2e-5 * np.sin(np.arange(1000) / 30)
    columns = {(0, "A"): step[:, None]}
    assert explained(eq, {(0, "A"): wander + 1e-5 * step}, columns) < 0.5
    assert explained(eq, {(0, "A"): wander + 6e-5 * step}, columns) > 0.5


@pytest.mark.parametrize(("louder", "all_of_it"), [(1.0, True), (2.0, False)])
def test_steps_below_the_floor_are_all_that_a_run_has_beyond_its_repeats_or_are_not(
    monkeypatch: pytest.MonkeyPatch, louder: float, all_of_it: bool, rng: np.random.Generator
) -> None:
    """Runs of other conditions have more noise, which says nothing of these."""
    step = (np.arange(2000) > 900) * 1.0
    noise = Noise({"A": 5e-5}, {"A": 1.0}, {"A": np.inf})
    runs: Any = tuple(
        SimpleNamespace(name=f"{kind}_{i}", kind=kind, locked=False) for kind in ("slow", "fast") for i in range(3)
    )
    monkeypatch.setattr(steps, "alike", lambda a, b: a.kind == b.kind)
    e = {(i, "A"): (2e-5 if i < 3 else 8e-5) * rng.standard_normal(2000) for i in range(6)}
    e[0, "A"] = louder * e[0, "A"] + 2e-5 * (step - step.mean())
    share = explained(Equations(runs, {}, noise), e, {(0, "A"): step[:, None]})
    assert (share > 0.7) is all_of_it


@pytest.mark.parametrize(("after", "stays"), [(3e-5, True), (0.0, False)])
def test_counts_are_lost_for_good_and_a_bump_is_not(
    monkeypatch: pytest.MonkeyPatch, after: float, stays: bool, rng: np.random.Generator
) -> None:
    """The held-out middle of a run goes up by 3e-5 rad; its other parts say whether it stayed there."""
    t = np.arange(1200) * 0.008
    middle = (t > 4.0) & (t < 6.0)
    times = {(0, "A"): t[~middle], (1, "A"): t[middle]}
    monkeypatch.setattr(steps, "clock", lambda eq, key: times[key])
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(name="speed"), SimpleNamespace(name=f"speed ({HELD_PART})")])
    e = {
        (0, "A"): after * (times[0, "A"] > 5.0) + 2e-6 * rng.standard_normal(times[0, "A"].size),
        (1, "A"): 3e-5 * (times[1, "A"] > 5.0) + 2e-6 * rng.standard_normal(times[1, "A"].size),
    }
    assert steps._lasts(eq, e, (1, "A"), [(int(np.searchsorted(t[middle], 5.0)), 3e-5)]) is stays


def test_a_motor_that_goes_on_across_rows_that_are_held_out_has_not_rested() -> None:
    t = np.arange(600) * 0.008
    theta = 5.0 * t
    held_out = np.delete(np.arange(600), np.arange(200, 300))
    assert not _rested(theta[held_out], t[held_out]).any()
    paused = np.where(t < 2.0, theta, np.maximum(theta - 3.0, 10.0))
    assert np.flatnonzero(_rested(paused[held_out], t[held_out])).tolist() == [199]


STEPS = {  # rad that a reading is off by from a moment on, by run
    "load_10nm_1": ("theta_m", -33 * 2 * np.pi / 65536),
    "speed_200rpm_1": ("theta_l", 12 * 2 * np.pi / 1296000),
}


@pytest.mark.long
def test_each_step_is_told_to_the_encoder_that_made_it_though_no_run_is_repeated(tmp_path: Path, shared: Path) -> None:
    names = ("slow_ke_1", "load_2.5nm_1", "load_10nm_1", "load_40nm_1", "speed_60rpm_1", "speed_200rpm_1")

    def stepped(c: Columns, began: float) -> Columns:
        name = next(name for name, at in starts.items() if at == began)
        if name not in STEPS:
            return {}
        channel, size = STEPS[name]
        return {channel: c[channel] + np.where(np.arange(c["t"].size) > 0.45 * c["t"].size, size, 0.0)}

    campaign = shared / "cases" / "open-1"
    starts = {name: started(campaign / name) for name in names}
    found = spiked(tmp_path, campaign, stepped, names)
    assert found.verdict.effects == ("missed_counts",)
    values = {p.name: p.value for p in found.effects[0].parameters}
    assert values["step_theta_m"] == pytest.approx(33 * 2 * np.pi / 65536 / 50, rel=0.1)
    assert values["step_theta_l"] == pytest.approx(12 * 2 * np.pi / 1296000, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("times", [2, pytest.param(1, marks=pytest.mark.long)], ids=["repeated", "once"])
@pytest.mark.long
def test_a_single_loss_in_a_fitted_run_is_told_where_its_repeat_has_none_or_nothing_was_repeated(
    tmp_path: Path, shared: Path, times: int
) -> None:
    names = [f"{kind}_{k + 1}" for kind in ("slow_ke", "load_10nm", "speed_200rpm") for k in range(times)]
    campaign = shared / "cases" / "open-1"
    hit = started(campaign / "load_10nm_1")

    def stepped(c: Columns, began: float) -> Columns:
        lost = 9 * 2 * np.pi / 1296000 * (np.arange(c["t"].size) > 0.45 * c["t"].size)
        # against the torque: the way it pulls, a spring that gave way would look so
        return {"theta_l": c["theta_l"] + lost} if began == hit else {}

    found = spiked(tmp_path, campaign, stepped, names)
    assert "load_10nm_1" in found.fitted
    assert found.verdict.effects == ("missed_counts",)
    assert "held-out ones have none" in found.verdict.sentence


@pytest.mark.slow
@pytest.mark.long
def test_a_staircase_of_steps_too_small_to_be_seen_is_told_by_the_way(tmp_path: Path, shared: Path) -> None:
    """One count on every 0.15 rad or so that the output gets further from where its run began, whichever way."""
    kinds = ("slow_ke", "speed_60rpm", "speed_200rpm", "speed_400rpm", "speed_minus200rpm")
    names = [f"{kind}_{k}" for kind in kinds for k in (1, 2)]

    def stepped(c: Columns, began: float) -> Columns:
        way = np.maximum.accumulate(np.abs(c["theta_m"] - c["theta_m"][0])) / RATIO
        at = np.cumsum(np.random.default_rng(round(began)).uniform(0.05, 0.25, 100))
        return {"theta_l": c["theta_l"] - 2 * np.pi / 1296000 * np.searchsorted(at, way)}

    found = spiked(tmp_path, shared / "cases" / "open-1", stepped, names)
    assert found.verdict.effects == ("missed_counts",)
    values = {p.name: p for p in found.effects[0].parameters}
    per_turn = 2 * np.pi / 1296000 / 0.15 * 2 * np.pi
    assert values["lost_per_turn_further"].value == pytest.approx(per_turn, rel=0.1)
    assert not found.effects[0].each_run


@pytest.mark.slow
@pytest.mark.long
def test_counts_lost_in_every_fast_run_are_no_delays_of_the_runs(tmp_path: Path, shared: Path) -> None:
    """What the losses shift a run by, the faster it is the more, looks like delays of its own (exam 96, case 01)."""
    fast = ("200rpm", "300rpm", "400rpm")

    def stepped(c: Columns, began: float) -> Columns:
        rng = np.random.default_rng(round(began))
        at, counts = rng.uniform(0.2, 0.8, (3, 1)), rng.integers(0, 4, (3, 1))
        lost = np.sum(counts * (c["t"] > at * c["t"][-1]), axis=0) if began in hit else 0
        return {"theta_l": c["theta_l"] - 6 * 2 * np.pi / 1296000 * lost}

    campaign = shared / "cases" / "open-1"
    hit = {started(run) for run in campaign.glob("speed_*") if run.name.split("_")[1].removeprefix("minus") in fast}
    found = spiked(tmp_path, campaign, stepped)
    assert found.verdict.effects == ("missed_counts",)
    assert found.effects[0].each_run


@pytest.mark.slow
@pytest.mark.long
def test_counts_lost_one_way_alone_are_told_by_that_way(tmp_path: Path, shared: Path) -> None:
    def lossy(c: Columns, began: float) -> Columns:
        step = np.diff(c["theta_m"], prepend=c["theta_m"][0]) / RATIO
        return {"theta_l": c["theta_l"] - 2e-5 * np.cumsum(np.maximum(step, 0.0))}

    found = spiked(tmp_path, shared / "cases" / "open-1", lossy)
    assert found.verdict.effects == ("missed_counts",)
    values = {p.name: p for p in found.effects[0].parameters}
    assert values["lost_per_turn_forth"].value == pytest.approx(2e-5 * 2 * np.pi, rel=0.1)


@pytest.mark.slow
@pytest.mark.long
def test_a_fitted_run_that_stands_far_above_its_floor_is_said_though_unseen_runs_leave_nothing(
    tmp_path: Path, shared: Path
) -> None:
    """Counts lost one by one over two seconds: no step, and no run that is held out has it."""
    names = ("slow_ke_1", "slow_ke_2", "load_10nm_1", "load_10nm_2", "speed_200rpm_1", "speed_200rpm_2")
    campaign = shared / "cases" / "open-1"
    hit = started(campaign / "load_10nm_1")

    def slipping(c: Columns, began: float) -> Columns:
        t = c["t"] - c["t"][0]
        lost = 40 * 2 * np.pi / 65536 * np.clip((t - 0.45 * t[-1]) / 2.0, 0.0, 1.0)
        return {"theta_m": c["theta_m"] - lost} if began == hit else {}

    found = spiked(tmp_path, campaign, slipping, names)
    assert "load_10nm_1" in found.fitted
    assert (found.verdict.status, found.verdict.coordinate) == ("unknown_effect", "time")
    assert found.verdict.effects == ()
    assert found.verdict.sentence.startswith("load_10nm_1 has ")
    assert "load_10nm_2, taken alike, has not" in found.verdict.sentence


def test_of_a_run_that_nothing_was_taken_like_it_is_said_so() -> None:
    def at(rpm: float, name: str) -> Any:
        return SimpleNamespace(name=name, rpm=rpm)

    def told(*runs: Any) -> bool:
        split = SimpleNamespace(fitted=(0, 1), held_out=tuple(range(2, len(runs))))
        p: Any = SimpleNamespace(eq=SimpleNamespace(runs=runs), split=split)
        return hidden._is_repeated(p, runs[0])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hidden, "alike", lambda one, other: one.rpm == other.rpm)
        assert not told(at(60.0, "a"), at(200.0, "b"), at(200.0, "c"))
        assert not told(at(60.0, "a"), at(200.0, "b"), at(60.0, f"a ({HELD_PART})"))  # a part of itself says nothing
        assert told(at(60.0, "a"), at(200.0, "b"), at(60.0, "c"))


@pytest.mark.parametrize(("of_the_load", "share"), [(True, 0.95), (False, 0.1)])
def test_without_torque_sensor_a_torque_on_the_load_shows_in_angle_and_motor_torque_as_one(
    rng: np.random.Generator, of_the_load: bool, share: float
) -> None:
    """In the proportion 1/K to 1/N; what one sensor picks up shows in one of them."""
    t = np.arange(4000) * 0.008
    wave = np.stack([np.cos(70.0 * t), np.sin(70.0 * t)], 1)
    columns = {(0, "A"): wave / 7200.0, (0, "M"): wave / 50.0}
    torque = wave @ np.array([0.2, 0.1])
    e = {
        (0, "A"): torque / 7200.0 + 5e-6 * rng.standard_normal(t.size),
        (0, "M"): (torque / 50.0 if of_the_load else 0.0) + 2e-3 * rng.standard_normal(t.size),
    }
    noise = Noise({"A": 5e-6, "M": 2e-3}, {"A": 1.0, "M": 1.0}, {"A": np.inf, "M": np.inf})
    run: Any = SimpleNamespace(locked=False)
    as_one, sizes = _as_one(Equations((run,), {}, noise), e, columns)
    assert as_one > share if of_the_load else as_one < share
    if of_the_load:
        assert sizes == [pytest.approx(np.hypot(0.2, 0.1), rel=0.01)]


def test_a_step_that_wander_hides_in_short_means_is_found_in_long_ones(rng: np.random.Generator) -> None:
    wander = np.convolve(rng.standard_normal(4060), np.exp(-(np.linspace(-3, 3, 61) ** 2)), mode="valid")
    e = 5e-6 * wander / np.std(wander)
    e[2500:] += 1e-5
    known = (0.65e-5, 1.35e-5)
    assert jumps(e, np.ones(4000, bool), 4.0, known) == []
    (found,) = jumps(e, np.ones(4000, bool), 4.0, known, window=FAR)
    assert abs(found[0] - 2500) <= 20


def test_only_what_never_comes_back_is_off_for_good(rng: np.random.Generator) -> None:
    e = 1e-6 * rng.standard_normal(3000)
    branch = e + 1e-5 * ((np.arange(3000) // 500) % 2)
    lost = e + 1e-5 * (np.arange(3000) >= 1500)
    assert steps._for_good(lost, 1e-5)[1490:1510].all()
    assert not steps._for_good(branch, 1e-5)[400:2600].any()


def test_two_counts_of_a_fine_encoder_show_over_a_longer_window_and_noise_shows_none(rng: np.random.Generator) -> None:
    """Beside a wander of 2 Hz, as an output has it, of which a third of a second is full."""
    onward, keeps = np.ones(12000, dtype=bool), np.exp(-2 * np.pi * 2.0 / 125)
    hidden = 0
    for _ in range(10):
        wander = lfilter([np.sqrt(1 - keeps**2)], [1, -keeps], 2.5e-6 * rng.standard_normal(12000))
        e = wander + 5e-7 * rng.standard_normal(12000)
        assert _sure(e, onward) == []
        lost = e + 13e-6 * (np.arange(12000) >= 7000)
        hidden += not jumps(lost, onward, STEP, (0.0, np.inf))
        ((row, size),) = _sure(lost, onward)
        assert abs(row - 7000) < 8 * EDGE
        assert size == pytest.approx(13e-6, rel=0.4)
    assert hidden >= 5
