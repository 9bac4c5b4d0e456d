"""Progress in words, with units."""

from __future__ import annotations

from typing import Any

from rig.report.numbers import counted


def peak(event: dict[str, Any]) -> str:
    """Peak to peak over the last whole motor turn."""
    value = event.get("peak_to_peak_arcsec")
    return "p-p –" if value is None else f"p-p {value:.1f} arcsec"


def late(event: dict[str, Any]) -> str:
    """How late the loop wakes."""
    missed = f"{counted(event.get('missed') or 0, 'cycle')} missed"
    if event.get("lateness_p50_us") is None:
        return f"virtual clock, {missed}"
    return f"late p50 {event['lateness_p50_us']} µs, p99 {event['lateness_p99_us']} µs, {missed}"


def wired_twin(bench: str) -> str:
    """Of a bench with real drivers whose devices say that they are the twin's."""
    return f"SIMULATED: the devices of bench '{bench}' say that they are the twin's, over the wire"
