"""Intervals of identification: what is counted twice makes them too wide, what is shared and forgotten too narrow."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from rig.analysis.identify.friction import motor_friction
from rig.analysis.identify.gram import Rows, _guessed, solve
from rig.analysis.identify.locked import about_the_same_angle, locked_rows
from rig.analysis.identify.means import Mean, Sides, mean_of, variances
from rig.analysis.identify.mode import free_mode
from rig.analysis.identify.recording import Plateau, Recording, plateaus, recording
from rig.analysis.identify.solve import covariance_between, random_effects
from rig.analysis.identify.stretches import stretches
from rig.model.fourier import FourierSeries
from tests.analysis.identify.test_identify import Made

Array = npt.NDArray[np.float64]
J, B, TAU_C = 1.2e-3, 3.3e-3, 0.30  # kg·m², N·m·s/rad, N·m: of the paper's rig, nearly
FLAT = FourierSeries((0.0,), (0.0,))
COUNT = 2 * np.pi / 10000


def wandering(rpm: float, seconds: float, generator: np.random.Generator) -> Recording:
    """A motor alone under one constant torque, its friction wandering by 1 % with 0.3 s of memory."""
    n, dt, keep = int(seconds * 1000), 1e-3, np.exp(-1e-3 / 0.3)
    white = generator.standard_normal(n) * np.sqrt(1 - keep**2)
    omega, wander, theta = rpm * np.pi / 30, 0.0, np.zeros(n)
    tau = TAU_C + B * omega
    for k in range(1, n):
        wander = keep * wander + white[k]
        omega += dt * (tau - TAU_C * (1 + 0.01 * wander) - B * omega) / J
        theta[k] = theta[k - 1] + dt * omega
    columns = {
        "t": dt * np.arange(n), "theta_m": theta, "theta_l": theta / 50, "tau_l": np.zeros(n),
        "tau_ask": np.full(n, tau), "tau_m": tau + 0.004 * generator.standard_normal(n),
    }  # fmt: skip
    found = recording(Made(f"at_{rpm:g}", columns))
    assert found is not None
    return found


@pytest.fixture(scope="module")
def slow_and_wandering() -> Recording:
    return wandering(60.0, 40.0, np.random.default_rng(11))


def test_plateaus_under_one_torque_are_one_stretch(slow_and_wandering: Recording) -> None:
    level = plateaus(slow_and_wandering)
    joined = stretches(level)
    assert len(level) > len(joined) == 1, "friction that wanders had cut it"
    turns = (slow_and_wandering.theta_m[joined[0].hi] - slow_and_wandering.theta_m[joined[0].lo]) / (2 * np.pi)
    assert turns == pytest.approx(round(turns), abs=0.01)
    assert (joined[0].lo, joined[0].hi <= level[-1].hi) == (level[0].lo, True)


def test_plateaus_under_other_units_or_none_known_stay_apart(slow_and_wandering: Recording) -> None:
    level = plateaus(slow_and_wandering)
    columns = slow_and_wandering.source.columns  # type: ignore[attr-defined]
    asked = columns["tau_ask"].copy()
    asked[level[0].hi :] += 0.01
    for change in ({**columns, "tau_ask": asked}, {k: v for k, v in columns.items() if k != "tau_ask"}):
        other = recording(Made("other", change))
        assert other is not None
        assert len(stretches(plateaus(other))) > 1


@pytest.mark.slow
def test_a_line_through_runs_at_constant_torque_covers_the_drag_as_often_as_it_says() -> None:
    """Eight runs a rig, ten rigs: every plateau by itself gave half as much again."""
    z = []
    for seed in range(10):
        generator = np.random.default_rng([5, seed])
        means = [
            mean_of(p, FLAT, Sides(J_m=J, B=B)) for rpm in (200, 300, 400, 500) for _ in range(2)
            for p in stretches(plateaus(wandering(rpm, 8.0, generator)))
        ]  # fmt: skip
        found = motor_friction(means)
        assert found is not None
        assert len(found.rows) == 8
        z += [(found.solved.coefficients[i] - true) / found.solved.u(i) for i, true in ((0, B), (1, TAU_C))]
    assert 0.6 < np.sqrt(np.mean(np.square(z))) < 1.6  # 20 figures, two and two: 1 ± 0.2


def test_pieces_at_constant_torque_show_the_friction_that_the_speed_shows(slow_and_wandering: Recording) -> None:
    one = stretches(plateaus(slow_and_wandering))[0]
    blind, seeing = (mean_of(one, FLAT, sides).motor_side for sides in (Sides(), Sides(J_m=J, B=B)))
    made = 0.01 * TAU_C * np.sqrt(2 * 0.3 / 1.0 * (1 - 0.3))  # 1 s of noise with 0.3 s of memory
    assert np.std(seeing.pieces) == pytest.approx(made, rel=0.35)
    assert np.std(blind.pieces) < 0.2 * made, "the torque is constant: by itself it shows nothing"
    assert seeing.mean == pytest.approx(blind.mean, abs=2e-4)


def test_pieces_that_go_together_make_a_mean_less_certain() -> None:
    generator = np.random.default_rng(4)
    white = generator.standard_normal((40, 30))
    together = white + 0.5 * np.roll(white, 1, axis=1)
    alone = variances(list(white), [30.0] * 40)[0]
    shared = variances(list(together), [30.0] * 40)[0]
    assert alone == pytest.approx(1 / 30, rel=0.15)
    assert shared == pytest.approx(1.5**2 / 30, rel=0.2)


@pytest.mark.slow
def test_rows_within_chance_get_no_variance_between_them_and_intervals_that_cover() -> None:
    generator, hits, between = np.random.default_rng(8), 0, 0
    X = np.column_stack((np.linspace(-1, 1, 30), np.ones(30)))
    v = np.geomspace(0.01, 1.0, 30)  # the best rows would suffer most
    for _ in range(400):
        found = random_effects(X, X @ [2.0, 1.0] + np.sqrt(v) * generator.standard_normal(30), v)
        hits += abs(found.coefficients[0] - 2.0) <= found.half(0)
        between += found.between > 0.0
    assert 0.93 <= hits / 400 <= 0.97
    assert between <= 36  # 1 in 20, and three standard errors


def test_two_fits_of_the_same_windows_know_what_they_share() -> None:
    """τ = a·x and y = τ/b with the noise in τ: a and 1/b err together, a·(1/b) hardly does."""
    generator, products, claimed = np.random.default_rng(6), [], []
    x = np.exp(1j * generator.uniform(0, 6, (1, 15, 1)))
    for _ in range(60):
        torque = 2.0 * x + 0.05 * (generator.standard_normal((40, 15, 1)) + 1j * generator.standard_normal((40, 15, 1)))
        load = solve([Rows("a", np.tile(x, (40, 1, 1)), torque[:, :, 0], 1.0)], [], 1)
        spring = solve([Rows("a", torque, (3.0 * np.tile(x, (40, 1, 1))[:, :, 0]).astype(np.complex128), 1.0)], [], 1)
        assert load is not None
        assert spring is not None
        a, c = load.coefficients[0], spring.coefficients[0]
        shared = float(covariance_between(load, spring)[0, 0])
        products.append(a * c)
        variance = c**2 * load.u(0) ** 2 + a**2 * spring.u(0) ** 2 + 2 * a * c * shared
        claimed.append((np.sqrt(variance), np.hypot(c * load.u(0), a * spring.u(0))))
        assert shared / (load.u(0) * spring.u(0)) == pytest.approx(-1.0, abs=0.05)
    assert np.std(products) < 0.3 * np.mean([alone for _, alone in claimed])
    assert np.mean([joint for joint, _ in claimed]) < 0.4 * np.mean([alone for _, alone in claimed])


def test_windows_that_scatter_less_than_their_neighbouring_orders_say_so() -> None:
    """All the noise is in order 5, all that is known comes from order 3: pooled noise alone would be far too much."""
    generator, z = np.random.default_rng(9), []
    X = np.zeros((1, 8, 1), dtype=complex)
    X[0, 2, 0] = 1.0
    sigma = np.full(8, 0.01)
    sigma[4] = 1.0
    for _ in range(100):
        noise = sigma * (generator.standard_normal((40, 8)) + 1j * generator.standard_normal((40, 8)))
        found = solve(
            [Rows("a", np.tile(X, (40, 1, 1)), np.asarray(X[:, :, 0] + noise, dtype=np.complex128), 1.0)], [], 1
        )
        assert found is not None
        z.append((found.coefficients[0] - 1.0) / found.u(0))
    assert np.sqrt(np.mean(np.square(z))) == pytest.approx(1.0, abs=0.25)


def lock_run(begin: float, generator: np.random.Generator, **more: Any) -> Recording:
    """A wind-up to ±15 N·m, 2 s held at either end, under a loop that stops where a count turns over."""
    K, t = 7000.0, np.arange(0.0, 44.0, 0.01)
    ask = 15.0 * np.interp(t, [0, 10, 12, 22, 32, 34, 44], [0, 1, 1, 0, -1, -1, 0])
    true = begin + 50 * ask / K
    for lo, hi, edge in ((10.0, 12.0, np.floor), (32.0, 34.0, np.ceil)):
        held = (t >= lo) & (t < hi)
        true[held] = edge(true[held] / COUNT) * COUNT + (1e-9 if edge is np.floor else -1e-9)
    seen = (np.floor(true / COUNT) + 0.5) * COUNT
    torque = K * (true - begin) / 50 + 0.01 * generator.standard_normal(t.size)
    made = Made("lock", {"t": t, "theta_m": seen, "theta_l": 0 * t, "tau_l": torque}, output_locked=True, **more)
    made.manifest = {**made.manifest, "encoders": {"motor_counts_per_rev": 10000}}
    found = recording(made)
    assert found is not None
    return found


def test_a_loop_that_rests_on_the_edge_of_a_count_does_not_soften_the_spring() -> None:
    generator, errors = np.random.default_rng(2), []
    for _ in range(20):
        part = locked_rows(lock_run(generator.uniform(0, 6), generator), 1, 5, 2, np.zeros(5), 1)
        assert part is not None
        errors.append(part.H[2, 2] / part.g[2] / 7000.0 - 1.0)
    assert abs(np.mean(errors)) < 2e-4  # 0.08 % with every row of the two stops


def test_lock_runs_at_one_angle_know_its_counts_no_better_than_one() -> None:
    generator = np.random.default_rng(3)
    runs = [
        lock_run(1.0, generator),
        lock_run(1.02, generator),
        lock_run(1.0 + 2 * np.pi, generator),
        lock_run(2.5, generator),
    ]
    assert [about_the_same_angle(r, runs) for r in runs] == [3, 3, 3, 1]
    one, three = (locked_rows(runs[0], 1, 5, 2, np.zeros(5), alike) for alike in (1, 3))
    assert one is not None
    assert three is not None
    assert three.H[2, 2] < one.H[2, 2], "each of them says less"
    assert 3 * three.H[2, 2] <= one.H[2, 2] * 3.0


def test_the_free_mode_is_that_of_two_inertias_on_a_spring() -> None:
    omega, zeta = free_mode({"J_m": 1e-3, "J_l": 2.5, "K": 7000.0, "B_sp": 14.0}, 50.0)
    assert omega == pytest.approx(np.sqrt(7000.0 / 1.25))
    assert zeta == pytest.approx(14.0 / (2 * omega * 1.25))


def test_a_mean_knows_its_way() -> None:
    run = wandering(-120.0, 4.0, np.random.default_rng(1))
    means: list[Mean] = [mean_of(p, FLAT, Sides()) for p in plateaus(run) if isinstance(p, Plateau)]
    assert {m.way for m in means} == {-1.0}


@pytest.mark.slow
@pytest.mark.long
def test_weights_taken_from_the_scatter_itself_make_a_mean_less_certain() -> None:
    """Eight stretches of eight windows at one order: their noise is known to a quarter of itself, so are weights."""
    generator, inside, without = np.random.default_rng(7), [], []
    for _ in range(800):
        rows = []
        for k in range(8):
            noise = generator.standard_normal((2, 8, 1)) * 10.0 ** (0.25 * (k % 4))
            rows.append(Rows(f"stretch {k}", np.ones((8, 1, 1), dtype=complex), 3.0 + noise[0] + 1j * noise[1], 1.0))
        found = solve(rows, [], 1)
        assert found is not None
        each = np.array([np.sum(found.influence[r.stretch] ** 2, axis=0) for r in rows])
        more = float(np.sqrt(_guessed(each / each.sum(), rows)[0]))
        assert 1.02 < more < 1.25
        off = abs(found.coefficients[0] - 3.0)
        inside.append(off <= 1.96 * found.u(0))
        without.append(off <= 1.96 * found.u(0) / more)
    assert 0.93 <= np.mean(inside) <= 0.97
    assert np.mean(without) < np.mean(inside) - 0.01, "the share it is for"
