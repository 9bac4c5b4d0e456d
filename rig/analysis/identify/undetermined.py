"""What the runs leave open: which parameters they do not determine, and the sums of them that they do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.identify.fit import Fits
from rig.analysis.identify.means import Mean
from rig.analysis.motion.declared import declared
from rig.core.units import RPM
from rig.model.gearfile import MeasuredSeries, Parameter

WANTED = ("J_m", "J_l", "K", "B_sp", "B_m", "B_l", "tau_c", "F_cl")
"""What makes an identification complete. B_ml is never measured, tau_s and omega_s only where friction falls."""

SERIES = "θ̃_p"
TAKES = "four stretches at two speeds or more, one twice the other, in both directions (hdrig run friction)"
NO_MOTOR_SUM = f"tau_c, B_m and B_ml: they take {TAKES}, drive's torque and torque sensor."
NO_LOAD_SUM = f"F_cl and B_l: they take {TAKES}, with the torque sensor."
NOTHING = "not determined by these runs, nor declared: the gear file has 0 for it"
"""The note of a number that nobody knows."""


@dataclass(frozen=True)
class Balance:
    """Mean of Coulomb friction and drag over the runs' stretches of constant speed, as if at one speed, SI."""

    torque: float  # N·m, sign of the speed taken off
    omega: float  # rad/s of the motor


def undetermined(parameters: Mapping[str, Parameter], series: MeasuredSeries) -> tuple[str, ...]:
    """Names of WANTED, and θ̃_p, that no run here measured."""
    open_ = [name for name in WANTED if name not in parameters or parameters[name].origin != "measured"]
    return (*open_, *([SERIES] if series.origin != "measured" else []))


def said_open(names: Sequence[str], parameters: Mapping[str, Parameter]) -> str:
    """One sentence: what is not determined, and what stands in its place."""
    stands = [
        f"{', '.join(some)} {origin}"
        for origin in ("declared", "assumed")
        if (some := [n for n in names if n in parameters and parameters[n].origin == origin])
    ]
    where = f"; what stands in their place: {'; '.join(stands)}" if stands else ""
    return f"Not determined by these runs: {', '.join(names)}{where}."


def stand_in(found: dict[str, Parameter], fits: Fits, said: Mapping[str, object], sigma: int) -> list[str]:
    """Numbers for what `found` lacks: declared, else what a balance of the measured torque leaves, else 0.

    None of them is measured. Returns what cannot be told apart, one sentence each.
    """
    for name in ("J_m", "J_l", "K", "B_sp", "B_m", "B_ml", "B_l"):
        if name not in found and (value := declared(said, name)) is not None:
            found[name] = Parameter(value, origin="declared", note="not determined by these runs")
    for name in ("B_sp", "B_m", "B_l", "B_ml"):
        if name not in found:
            found[name] = Parameter(0.0, origin="assumed", note=NOTHING)
    motor = _balance(fits.means, [m.way * m.motor for m in fits.means])
    load = _balance(fits.means, [m.way * m.load for m in fits.means])
    return [
        *_friction(found, "tau_c", motor, NO_MOTOR_SUM, lambda b: _motor_sum(found, b, fits.ratio, sigma)),
        *_friction(found, "F_cl", load, NO_LOAD_SUM, lambda b: _load_sum(found, b, fits)),
    ]


def _friction(
    found: dict[str, Parameter], name: str, balance: Balance | None, nothing: str, known: Callable[[Balance], str]
) -> list[str]:
    """`name` where at most its sum with the drag is `known`; `nothing` is said where not even that is."""
    if name in found:
        return []
    if balance is None:
        found[name] = Parameter(0.0, origin="assumed", note=NOTHING)
        return [nothing]
    return [known(balance)]


def _motor_sum(found: dict[str, Parameter], balance: Balance, ratio: float, sigma: int) -> str:
    """tau_c is what the drag leaves of the sum."""
    drag = (found["B_m"].value + found["B_ml"].value * (1.0 + sigma / ratio) ** 2) * balance.omega
    at = f"{balance.torque:.4f} N·m at {balance.omega / RPM:.0f} rpm"
    found["tau_c"] = _left(balance.torque - drag, f"{_stands(found, 'B_m')} and {_stands(found, 'B_ml')}", at)
    return (
        f"tau_c, B_m and B_ml: only their sum is known, tau_c + [B_m + B_ml·(1 + σ/N)²]·ω_m = {at}; to tell them "
        f"apart takes {TAKES}."
    )


def _load_sum(found: dict[str, Parameter], balance: Balance, fits: Fits) -> str:
    """F_cl is what the drag leaves of the sum."""
    omega = balance.omega / fits.ratio
    at = f"{balance.torque:.4f} N·m at {omega / RPM:.2f} rpm of the output"
    found["F_cl"] = _left(balance.torque - found["B_l"].value * omega, _stands(found, "B_l"), at)
    if len({m.way for m in fits.means if m.tau_ext == 0.0}) == 2:
        what, total = "F_cl and B_l", "F_cl + B_l·ω_l"
    else:
        what, total = "F_cl, B_l and the zero of the torque sensor", "F_cl + B_l·ω_l + zero"
    return f"{what}: only their sum is known, {total} = {at}; to tell them apart takes {TAKES}."


def _balance(means: Sequence[Mean], friction: Sequence[float]) -> Balance | None:
    """The unloaded stretches that have the torque, weighted by how long they lasted; None without any."""
    kept = [(m, f) for m, f in zip(means, friction, strict=True) if m.tau_ext == 0.0 and np.isfinite(f)]
    if not kept:
        return None
    weights = [m.duration for m, _ in kept]
    torque = float(np.average([f for _, f in kept], weights=weights))
    return Balance(torque, float(np.average([abs(m.omega) for m, _ in kept], weights=weights)))


def _stands(found: Mapping[str, Parameter], name: str) -> str:
    """A parameter by where it comes from: "declared B_l"."""
    return f"{found[name].origin} {name}"


def _left(rest: float, taken: str, total: str) -> Parameter:
    """`rest` N·m, what the drag `taken` leaves of the measured sum `total`; assumed, because the drag is."""
    if rest <= 0.0:
        return Parameter(0.0, origin="assumed", note=f"{taken} take more than the measured {total}")
    return Parameter(rest, origin="assumed", note=f"the measured {total} less {taken}")
