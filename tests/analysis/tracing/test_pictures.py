"""Arrays of the page: bins, shares and intervals find what was put in, and nothing where nothing was."""

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis.tracing.outcome.pictures import interval
from rig.analysis.tracing.residual.binned import folds
from rig.analysis.tracing.residual.bins import BINNED, rms
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.shares import COORDINATES, PAIRS, score_of_orders, shares
from rig.analysis.tracing.selection.candidates import Tried, reason

SLOW, FAST = 0.6, 20.0  # output rad seen in a run


def made(of: str, size: float = 3.0, seed: int = 1) -> Rest:
    """Two slow runs that see a tenth of the output's turn, a fast one that sees three; noise of the floor."""
    rng = np.random.default_rng(seed)
    parts = [
        {
            "load_angle": start + np.linspace(0, width, 8000),
            "motor_angle": 50 * (start + np.linspace(0, width, 8000)),
            "load": load + rng.normal(0, 0.1, 8000),
            "motor_torque": np.full(8000, np.nan),
            "speed": np.full(8000, 50 * width / 64),
            "direction": np.ones(8000),
            "time": run * 100.0 + np.arange(8000) / 125,
            "temperature": np.full(8000, np.nan),
            "torque_rate": np.ones(8000),
        }
        for run, (start, width, load) in enumerate(((0.0, SLOW, 5.0), (2.0, SLOW, 40.0), (0.0, FAST, 5.0)))
    ]
    at = {name: np.concatenate([p[name] for p in parts]) for name in parts[0]}
    run = np.repeat([0, 1, 2], 8000)
    put_in = {
        "nothing": np.zeros(24000),
        "once per output turn": np.sqrt(2) * np.cos(at["load_angle"]),
        "motor angle scaled by load": np.sqrt(2) * np.cos(2 * at["motor_angle"]) * np.where(at["load"] > 20, 1, -1),
    }[of]
    e = size * put_in + rng.normal(0, 1, 24000)
    e -= np.array([e[run == i].mean() for i in range(3)])[run]  # as the angle equation's own offset does
    return Rest(e, run, at, 1 / 125, np.zeros((24000, 0)), np.zeros((0, 0)))


def share_of(of: str) -> dict[str, float]:
    found = shares(made(of), "A")["share.A"]
    return dict(zip([*COORDINATES, *map(" ".join, PAIRS)], found, strict=True))


def test_an_error_once_per_output_turn_is_found_though_slow_runs_see_a_part_of_it() -> None:
    found = share_of("once per output turn")
    assert found["load_angle"] > 0.95
    assert found["motor_angle"] < 0.2


def test_what_load_does_to_the_kinematic_error_shows_in_the_pair_alone() -> None:
    found = share_of("motor angle scaled by load")
    assert found["motor_angle load"] > 0.8
    assert found["load"] < 0.1
    assert found["load_angle"] < 0.1


def test_friction_along_the_motor_angle_shows_beside_the_direction_alone() -> None:
    base, rng = made("nothing"), np.random.default_rng(5)
    way = np.where(np.arange(24000) // 1000 % 2, 1.0, -1.0)
    e = 3 * np.sqrt(2) * way * np.cos(base.at["motor_angle"]) + rng.normal(0, 1, 24000)
    there_and_back = replace(base, e=e, at=base.at | {"direction": way})
    found = dict(zip([*COORDINATES, *map(" ".join, PAIRS)], shares(there_and_back, "A")["share.A"], strict=True))
    assert found["motor_angle direction"] > 0.8
    assert max(found["motor_angle"], found["direction"]) < 0.1


def test_a_loop_in_the_torque_shows_as_memory_though_the_torque_is_noisy() -> None:
    base = made("nothing")
    rng = np.random.default_rng(5)
    torque = 50 * np.sin(2 * np.pi * np.arange(24000) / 6000)
    way = np.sign(np.cos(2 * np.pi * np.arange(24000) / 6000))
    e = 3 * way + rng.normal(0, 1, 24000)
    loop = replace(base, e=e, at=base.at | {"load": torque + rng.normal(0, 0.1, 24000)})
    found = dict(zip(COORDINATES, shares(loop, "A")["share.A"], strict=False))
    assert found["memory"] > 0.8  # around a reversal, and in levels passed in a few rows, it cannot be told
    assert found["load"] < 0.1


def test_noise_alone_is_predicted_by_no_angle() -> None:
    gained = score_of_orders(made("nothing"), folds(made("nothing")), "load_angle", 8)
    assert gained == pytest.approx(0.0, abs=0.01)


def test_the_shaft_torque_cannot_be_predicted_by_its_own_reading() -> None:
    found = shares(made("motor angle scaled by load"), "L")["share.L"]
    own = [np.isnan(v) for v in found]
    names = [*COORDINATES, *map(" ".join, PAIRS)]
    assert [name for name, nan in zip(names, own, strict=True) if nan] == ["load", "memory", "motor_angle load"]


def test_bins_hold_the_rms_of_their_rows_and_nothing_when_rows_are_few() -> None:
    index = np.repeat([0, 1, -1], [100, 5, 50])
    found = rms(np.repeat([2.0, 9.0, 50.0], [100, 5, 50]), index, 3)
    assert found[0] == pytest.approx(2.0)
    assert np.isnan(found[1:]).all()


def test_speeds_of_slow_and_fast_runs_stand_in_bins_of_their_own() -> None:
    found = BINNED["speed"](made("nothing"))
    assert found is not None
    index, middles = found
    speeds = np.unique(index)
    assert speeds.size == 2
    for i, rpm in zip(speeds, (50 * SLOW / 64 * 30 / np.pi, 50 * FAST / 64 * 30 / np.pi), strict=True):
        assert middles[i] == pytest.approx(rpm, rel=0.35)


def test_the_interval_of_an_rms_covers_it_and_narrows_with_runs() -> None:
    rng = np.random.default_rng(3)
    few, many = (interval([rng.normal(0, 2, 4000) for _ in range(n)]) for n in (2, 20))
    assert few[0] < 2.0 < few[1]
    assert many[1] - many[0] < few[1] - few[0]


def test_an_interval_covers_the_truth_as_often_as_it_says() -> None:
    rng = np.random.default_rng(4)
    hits = 0
    for _ in range(60):
        low, high = interval([rng.normal(0, size, 200) for size in np.ones(12)])
        hits += low < 1.0 < high
    assert hits >= 50  # of 60; 57 are expected, and 50 or fewer come by once in some hundred tries


def test_the_reason_says_how_much_a_candidate_removes_and_what_would_be_asked_for() -> None:
    assert reason(Tried({}, 0.05, "A"), "lost_motion", ("cogging_torque",)) == (
        "alone it removes 5 % of the excess in the held-out kinematic error, 60 % would be asked for"
    )
    assert "beside cogging torque it is not needed" in reason(Tried({}, 0.7, "M"), "torque_ripple", ("cogging_torque",))
    assert "removes nothing of the excess" in reason(Tried({}, -0.001, "A"), "quadratic_drag", ())
    assert "worse" in reason(Tried({}, -0.3, "L"), "quadratic_drag", ())
    lock_tests_alone = Tried({}, 2.1, "A", over=False)
    assert reason(lock_tests_alone, "hysteretic_stiffness", ("hysteretic_stiffness",)) == (
        "alone it lowers the held-out kinematic error, which is above its floor in single runs only"
    )
    assert "not needed" not in reason(Tried({}, 0.99, "M"), "cogging_torque", ("cogging_torque",))
