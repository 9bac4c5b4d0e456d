"""Equations 6 and 7 follow from T, V and D, for either sense of the output and any error; the model is passive.

The equations are taken from the simulator's own residual, not written a second time.
"""

from __future__ import annotations

import numpy as np
import pytest

from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.simulate.steady import Turn, grid_for, residual

sympy = pytest.importorskip("sympy", reason="sympy comes with the dev extra")

SYMBOLS = "N J_m J_l K B_m B_l B_ml B_sp sigma"
NUMBERS = {"N": 50.0, "J_m": 1.1e-3, "J_l": 0.32, "K": 7160.0, "B_m": 5e-4, "B_l": 0.5, "B_ml": 2.5e-3, "B_sp": 3.6}


def energies() -> dict[str, object]:
    """T, V, D of equations 3-5 and what they are functions of."""
    t = sympy.symbols("t")
    p = dict(zip(SYMBOLS.split(), sympy.symbols(SYMBOLS), strict=True))
    theta_m, theta_l = sympy.Function("theta_m")(t), sympy.Function("theta_l")(t)
    error = sympy.Function("e")
    w, v = theta_m.diff(t), theta_l.diff(t)
    phi = theta_l - theta_m / p["N"] + error(theta_m)
    return {
        "t": t, "p": p, "theta_m": theta_m, "theta_l": theta_l, "error": error, "phi": phi,
        "T": (p["J_m"] * w**2 + p["J_l"] * v**2) / 2,
        "V": p["K"] * phi**2 / 2,
        "D": (p["B_m"] * w**2 + p["B_l"] * v**2 + p["B_ml"] * (w + p["sigma"] * v) ** 2 + p["B_sp"] * phi.diff(t) ** 2)
        / 2,
    }  # fmt: skip


def forces() -> tuple[object, object, dict[str, object]]:
    """d/dt ∂T/∂q̇ − ∂T/∂q + ∂V/∂q + ∂D/∂q̇ for both coordinates: equals τ_m and τ_ext."""
    s = energies()
    t, T, V, D = s["t"], s["T"], s["V"], s["D"]

    def lagrange(q: object) -> object:
        rate = q.diff(t)  # type: ignore[attr-defined]
        momentum = T.diff(rate).diff(t)  # type: ignore[attr-defined]
        return sympy.expand(momentum - T.diff(q) + V.diff(q) + D.diff(rate).doit())  # type: ignore[attr-defined]

    return lagrange(s["theta_m"]), lagrange(s["theta_l"]), s


@pytest.mark.slow
def test_the_structure_of_equations_6_and_7_follows_from_the_energies() -> None:
    motor, load, s = forces()
    p, t, phi = s["p"], s["t"], s["phi"]
    theta_m, theta_l = s["theta_m"], s["theta_l"]
    w, v = theta_m.diff(t), theta_l.diff(t)
    lever = (s["error"](theta_m).diff(t) / w) - 1 / p["N"]
    mesh = p["B_ml"] * (w + p["sigma"] * v)
    spring = p["K"] * phi + p["B_sp"] * phi.diff(t)
    six = p["J_m"] * w.diff(t) + spring * lever + p["B_m"] * w + mesh
    seven = p["J_l"] * v.diff(t) + spring + p["B_l"] * v + p["sigma"] * mesh
    assert sympy.simplify((motor - six).doit()) == 0
    assert sympy.simplify((load - seven).doit()) == 0


@pytest.mark.slow
def test_power_in_is_what_is_stored_and_twice_the_rayleigh_function() -> None:
    motor, load, s = forces()
    t, w, v = s["t"], s["theta_m"].diff(s["t"]), s["theta_l"].diff(s["t"])
    balance = (s["T"] + s["V"]).diff(t) + 2 * s["D"] - motor * w - load * v
    assert sympy.simplify(sympy.expand(balance.doit())) == 0


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [1, -1, 0])
def test_the_simulators_residual_is_lagranges_force_on_any_motion(sigma: int) -> None:
    """A made-up periodic motion, no solution: both sides must still agree, term by term, at every point of the turn."""
    series = FourierSeries((1e-4, -2e-4, 3e-5), (5e-5, 1e-4, -8e-5))
    gear = Gear(
        ratio=NUMBERS["N"], kinematic_error=series, sigma=sigma, **{k: v for k, v in NUMBERS.items() if k != "N"}
    )
    grid = grid_for(series, 64)
    x = grid.theta
    turn = Turn(30.0 + 0.7 * np.cos(2 * x) - 0.2 * np.sin(x), 1e-4 * np.sin(2 * x) + 3e-5 * np.cos(3 * x) + 2e-4)
    ours = residual(gear, grid, turn, 0.4, 0.1, 1.0)
    motor, load, s = forces()
    theirs = np.concatenate((evaluated(motor, s, gear, x) - 0.4, evaluated(load, s, gear, x) - 0.1))
    assert np.allclose(ours, theirs, rtol=0, atol=1e-9 * np.max(np.abs(ours)))


def evaluated(force: object, s: dict[str, object], gear: Gear, x: np.ndarray) -> np.ndarray:
    """`force` along the made-up motion, with d/dt = ω_m·d/dθ_m."""
    u = sympy.symbols("u")
    omega = 30 + sympy.Rational(7, 10) * sympy.cos(2 * u) - sympy.Rational(1, 5) * sympy.sin(u)
    phi = sympy.Float(1e-4) * sympy.sin(2 * u) + sympy.Float(3e-5) * sympy.cos(3 * u) + sympy.Float(2e-4)
    c = gear.kinematic_error
    error = sum(
        a * sympy.cos(n * u) + b * sympy.sin(n * u) for n, (a, b) in enumerate(zip(c.a, c.b, strict=True), start=1)
    )
    theta_l = phi + u / sympy.Float(gear.ratio) - error

    def rate(f: object) -> object:
        return omega * f.diff(u)  # type: ignore[attr-defined]

    t, theta_m = s["t"], s["theta_m"]
    steps = [
        (s["theta_l"].diff(t, 2), rate(rate(theta_l))), (theta_m.diff(t, 2), rate(omega)),
        (s["theta_l"].diff(t), rate(theta_l)), (theta_m.diff(t), omega), (s["theta_l"], theta_l),
    ]  # fmt: skip
    e = s["error"]
    plain = force.doit()  # type: ignore[attr-defined]
    plain = plain.replace(
        sympy.Subs, lambda expr, variables, point: expr.subs(dict(zip(variables, point, strict=True)))
    )
    for old, new in steps:
        plain = plain.subs(old, new)
    plain = plain.subs(theta_m, u).replace(e, lambda z: error.subs(u, z)).doit()
    values = {s["p"][k]: v for k, v in {**NUMBERS, "sigma": gear.sigma}.items()}
    return np.broadcast_to(sympy.lambdify(u, plain.subs(values), "numpy")(x), x.shape).astype(float)
