"""The compiled functions Python calls, cached on disk under a key that holds the text of the whole package."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba import njit

from sim.kernel.gear import kinematic_error as error_at
from sim.kernel.layout import Error, Slow, Vector
from sim.kernel.passing import Passed, passing, substeps


def text_of_the_package(folder: Path = Path(__file__).parent) -> int:
    """A number that changes with any character of any file of this package."""
    text = b"".join(file.read_bytes() for file in sorted(folder.glob("*.py")))
    return int.from_bytes(hashlib.sha256(text).digest()[:7])  # fits into 64 bits


def entries(text: int) -> tuple[Callable[..., Any], ...]:
    """`advance`, `advance_full`, `kinematic_error`; `text` is in their closures, those are part of numba's key."""

    @njit(cache=True)
    def advance(
        state: Vector, p: Vector, dt: float, tau: float, tau_ext: float, locked: bool, xi_m: float, xi_l: float
    ) -> Passed:
        """Let `dt` s pass with `tau` N·m commanded and `tau_ext` N·m on the load; friction wanders once, before it.

        Gives (status, (θ_m, ω_m, ω̇_m), (θ_l, ω_l, ω̇_l), (τ_m, τ_l, τ̇_l, low-passed τ_l)); `state` follows unless it
        failed.
        """
        _ = text
        return substeps(state, None, p, dt, tau, tau_ext, locked, (xi_m, xi_l))

    @njit(cache=True)
    def advance_full(
        state: Vector, p: Vector, dt: float, tau: float, tau_ext: float, locked: bool, xi_m: float, xi_l: float
    ) -> Passed:
        """The same for a rig that has more than the paper's model."""
        _ = text
        return passing(state, p, dt, tau, tau_ext, locked, xi_m, xi_l)

    @njit(cache=True)
    def kinematic_error(theta: float, load: float, p: Vector) -> Error:
        """θ̃_p [rad], dθ̃_p/dθ_m, dθ̃_p/dT̄ at `theta` rad and T̄ = `load` N·m, nothing left out."""
        _ = text
        return error_at(theta, Slow(load, 0.0, 0.0), p)

    return advance, advance_full, kinematic_error
