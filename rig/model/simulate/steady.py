"""The periodic motion at constant torque, by Fourier collocation over the motor angle."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from rig.core.units import RPM, TURN
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.linear import effective_inertia, natural_frequency
from rig.model.simulate.waveform import Array, NoSteadyState, Waveform

POINTS = 160  # a turn: five times the 15 orders of the paper's series both ways; more where the series is longer
PER_ORDER = 10  # points for each order of a longer series
CLOSE = 1e-12  # of the scale of each unknown: where Newton's steps end
NEAR = 1e-6  # the same where steps no longer shrink
MOST_STEPS = 40
HALVINGS = 8  # of a Newton step that would stop the motor or not come closer
FASTEST = 1e5 * RPM  # of a motor, ten times what one on such a gear reaches; beyond, numbers mean nothing
FURTHEST = 1.0  # rad that a load winds the spring up, a hundred times what a gear survives
STAGES = (1.0, 0.3, 0.0)  # extra damping, as a share of critical, where the direct attempt does not converge


class Turn(NamedTuple):
    """The unknowns on the grid: motor speed rad/s and spring deflection rad, both (M,)."""

    omega_m: Array
    phi: Array


@dataclass(frozen=True)
class Grid:
    """One turn in `points` equal steps and the matrix that differentiates on it, exact for orders below points/2."""

    theta: Array
    derivative: Array
    pure: Array  # θ̃_p
    slope: Array  # θ̃_p′


@lru_cache(maxsize=8)
def _derivative(points: int) -> Array:
    k = np.subtract.outer(np.arange(points), np.arange(points))
    with np.errstate(divide="ignore"):
        matrix = 0.5 * (-1.0) ** k / np.tan(np.pi * k / points)
    np.fill_diagonal(matrix, 0.0)
    return np.asarray(matrix)


def grid_for(series: FourierSeries, points: int | None = None) -> Grid:
    """The grid fine enough for `series`."""
    size = points or max(POINTS, PER_ORDER * len(series.a))
    theta: Array = np.arange(size, dtype=np.float64) * (TURN / size)
    return Grid(theta, _derivative(size), series.value(theta), series.slope(theta))


def friction(gear: Gear, omega: Array, way: float) -> tuple[Array, Array]:
    """τ_f while sliding `way` (±1) and dτ_f/dω: [τ_c + (τ_s − τ_c)·exp(−(ω/ω_s)²)]·sgn ω      [armstrong1994]"""
    x = omega / gear.omega_s
    fall = (gear.tau_s - gear.tau_c) * np.exp(-(x**2))
    return way * (gear.tau_c + fall), way * fall * (-2.0 * x / gear.omega_s)


def load_speed(gear: Gear, grid: Grid, turn: Turn) -> Array:
    """ω_l = φ̇ + ω_m·(1/N − θ̃_p′) with φ̇ = ω_m·dφ/dθ_m."""
    return np.asarray(turn.omega_m * (grid.derivative @ turn.phi + 1.0 / gear.ratio - grid.slope))


def residual(gear: Gear, grid: Grid, turn: Turn, tau: float, tau_ext: float, way: float) -> Array:
    """Equations 6 and 7 on the grid, N·m, (2M,); zero in the steady state      [ghorbel2001, Eqs. 6-7]

    Time derivatives are ω_m·d/dθ_m. Coulomb and Stribeck friction, and τ_ext, stand beside the paper's terms.
    """
    w, phi, D = turn.omega_m, turn.phi, grid.derivative
    v, lever = load_speed(gear, grid, turn), 1.0 / gear.ratio - grid.slope
    spring = gear.K * phi + gear.B_sp * w * (D @ phi)
    mesh = gear.B_ml * (w + gear.sigma * v)
    motor = gear.J_m * w * (D @ w) - spring * lever + gear.B_m * w + mesh + friction(gear, w, way)[0] - tau
    load = gear.J_l * w * (D @ v) + spring + gear.B_l * v + gear.sigma * mesh + gear.F_cl * way - tau_ext
    return np.concatenate((motor, load))


def jacobian(gear: Gear, grid: Grid, turn: Turn, way: float) -> Array:
    """Derivatives of `residual` by ω_m and φ, (2M, 2M)."""
    w, phi, D = turn.omega_m, turn.phi, grid.derivative
    lever, bend, one = 1.0 / gear.ratio - grid.slope, D @ phi, np.eye(w.size)
    v = w * (bend + lever)
    v_w, v_phi = np.diag(bend + lever), w[:, None] * D
    spring_w, spring_phi = np.diag(gear.B_sp * bend), gear.K * one + gear.B_sp * w[:, None] * D
    mesh_w, mesh_phi = gear.B_ml * (one + gear.sigma * v_w), gear.B_ml * gear.sigma * v_phi
    own = gear.J_m * (D @ w) + gear.B_m + friction(gear, w, way)[1]
    motor_w = np.diag(own) + gear.J_m * w[:, None] * D - lever[:, None] * spring_w + mesh_w
    motor_phi = -lever[:, None] * spring_phi + mesh_phi
    load_w = np.diag(gear.J_l * (D @ v)) + gear.J_l * w[:, None] * (D @ v_w) + spring_w
    load_w += gear.B_l * v_w + gear.sigma * mesh_w
    load_phi = gear.J_l * w[:, None] * (D @ v_phi) + spring_phi + gear.B_l * v_phi + gear.sigma * mesh_phi
    return np.block([[motor_w, motor_phi], [load_w, load_phi]])


def at_speed(gear: Gear, omega: float, tau_ext: float = 0.0) -> Waveform:
    """The steady state with a mean speed of `omega` rad/s (either sign), and the torque it takes.

    Whether the motion is stable is not asked: below the Stribeck speed friction falls, and no rig stays there. Raises
    NoSteadyState when the motor or the load would stop within the turn.
    """
    return _solve(gear, tau_ext, np.sign(omega), omega, None)


def steady_state(gear: Gear, tau: float, tau_ext: float = 0.0) -> Waveform:
    """The steady state under `tau` N·m at the motor and `tau_ext` N·m on the load, positive driving it forward.

    Where a resonance lets the gear turn at more than one speed, the solution next to the one without kinematic error
    is given. Raises NoSteadyState when friction is more than what drives.
    """
    way, omega = _speed_without_ripple(gear, tau, tau_ext)
    return _solve(gear, tau_ext, way, omega, tau)


def torque_for(gear: Gear, omega: float, tau_ext: float = 0.0) -> float:
    """Constant motor torque [N·m] under which the mean speed is `omega` rad/s. Raises NoSteadyState."""
    return at_speed(gear, omega, tau_ext).tau


def drag(gear: Gear, omega: float, tau_ext: float = 0.0) -> float:
    """Motor torque [N·m] that keeps `omega` rad/s of a gear without kinematic error."""
    way, N = float(np.sign(omega)), gear.ratio
    return float(friction(gear, np.array(omega), way)[0] + gear.viscous * omega + (gear.F_cl * way - tau_ext) / N)


def _speed_without_ripple(gear: Gear, tau: float, tau_ext: float) -> tuple[float, float]:
    """Direction, and the speed at which drag equals the torque on the rising branch of friction."""
    refuse_load(gear, tau_ext)
    way = float(np.sign(tau + tau_ext / gear.ratio)) or 1.0
    viscous = gear.viscous
    left = way * (tau + tau_ext / gear.ratio) - gear.tau_c - gear.F_cl / gear.ratio
    if left <= 0.0 or viscous <= 0.0:
        raise NoSteadyState(
            f"{tau:.4g} N·m at the motor do not keep the gear turning: Coulomb friction alone takes "
            f"{gear.tau_c + gear.F_cl / gear.ratio - way * tau_ext / gear.ratio:.4g} N·m"
            if left <= 0.0
            else "without viscous drag the speed under a constant torque grows without end"
        )
    omega = left / viscous
    _refuse_speed(omega)
    for _ in range(MOST_STEPS):  # Newton from the fast side: the rising branch
        error = drag(gear, way * omega, tau_ext) - tau
        slope = viscous + float(friction(gear, np.array(omega), 1.0)[1])
        if slope <= 0.0 or omega <= 0.0:
            raise NoSteadyState(f"{tau:.4g} N·m at the motor hold the gear only where friction falls with speed")
        step = way * error / slope
        omega -= step
        if abs(step) < CLOSE * omega:
            break
    return way, way * omega


def refuse_load(gear: Gear, tau_ext: float) -> None:
    """Raises NoSteadyState for a load that winds the gear up beyond any gear."""
    if abs(tau_ext) > FURTHEST * gear.K:
        raise NoSteadyState(
            f"a load of {tau_ext:g} N·m winds the gear up by {abs(tau_ext) / gear.K:.3g} rad, its stiffness is "
            f"{gear.K:.4g} N·m/rad; expected up to {FURTHEST * gear.K:.4g} N·m, which is {FURTHEST:g} rad"
        )


def _refuse_speed(omega: float) -> None:
    if abs(omega) > FASTEST:
        raise NoSteadyState(
            f"the motor would turn at {abs(omega) / RPM:.3g} rpm; expected up to {FASTEST / RPM:g} rpm, more than any "
            "such gear reaches"
        )


def _solve(gear: Gear, tau_ext: float, way: float, omega: float, tau: float | None) -> Waveform:
    if not (np.isfinite(omega) and omega != 0.0):
        raise NoSteadyState(f"a mean speed of {omega:g} rad/s is no turning gear")
    refuse_load(gear, tau_ext)
    _refuse_speed(omega)
    grid = grid_for(gear.kinematic_error)
    first = _linear(gear, grid, omega, tau_ext, way)
    torque = drag(gear, omega, tau_ext) if tau is None else tau
    try:
        turn, torque = _newton(gear, grid, first, torque, tau_ext, way, None if tau is not None else omega)
    except NoSteadyState:  # next to a resonance the linear solution is far off: come from a heavily damped gear
        turn = first
        critical = 2.0 * natural_frequency(gear) * effective_inertia(gear)
        for share in STAGES:
            damped = replace(gear, B_sp=gear.B_sp + share * critical)
            turn, torque = _newton(damped, grid, turn, torque, tau_ext, way, None if tau is not None else omega)
    return _waveform(gear, grid, turn, torque, tau_ext)


def _linear(gear: Gear, grid: Grid, omega: float, tau_ext: float, way: float) -> Turn:
    """The answer of the linear mode to the kinematic error at constant speed: where Newton begins."""
    size = grid.theta.size
    r = np.arange(size // 2 + 1) * abs(omega) / natural_frequency(gear)
    zeta = gear.B_sp / (2.0 * natural_frequency(gear) * effective_inertia(gear))
    phi = np.fft.rfft(grid.pure) * -(r**2) / (1.0 - r**2 + 2j * way * max(zeta, 0.02) * r)
    load = gear.B_l * omega / gear.ratio + gear.F_cl * way - tau_ext
    phi[0] = -size * (load + gear.sigma * gear.B_ml * omega) / gear.K
    deflection = np.fft.irfft(phi, size)
    share = gear.J_l / (gear.J_l + gear.ratio**2 * gear.J_m)  # of the bending, by the motor
    swing = deflection - deflection.mean() - grid.pure + grid.pure.mean()
    speed = omega * (1.0 - share * gear.ratio * (grid.derivative @ swing))
    return Turn(speed if np.all(way * speed > 0.0) else np.full(size, omega), deflection)


def _newton(
    gear: Gear, grid: Grid, turn: Turn, tau: float, tau_ext: float, way: float, omega: float | None
) -> tuple[Turn, float]:
    """Newton's method; with `omega` given, τ is an unknown and the mean of 1/ω_m one more equation."""
    size = grid.theta.size
    left = np.inf
    scale = np.concatenate((np.full(size, np.abs(turn.omega_m).mean()), np.full(size, 1e-4), [max(abs(tau), 0.1)]))
    for _ in range(MOST_STEPS):
        off, matrix = _system(gear, grid, turn, tau, tau_ext, way, omega)
        step = np.linalg.solve(matrix, off)
        length = 1.0
        for _ in range(HALVINGS):
            trial = Turn(turn.omega_m - length * step[:size], turn.phi - length * step[size : 2 * size])
            if np.all(way * trial.omega_m > 0.0):
                break
            length /= 2
        else:
            raise NoSteadyState("the motor would come to rest within the turn: it does not turn steadily")
        turn, tau = trial, tau - length * float(step[-1]) if omega is not None else tau
        last, left = left, float(np.max(np.abs(step) / scale[: step.size]))
        if left < CLOSE or (left < NEAR and left > 0.3 * last):  # rounding has ended the quadratic convergence
            return turn, tau
    raise NoSteadyState("no steady turning was found: too close to a resonance, or to standstill")


