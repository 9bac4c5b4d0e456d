"""The plant of the blind test: its books balance, its friction sticks, its resonance is where the formula says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.blind import campaign, integrate, plans
from tests.blind import rig as rigs
from tests.blind.builder import Builder
from tests.blind.forms import form_of
from tests.blind.kernel import COUPLING, SENSOR_SHAFT, STATE_SIZE, TH, TL, VX, W_DISS, W_IN, WL, W, X
from tests.blind.sensors import Columns, Context, draw_noise
from tests.blind.strength import shape_rng

FREE = {"T_c": 0.0, "T_l": 0.0}
CONSERVING = {**FREE, "B_m": 0.0, "B_l": 0.0, "B_ml": 0.0, "B_sp": 0.0}


def rig(**changes: float) -> rigs.Rig:
    return replace(rigs.draw(np.random.default_rng(4), 16.0, 22.0), **changes)


def stepped(
    builder: Builder, seconds: float, dt: float, tau: float, start: dict[int, float], load: float = 0.0
) -> np.ndarray:
    """State after `seconds` of constant torque, no controller and no noise."""
    par, (tab, data) = builder.par(False), builder.tab()
    state = np.zeros(STATE_SIZE)
    for place, value in start.items():
        state[place] = value
    for _ in range(round(seconds / dt)):
        integrate.step(state, par, tab, data, tau, load, 0.0, 0.0, 1.0, 1.0, 0.0, dt)
    return state


def kinetic(state: np.ndarray, builder: Builder) -> float:
    par = builder.par(False)
    extra = 0.5 * par.J_x * state[VX] ** 2 if par.extra else 0.0
    return 0.5 * par.J_m * state[W] ** 2 + 0.5 * par.J_l * state[WL] ** 2 + extra


def spring_energy(state: np.ndarray, builder: Builder) -> float:
    """Energy of the gear's spring, with the stiffness modulation of the motor angle, and of the extra body's."""
    par = builder.par(False)
    a = state[X] if par.extra == COUPLING else state[TH]
    b = state[X] if par.extra == SENSOR_SHAFT else state[TL]
    turn = a % (2 * np.pi)
    phi = b - a / builder.rig.N + np.interp(turn, ANGLES, builder.pure_error(), period=2 * np.pi)
    modulation = builder.tables.get("stiff_m", np.zeros_like(ANGLES))
    k = 1 + np.interp(turn, ANGLES, modulation, period=2 * np.pi)
    twist = state[TH] - state[X] if par.extra == COUPLING else state[X] - state[TL]
    return 0.5 * builder.rig.K * k * phi**2 + 0.5 * par.k_x * twist**2


ANGLES = np.arange(8192) * 2 * np.pi / 8192


@pytest.mark.slow
@pytest.mark.parametrize(
    "effect", ["none", "angle_dependent_stiffness", "position_dependent_friction", "quadratic_drag"]
)
def test_stored_energy_is_what_went_in_less_what_was_rubbed_away(effect: str) -> None:
    builder = Builder(rig())
    if effect != "none":
        form_of(effect, {"quadratic_drag": "square"}.get(effect, "order_two")).build(builder, shape_rng(3, 0), 3.0)
    start = {W: 20.0, WL: 0.4, TL: -builder.pure_error()[0] + 0.001}
    before = np.zeros(STATE_SIZE)
    for place, value in start.items():
        before[place] = value
    after = stepped(builder, 3.0, 1e-4, 0.35, start)
    gained = kinetic(after, builder) + spring_energy(after, builder)
    gained -= kinetic(before, builder) + spring_energy(before, builder)
    assert after[W_DISS] > 1.0
    assert gained == pytest.approx(after[W_IN] - after[W_DISS], abs=2e-4 * after[W_IN])


@pytest.mark.slow
def test_nothing_is_lost_without_friction() -> None:
    builder = Builder(rig(**CONSERVING))
    start = {W: 10.0, WL: 0.2, TL: 0.002}
    energies = [
        kinetic(s, builder) + spring_energy(s, builder)
        for s in (stepped(builder, t, 1e-4, 0.0, start) for t in (0.0, 5.0))
    ]
    assert energies[1] == pytest.approx(energies[0], rel=1e-5)


@pytest.mark.slow
def test_halving_the_step_moves_the_kinematic_error_by_less_than_a_third_of_a_count() -> None:
    builder = Builder(rig())
    coarse, fine = (stepped(builder, 2.0, dt, 0.3, {W: 15.0, WL: 0.3}) for dt in (1e-4, 5e-5))
    error = [state[TH] / builder.rig.N - state[TL] for state in (coarse, fine)]
    assert abs(error[0] - error[1]) < 4.8e-6 / 3


@pytest.mark.slow
def test_a_motor_below_breakaway_does_not_creep() -> None:
    builder = Builder(rig())
    after = stepped(builder, 2.0, 2e-4, 0.9 * builder.rig.T_c, {TL: -builder.pure_error()[0]})
    assert abs(after[TH]) < 1e-9


@pytest.mark.slow
def test_the_gear_rings_at_its_free_free_frequency() -> None:
    flat = tuple(0.0 for _ in range(15))
    own = rig(**CONSERVING, ke_cos=flat, ke_sin=flat)
    builder, dt = Builder(own), 1e-4
    par, (tab, data) = builder.par(False), builder.tab()
    state = np.zeros(STATE_SIZE)
    state[TL] = 0.002
    wind_up = []
    for _ in range(20000):
        integrate.step(state, par, tab, data, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, dt)
        wind_up.append(state[TL] - state[TH] / own.N)
    turns = np.flatnonzero(np.diff(np.sign(wind_up)) > 0)
    assert 1 / (np.mean(np.diff(turns)) * dt) == pytest.approx(own.resonance_hz(), rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("form", ["disc", "coupling", "sensor_shaft"])
def test_the_books_balance_with_an_extra_body(form: str) -> None:
    builder = Builder(rig(**FREE))
    form_of("torsional_mode", form).build(builder, shape_rng(3, 0), 1.0)
    start = {W: 10.0, WL: 0.2, VX: 10.0 if form == "coupling" else 0.2}
    before, after = (stepped(builder, seconds, 1e-4, 0.0, start) for seconds in (0.0, 1.0))
    stored = [kinetic(s, builder) + spring_energy(s, builder) for s in (before, after)]
    assert after[W_DISS] > 0.5 * stored[0]
    assert stored[1] == pytest.approx(stored[0] - after[W_DISS], abs=1e-3 * stored[0])


@pytest.mark.slow
def test_the_torque_is_recorded_at_the_instant_of_the_angles() -> None:
    """With the torque half a step old, the damping found from the record would be off by K times the delay."""
    on, captured = rig(), {}
    quiet = replace(draw_noise(np.random.default_rng(1)), friction_m=0.0, friction_l=0.0)
    machine = campaign.assembled(Builder(on), quiet)

    def capture(columns: Columns, where: Context) -> None:
        captured.update({name: column.copy() for name, column in columns.items()})

    machine.builder.sensors.changes.append(capture)
    campaign.simulate_run(replace(plans.steady(300, "1"), duration_s=4.0), machine, [1, 1])
    angle, order = captured["theta_m"], np.arange(1, 16)
    p = np.cos(np.outer(angle, order)) @ np.array(on.ke_cos) + np.sin(np.outer(angle, order)) @ np.array(on.ke_sin)
    phi = captured["theta_l"] - angle / on.N + p
    columns = np.column_stack([-phi, -np.gradient(phi, 1e-3)])
    K, B_sp = np.linalg.lstsq(columns[5:-5], captured["tau_l"][5:-5], rcond=None)[0]
    assert pytest.approx(on.K, rel=1e-3) == K
    assert abs(B_sp - on.B_sp) / on.K < 1e-5
