"""From manifest, bench, timing and events to rows of text for tables. Tolerant: a folder made by somebody else may hold
any of it or nothing; what is absent is left out, what is unknown is shown as it stands.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from typing import Any, NamedTuple

from rig.core.numbers import number
from rig.report.numbers import fixed, join, plain
from rig.report.words import UNITS, humanise, named

BYTES = ((1e9, "GB"), (1e6, "MB"), (1e3, "kB"), (1, "B"))
DEEPEST = 8  # levels of nested tables
LONGEST = 600  # characters of one value; what is longer is a file of its own, not a line of a report


class Row(NamedTuple):
    """A name and what it is."""

    name: str
    value: str
    code: bool = False  # set in the typewriter face: hashes, identifiers


class Number(NamedTuple):
    """One number of the bench and where it comes from."""

    key: str
    value: str
    source: str  # paper, catalogue, assumed, measured …; "declared" for a bare number
    note: str


def show(value: Any, depth: int = 0) -> str:
    """Any value of a manifest as text; what is nested deeper than people read is cut."""
    if depth > DEEPEST:
        return "…"
    match value:
        case None:
            return "unknown"
        case bool():
            return "yes" if value else "no"
        case int():
            return fixed(value, 0) if abs(value) < 2**63 else f"an integer of {value.bit_length()} bits"
        case float():
            return plain(value, 6)
        case list() | tuple():
            return ", ".join(show(v, depth + 1) for v in value)
        case dict():
            return ", ".join(f"{k} {show(v, depth + 1)}" for k, v in value.items())
    text = str(value)
    return text if len(text) <= LONGEST else text[:LONGEST] + " …"


def cut(value: Any, depth: int = 0) -> Any:
    """`value` without what is nested deeper than people read; text of it is then safe to make."""
    if isinstance(value, Mapping):
        return {k: cut(v, depth + 1) for k, v in value.items()} if depth <= DEEPEST else "…"
    if isinstance(value, list | tuple):
        return [cut(v, depth + 1) for v in value] if depth <= DEEPEST else "…"
    if isinstance(value, int) and abs(value) >= 2**63:
        return show(value)
    return value


def measured(key: str, value: Any) -> Row:
    """A condition or declared value with its name and unit."""
    name, unit = named(key)
    return Row(
        name, join(show(value), unit) if isinstance(value, int | float) and not isinstance(value, bool) else show(value)
    )


def table(found: Any) -> Mapping[str, Any]:
    """`found` when it is a table, else an empty one."""
    return found if isinstance(found, Mapping) else {}


def conditions(manifest: Mapping[str, Any]) -> list[Row]:
    """The conditions of the run, those without a value said to be unknown."""
    return [measured(str(k), v) for k, v in table(manifest.get("conditions")).items() if v != ""]


def declared(manifest: Mapping[str, Any]) -> list[Row]:
    """The operator's numbers for the gear."""
    return [measured(str(k), v) for k, v in table(manifest.get("declared")).items()]


def utc(text: Any) -> str:
    """An ISO time as "2026-11-20 01:47:12 UTC"; as it stands when it is none, or says no zone."""
    try:
        moment = datetime.fromisoformat(str(text).replace("Z", "+00:00"))
        return f"{moment.astimezone(UTC):%Y-%m-%d %H:%M:%S} UTC" if moment.tzinfo else show(text)
    except (ValueError, OverflowError):
        return show(text)


def flat(tree: Mapping[str, Any], stem: str = "", depth: int = 0) -> Iterator[tuple[str, str]]:
    """Leaves of nested tables as (dotted key, text)."""
    for key, value in tree.items():
        name = f"{stem}{key}"
        if isinstance(value, Mapping) and depth < DEEPEST:
            yield from flat(value, f"{name}.", depth + 1)
        elif value is not None and value != "":
            yield name, join(show(value), UNITS.get(name, "") if math.isfinite(number(value)) else "")


def files(manifest: Mapping[str, Any]) -> list[tuple[str, str, str, str]]:
    """(name, rows, size, SHA-256) of every file of the run. Files derived from it are left out: one of them is this
    page, and the hash of another may be of its last edition.
    """
    listed = [(str(name), table(entry)) for name, entry in table(manifest.get("files")).items()]
    return [
        (name, show(e["rows"]) if "rows" in e else "", size(e.get("bytes")), show(e.get("sha256", "")))
        for name, e in listed
        if not e.get("derived")
    ]


def size(count: Any) -> str:
    """A number of bytes for people."""
    if not isinstance(count, int) or not math.isfinite(number(count)):
        return ""
    return next(join(plain(count / n, 3), unit) for n, unit in BYTES if count >= n or n == 1)


