"""Library solvers on the twin's plant while both sides slide forward, restarted at every tick as the loop does."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import numpy as np

TICK = 1e-3  # s


class Plant:
    """Numbers of the question, and the position loop."""

    def __init__(self, q: dict[str, Any]) -> None:
        self.p = {k: float(v) for k, v in q["gear"].items()}
        self.a, self.b = np.array(q["a"]), np.array(q["b"])
        self.n = np.arange(1, self.a.size + 1)
        self.speed, self.ticks, self.gains = q["speed"], q["ticks"], q["gains"]
        self.y = np.array(q["start"])

    def rate(self, xp: Any, t: Any, y: Any, tau: Any, lag: Any) -> list[Any]:
        """Equations 6-7 with Stribeck and Coulomb friction; `xp` is numpy or jax.numpy."""
        p, angle = self.p, self.n * y[0]
        c, s = xp.cos(angle), xp.sin(angle)
        value, slope = xp.sum(self.a * c + self.b * s), xp.sum(self.n * (self.b * c - self.a * s))
        lever, phi = slope - 1.0 / p["ratio"], y[2] - y[0] / p["ratio"] + value
        S = p["K"] * phi + p["B_sp"] * (y[3] + lever * y[1])
        M = p["B_ml"] * (y[1] + p["sigma"] * y[3])
        level = p["tau_c"] + (p["tau_s"] - p["tau_c"]) * xp.exp(-((y[1] / p["omega_s"]) ** 2))
        drive = tau + lag * xp.exp(-t / p["T_drive"])
        a_m = (drive - S * lever - M - p["B_m"] * y[1] - level) / p["J_m"]
        a_l = (-S - p["sigma"] * M - p["B_l"] * y[3] - p["F_cl"]) / p["J_l"]
        return [y[1], a_m, y[3], a_l]

    def loop(self, k: Any, y: Any, integral: Any) -> tuple[Any, Any]:
        """Torque of tick `k` and the integral after it."""
        e = self.y[0] + self.speed * TICK * k - y[0]
        integral = integral + self.gains["Ki"] * e * TICK
        return self.gains["Kp"] * e + integral + self.gains["Kd"] * (self.speed - y[1]) + self.gains[
            "ff"
        ] * self.speed, integral


def sundials(plant: Plant, tolerance: float) -> tuple[np.ndarray, float]:
    """scikit-sundae's CVODE with a right-hand side in Python: θ_m/N − θ_l at every tick, and CPU time [s]."""
    from sksundae.cvode import CVODE

    torque = [0.0, 0.0]

    def rhs(t: float, y: np.ndarray, out: np.ndarray) -> None:
        out[:] = plant.rate(np, t, y, *torque)

    solver = CVODE(rhs, rtol=tolerance, atol=tolerance * 1e-2, method="Adams")
    y, integral, applied, found = plant.y.copy(), 0.0, 0.0, np.empty(plant.ticks)
    keep, began = float(np.exp(-TICK / plant.p["T_drive"])), time.process_time()
    for k in range(plant.ticks):
        torque[0], integral = plant.loop(k, y, integral)
        torque[1] = applied - torque[0]
        y = solver.solve(np.array([0.0, TICK]), y).y[-1]
        applied = torque[0] + torque[1] * keep
        found[k] = y[0] / plant.p["ratio"] - y[2]
    return found, time.process_time() - began


def jaxed(plant: Plant, tolerance: float) -> tuple[np.ndarray, float]:
    """diffrax's Dopri8, adaptive, compiled with the loop around it; the second of two calls counts."""
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    control = diffrax.PIDController(rtol=tolerance, atol=tolerance * 1e-2)
    term = diffrax.ODETerm(lambda t, y, args: jnp.stack(plant.rate(jnp, t, y, *args)))
    keep = float(np.exp(-TICK / plant.p["T_drive"]))

    def tick(state: Any, k: Any) -> tuple[Any, Any]:
        y, integral, applied = state
        tau, integral = plant.loop(k, y, integral)
        lag = applied - tau
        end = diffrax.diffeqsolve(
            term, diffrax.Dopri8(), 0.0, TICK, TICK, y, args=(tau, lag), stepsize_controller=control, max_steps=64
        ).ys[-1]
        return (end, integral, tau + lag * keep), end[0] / plant.p["ratio"] - end[2]

    @jax.jit
    def whole(y: Any) -> Any:
        return jax.lax.scan(tick, (y, 0.0, 0.0), jnp.arange(plant.ticks, dtype=jnp.float64))[1]

    whole(jnp.array(plant.y)).block_until_ready()
    began = time.process_time()
    found = np.asarray(whole(jnp.array(plant.y)).block_until_ready())
    return found, time.process_time() - began


SOLVERS = {"scikit-sundae": sundials, "diffrax": jaxed}


if __name__ == "__main__":
    for line in sys.stdin:
        question = json.loads(line)
        result, cpu = SOLVERS[question["solver"]](Plant(question), question["tolerance"])
        print(json.dumps({"cpu": cpu, "error": result.tolist()}), flush=True)