def _system(
    gear: Gear, grid: Grid, turn: Turn, tau: float, tau_ext: float, way: float, omega: float | None
) -> tuple[Array, Array]:
    off = residual(gear, grid, turn, tau, tau_ext, way)
    matrix = jacobian(gear, grid, turn, way)
    if omega is None:
        return off, matrix
    size = grid.theta.size
    bordered = np.zeros((2 * size + 1, 2 * size + 1))
    bordered[:-1, :-1] = matrix
    bordered[:size, -1] = -1.0
    bordered[-1, :size] = -1.0 / (size * turn.omega_m**2)
    mean = float(np.mean(1.0 / turn.omega_m)) - 1.0 / omega
    return np.concatenate((off, [mean])), bordered


def _waveform(gear: Gear, grid: Grid, turn: Turn, tau: float, tau_ext: float) -> Waveform:
    v, w = load_speed(gear, grid, turn), turn.omega_m
    if np.any(v * w <= 0.0):
        raise NoSteadyState("the load would come to rest within the turn: the gear swings more than it turns")
    spring = gear.K * turn.phi + gear.B_sp * w * (grid.derivative @ turn.phi)
    shaft = -spring - gear.sigma * gear.B_ml * (w + gear.sigma * v)
    return Waveform(
        theta_m=grid.theta, omega_m=w, omega_l=v, pure=grid.pure, flexible=-turn.phi,
        spring_torque=-gear.K * turn.phi, shaft_torque=shaft,
        tau=tau, tau_ext=tau_ext, mean_speed=float(1.0 / np.mean(1.0 / w)),
    )  # fmt: skip