def bench_numbers(bench: Mapping[str, Any], stem: str = "", depth: int = 0) -> Iterator[Number]:
    """Every number of a bench file with its provenance, in the file's order."""
    for key, entry in bench.items():
        name = f"{stem}{key}"
        if isinstance(entry, Mapping) and "value" in entry:
            text = join(show(entry["value"]), show(entry.get("unit", "")))
            yield Number(name, text, show(entry.get("from", "declared")), show(entry.get("note", "")))
        elif isinstance(entry, Mapping):
            if depth < DEEPEST:
                yield from bench_numbers(entry, f"{name}.", depth + 1)
        elif isinstance(entry, int | float | list) and not isinstance(entry, bool):
            yield Number(name, show(entry), show(bench.get("from", "declared")), "")


def events(found: object) -> list[tuple[str, str, str]]:
    """(time, kind, text) of every event, the time in s of the run or, where that is unknown, in UTC. Keys that are
    neither are added to the text.
    """
    out = []
    for event in found if isinstance(found, list | tuple) else ():
        if not isinstance(event, Mapping):
            continue
        rest: dict[Any, Any] = dict(event)
        clock = rest.pop("utc", None)
        moment = next((rest.pop(k) for k in ("t", "time", "t_s") if k in rest), None)
        moment = clock if moment is None else moment
        kind = next((rest.pop(k) for k in ("kind", "event", "act", "type") if k in rest), "")
        text = [show(rest.pop(k)) for k in ("text", "sentence", "why", "reason", "message", "note") if rest.get(k)]
        text += [f"{k} {show(v)}" for k, v in rest.items() if v not in (None, "")]
        when = join(fixed(number(moment), 3), "s") if math.isfinite(number(moment)) else utc(moment) if moment else ""
        out.append((when, humanise(show(kind)), "; ".join(text)))
    return out


def micro(seconds: Any) -> str:
    """Lateness for people: µs below a millisecond, ms above."""
    if not math.isfinite(number(seconds)):
        return show(seconds)
    return join(plain(seconds * 1e6, 3), "µs") if seconds < 1e-3 else join(plain(seconds * 1e3, 3), "ms")


TIMING = (
    ("lateness_p50", "Lateness p50", micro),
    ("lateness_p99", "Lateness p99", micro),
    ("lateness_p999", "Lateness p99.9", micro),
    ("lateness_max", "Lateness, greatest", micro),
    ("ticks", "Cycles run", show),
    ("missed_cycles", "Cycles missed and skipped", show),
    ("late_events", "Times a cycle was skipped", show),
)


def timing(found: object) -> tuple[list[Row], list[str]]:
    """Rows and sentences on the loop. On a virtual clock lateness is left out, and it is said why."""
    if not isinstance(found, Mapping) or not found:
        return [], []
    virtual = found.get("clock") == "virtual"
    rows: list[Row] = []
    period = found.get("period")
    if number(period) > 1e-12:
        rows.append(Row("Rate", join(plain(1 / number(period), 5), "Hz")))
    for key, name, say in TIMING:
        if key in found and not (virtual and key.startswith("lateness")):
            rows.append(Row(name, say(found[key])))
    rows += _latched(found.get("latch_offsets"))
    known = {"period", "clock", "how", "latch_offsets", "latch_offsets_are"} | {k for k, _, _ in TIMING}
    rows += [Row(humanise(name), value) for name, value in flat({k: v for k, v in found.items() if k not in known})]
    said = (
        ["The run had a virtual clock: time passed only when the loop waited for it, so lateness has no meaning here."]
        if virtual
        else [f"Measured as {found['how']}."]
        if found.get("how")
        else []
    )
    if found.get("latch_offsets_are"):
        said.append(f"When a channel was latched is kept as {show(found['latch_offsets_are'])}.")
    return rows, said


CHANNELS = {"theta_l": "θ_l", "tau_l": "τ_l", "tau_m": "τ_m"}


def _latched(found: object) -> list[Row]:
    """Mean and scatter of when each channel was latched, after the motor angle; entries that are no table left out."""
    if not isinstance(found, Mapping):
        return []
    made = []
    for name, entry in found.items():
        if isinstance(entry, Mapping) and math.isfinite(number(entry.get("mean"))):
            late = join(plain(number(entry["mean"]) * 1e6, 3), "µs")
            scatter = number(entry.get("deviation")) * 1e6
            more = f", 1 σ {join(plain(scatter, 2), 'µs')}" if scatter >= 0.001 else ""
            made.append(Row(f"{CHANNELS.get(str(name), show(name))} latched after θ_m", late + more))
    return made
