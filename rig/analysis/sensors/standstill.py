"""A run at rest: what every channel says when nothing moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array, Check
from rig.analysis.motion.declared import declared
from rig.analysis.motion.source import Motion, Source
from rig.analysis.orders.lines import Line, find_lines
from rig.core.units import ARCSEC, TURN

PIECES = 100  # the run is looked at in this many pieces to see when it had settled
OUTLIER = 5.0  # σ of the settled pieces
STILL = 0.01  # turns of the motor: more is not a standstill
MOST_LINES = 5  # per channel
TEN = 10.0  # periods in the run: slower is drift, not a line
SETTLES = 2.0  # s: a loop that lets go, and what swings after it, takes less
CHANGED = 10.0  # times the noise of a channel, or its step: less is its drift
SHAKES = 0.3  # of a channel's variance in one line: below, it is a peak in the noise
CHANNELS = (
    ("theta_m", "Motor angle", "arcsec", 1 / ARCSEC),
    ("theta_l", "Load angle", "arcsec", 1 / ARCSEC),
    ("tau_m", "Motor torque", "N·m", 1.0),
    ("tau_l", "Shaft torque", "N·m", 1.0),
)


@dataclass(frozen=True)
class Floor:
    """Noise of one channel at rest, in the unit it is shown in."""

    mean: float
    u_mean: float  # half width of its 95 % interval
    rms: float  # about the line of its drift
    u_rms: float
    drift: float  # per minute; NaN without time
    u_drift: float


def settled_from(columns: list[Array]) -> int:
    """The first row from which all `columns` (each (n,)) behave as in their second half.

    A piece is unsettled when its mean or its scatter stands OUTLIER σ out of the pieces of the second half; the run has
    settled after the unsettled pieces that it began with. At most half of it is given up.
    """
    n = columns[0].size
    size = max(n // PIECES, 1)
    pieces = n // size
    if pieces < 8:
        return 0
    worst = 0
    for x in columns:
        steps = np.abs(np.diff(x))
        count = float(np.min(steps, where=steps > 0, initial=np.inf))  # one step of the channel: a count, a bit
        count = count if np.isfinite(count) else 1.0
        block = x[: pieces * size].reshape(pieces, size)
        # a channel that mostly rests on one count and at times takes the next has not moved
        least = count / 2 if np.median(block.std(axis=1)) < count / 4 else 0.0
        for what in (block.mean(axis=1), block.std(axis=1)):
            late = what[pieces // 2 :]
            usual = float(np.median(late))
            spread = max(1.4826 * float(np.median(np.abs(late - usual))), float(np.std(late)) / 2, least)
            out = np.abs(what[: pieces // 2] - usual) > OUTLIER * spread
            quiet = np.flatnonzero(~out & ~np.append(out[1:], False))  # two pieces in a row must be quiet
            worst = max(worst, int(quiet[0]) if quiet.size else pieces // 2)
    return worst * size


def floor_of(x: Array, t: Array | None, count: float = 0.0) -> Floor:
    """Mean, drift and rms about it; intervals from twenty pieces, since neighbouring rows need not be independent.

    `count` is one step of the channel, in the unit of `x`. Where the noise is smaller than it, rounding does not
    average out: a line through values each wrong by up to half a count can be wrong by 1.5 counts over its length.
    """
    minutes = np.arange(x.size) / x.size if t is None else (t - t[0]) / 60.0
    pieces = 20 if x.size >= 200 else 4
    size = x.size // pieces
    centred = minutes - minutes.mean()
    slope = float(centred @ (x - x.mean())) / max(float(centred @ centred), 1e-300)
    rest = x - x.mean() - slope * centred
    means = rest[: pieces * size].reshape(pieces, size).mean(axis=1)
    squares = (rest[: pieces * size].reshape(pieces, size) ** 2).mean(axis=1)
    factor = t95(pieces - 2)
    rms = float(np.sqrt(np.mean(rest**2)))
    u_mean = factor * float(means.std(ddof=2)) / np.sqrt(pieces)
    u_rms = factor * float(squares.std(ddof=1)) / np.sqrt(pieces) / (2.0 * rms) if rms > 0 else 0.0
    u_drift = u_mean * np.sqrt(12.0) / max(float(minutes[-1] - minutes[0]), 1e-300)
    reach = 1.5 if rms < count else 0.5
    u_drift += reach * count / max(float(minutes[-1] - minutes[0]), 1e-300)
    if t is None:
        slope = u_drift = float("nan")
    return Floor(float(x.mean()), u_mean, rms, u_rms, slope, u_drift)


def _add_channel(
    found: Findings, named: tuple[str, str, str], x: Array, t: Array | None, count: float, since: str
) -> tuple[float, list[dict[str, float | str]]]:
    """Figures of one channel, (key, label, unit) `named`; its rms and the lines at fixed frequency in it."""
    name, label, unit = named
    f = floor_of(x - x[0], t, count)
    how = f"rms about the line of its drift, {since}; interval from the scatter of twenty pieces."
    if f.rms == 0.0:
        how = f"It never left one count ({since}): its noise is below the resolution."
    found.figure(f"noise_{name}", f"{label}, noise at rest", f.rms, unit, f.u_rms, how)
    if name.startswith("tau"):
        how = f"Mean at rest, {since}: zero of the sensor and what friction still holds."
        found.figure(f"zero_{name}", f"{label}, mean at rest", f.mean + float(x[0]), unit, f.u_mean, how)
    if t is None:
        return f.rms, []
    how = f"Line through {since}; half a count of quantisation at least is in the interval."
    found.figure(f"drift_{name}", f"{label}, drift", f.drift, f"{unit}/min", f.u_drift, how)
    if f.rms == 0.0:
        return f.rms, []
    duration = float(t[-1] - t[0])
    highest = 0.4 * (x.size - 1) / duration
    seen = find_lines(TURN * (t - t[0]), x, highest, slowest=TEN / duration, most=MOST_LINES)
    return f.rms, [_row(name, line, unit, f.rms) for line in seen]


def add_standstill(found: Findings, run: Source, motion: Motion) -> None:
    """Noise floor of every channel: rms, drift, lines at fixed frequency, after the run has settled."""
    raw = {name: motion.pick(run.column(name)) for name, *_ in CHANNELS}
    raw["theta_m"], raw["theta_l"] = motion.theta_m, motion.theta_l
    known = {name: x for name, x in raw.items() if x is not None and x.size >= 64 and bool(np.isfinite(x).all())}
    if not known:
        found.cannot.append("No channel has the 64 valid rows a noise floor needs.")
        found.sentence = "The run is too short for a noise floor."
        return
    first = settled_from(list(known.values()))
    t = None if motion.t is None else motion.t[first:]
    moved = float(np.ptp(motion.theta_m[first:])) / TURN
    found.checks.append(
        Check("still", moved <= STILL, f"The motor moved {360 * moved:.3f}° while at rest, limit {360 * STILL:.1f}°.")
    )
    rows = motion.theta_m.size - first
    since = f"{rows} rows" + (
        "" if motion.t is None else f" from {motion.t[first] - motion.t[0]:.2f} s on, after settling"
    )
    lines: list[dict[str, float | str]] = []
    said = []
    for name, label, unit, scale in CHANNELS:
        if name not in known:
            found.cannot.append(f"{label}: not recorded.")
            continue
        x, count = known[name][first:] * scale, _count(run, name, known[name]) * scale
        rms, seen = _add_channel(found, (name, label, unit), x, t, count, since)
        said.append(f"{label.lower()} {f'{rms:.3g} {unit}' if rms > 0.0 else _below(count, unit)}")
        lines += seen
    if t is None:
        found.cannot.append("No usable time column: drift and fixed frequencies cannot be had.")
    else:
        found.tables["lines_at_rest"] = lines
    found.sentence = "Noise at rest (rms): " + ", ".join(said) + "." + _shaking(lines)
    if motion.t is not None and motion.t[first] - motion.t[0] > SETTLES:
        found.sentence += _changed(run, known, first, float(motion.t[first] - motion.t[0]))


def _changed(run: Source, known: Mapping[str, Array], first: int, after: float) -> str:
    """Of a rig that came to rest so late that something may have moved it: what its channels said before, and say now.

    `known`: (n,) by channel, of which rows `first` on count, `after` s from the start."""
    changed = []
    for name, label, unit, scale in CHANNELS:
        if name not in known:
            continue
        before, since = known[name][:first], known[name][first:]
        was, is_now = float(np.median(before)), float(np.median(since))
        if abs(is_now - was) > CHANGED * max(float(since.std()), _count(run, name, known[name])):
            changed.append(f"{label.lower()} {was * scale:.3g} → {is_now * scale:.3g} {unit}")
    what = f" ({', '.join(changed)})" if changed else ""
    return f" The rig was not at rest for the first {after:.1f} s{what}: all figures are of what came after."


def _shaking(lines: list[dict[str, float | str]]) -> str:
    """The line that stands out most, where there is one that shakes the rig."""
    strong = [row for row in lines if float(row["share"]) >= SHAKES]
    if not strong:
        return ""
    row = max(strong, key=lambda r: float(r["amplitude"]) / max(float(r["u"]), 1e-300))
    return (
        f" Something shakes at {float(row['frequency_hz']):.3f} Hz: {row['channel']} with an amplitude of "
        f"{float(row['amplitude']):.3g} {row['unit']}."
    )


def _below(count: float, unit: str) -> str:
    """A channel that never left one count."""
    return f"below one count of {count:.3g} {unit}" if count > 0.0 else "never changed"


def _count(run: Source, name: str, x: Array) -> float:
    """One step of a channel: from the encoder's counts, else the smallest step it made; 0 when it made none."""
    side = {"theta_m": "motor", "theta_l": "load"}.get(name)
    per_turn = declared(run.manifest.get("encoders") or {}, f"{side}_counts_per_rev") if side else None
    if per_turn:
        return TURN / per_turn
    steps = np.abs(np.diff(x))
    steps = steps[steps > 1e-9 * float(np.ptp(x))]  # less is rounding
    return float(steps.min()) if steps.size else 0.0


def _row(channel: str, line: Line, unit: str, rms: float) -> dict[str, float | str]:
    return {
        "channel": channel,
        "frequency_hz": line.order,
        "amplitude": line.amplitude,
        "u": line.u,
        "share": line.amplitude**2 / 2.0 / rms**2,
        "unit": unit,
    }
