"""Measured beside simulated: the curves, and the words that say what the model is."""

from __future__ import annotations

from enum import StrEnum

from rig.analysis.findings.result import Array
from rig.analysis.orders.wave import wave
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Number
from rig.analysis.reproduction.shaft import Complex
from rig.analysis.reproduction.split import THETA_DEG, Split, share

MOST = 90.0  # % of the mean square: nine tenths, an rms of a third left


class Shown(StrEnum):
    """Which of the three curves of Equation 2."""

    TOTAL = "total"
    FLEXIBLE = "flexible"


def drawn(measured: Complex, model: Complex | None = None) -> dict[str, Array]:
    """Curves of a turn: what was measured, the model, and what is left of the first."""
    curves = {"turn.theta_deg": THETA_DEG, "turn.measured": wave(measured)}
    if model is not None:
        curves |= {"turn.model": wave(model), "turn.left": wave(measured - model)}
    return curves


def compared(split: Split, shown: Shown) -> dict[str, Array]:
    """θ̃ or θ̃_s of a run at speed beside the model's; θ̃_p with the first."""
    parts, total, pure = split.decomposition, split.simulated, split.simulated_pure
    if shown is Shown.FLEXIBLE:
        return drawn(parts.flexible, None if total is None or pure is None else total - pure)
    return drawn(parts.total, total) | {"turn.pure": wave(parts.pure)}


def model_words(campaign: Campaign, split: Split) -> str:
    """Where the model comes from and what torque it needs."""
    model = campaign.model
    if model is None:
        return f"No model: {campaign.no_model}."
    if split.simulated is None:
        return "The identified gear does not turn steadily at this speed."
    held = "this run is none of them" if model.held_out else "this run is one of them"
    torque = f"it takes {split.torque:.4f} N·m, the run {split.reading.torque:.4f} N·m"
    return (
        f"Model: equations 6 and 7 at constant torque, gear identified from {len(model.runs)} runs, {held}; {torque}."
    )


def explains(left: Complex, split: Split) -> Number:
    """Percent of the mean square of θ̃ − θ̃_p that is not in `left`."""
    parts = split.decomposition
    off = share(left, parts.flexible, parts.u, parts.factor)
    value, low, high = (100.0 * (1.0 - x**2) for x in (off.value, off.high, off.low))
    return Number(value, low, high, "%")
