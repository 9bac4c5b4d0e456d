"""jax.vmap over many rigs: fourth-order steps at a steady torque, both sides sliding forward. Answers CPU time."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

jax.config.update("jax_enable_x64", True)


def swept(q: dict[str, Any]) -> Any:
    """A compiled function of (K, J_l, tau_c, y) to y after all ticks, each over the rigs."""
    p, n = {k: float(v) for k, v in q["gear"].items()}, jnp.arange(1, len(q["a"]) + 1)
    a, b = jnp.array(q["a"]), jnp.array(q["b"])

    def rate(y: Any, K: Any, J_l: Any, tau_c: Any) -> Any:
        c, s = jnp.cos(n * y[0]), jnp.sin(n * y[0])
        value, slope = jnp.sum(a * c + b * s), jnp.sum(n * (b * c - a * s))
        lever, phi = slope - 1.0 / p["ratio"], y[2] - y[0] / p["ratio"] + value
        S = K * phi + p["B_sp"] * (y[3] + lever * y[1])
        M = p["B_ml"] * (y[1] + p["sigma"] * y[3])
        level = tau_c + (p["tau_s"] - tau_c) * jnp.exp(-((y[1] / p["omega_s"]) ** 2))
        a_m = (q["tau"] - S * lever - M - p["B_m"] * y[1] - level) / p["J_m"]
        return jnp.stack([y[1], a_m, y[3], (-S - p["sigma"] * M - p["B_l"] * y[3] - p["F_cl"]) / J_l])

    def one(K: Any, J_l: Any, tau_c: Any, y: Any) -> Any:
        h = 1e-3

        def step(y: Any, _: Any) -> tuple[Any, None]:
            k1 = rate(y, K, J_l, tau_c)
            k2 = rate(y + 0.5 * h * k1, K, J_l, tau_c)
            k3 = rate(y + 0.5 * h * k2, K, J_l, tau_c)
            k4 = rate(y + h * k3, K, J_l, tau_c)
            return y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4), None

        return jax.lax.scan(step, y, None, length=q["ticks"])[0]

    return jax.jit(jax.vmap(one))


if __name__ == "__main__":
    question = json.loads(sys.stdin.readline())
    function = swept(question)
    arguments = [jnp.array(question[name]) for name in ("K", "J_l", "tau_c_of", "state")]
    function(*arguments).block_until_ready()
    while True:
        began = time.process_time()
        result = np.asarray(function(*arguments).block_until_ready())
        print(json.dumps({"cpu": time.process_time() - began, "theta": result[:, 0].tolist()}), flush=True)
        if not sys.stdin.readline():
            break
