"""Columns of a foreign file → channels in SI, in one row grid. Refuses what is no number where a number is needed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rig.core.channels import CHANNEL
from rig.core.errors import UsageError
from rig.core.units import TURN
from rig.runfile.importing import refuse, timing
from rig.runfile.importing.channel import NEEDED, QUANTITY, ChannelMap
from rig.runfile.importing.mapping import COUNTED, Mapping
from rig.runfile.importing.table import Table
from rig.runfile.importing.units import SI, UNITS, in_name, known
from rig.runfile.importing.unwrap import unwrap

Array = npt.NDArray[Any]


class Channel(NamedTuple):
    """One column of the run: float64 with null = NaN, or int64 counts."""

    values: Array
    unit: str
    meaning: str


@dataclass
class Converted:
    """What will be written: channels of equal length, what was noticed on the way, when the first row was."""

    channels: dict[str, Channel]
    notes: list[str]
    simulated: bool = False  # the file says that its samples are the twin's
    utc: datetime | None = None
    time: dict[str, float] = field(default_factory=dict)

    def values(self, name: str) -> Array | None:
        """The values of a channel, None when the run has none of that name."""
        return self.channels[name].values if name in self.channels else None


def convert(table: Table, mapping: Mapping, file: str) -> Converted:
    """Every mapped channel in SI; each has its unit (see with_file_units).

    Raises UsageError, with row and number, where a column cannot be meant.
    """
    refuse.same_length(table.columns, file)
    table = _without_holes(table, mapping, file)
    result = Converted({}, list(table.notes), simulated=table.simulated)
    keep = np.ones(refuse.same_length(table.columns, file), dtype=bool)
    decimal = mapping.csv.decimal if table.text else ""
    if clock := mapping.channels.get("t"):
        keep = _time(result, table, clock, file, decimal)
    skip = np.diff(result.channels["t"].values) > timing.GAP * result.time["period_median"] if clock else None
    for name, channel in mapping.channels.items():
        if name != "t":
            raw = [_numbers(table.columns[term.column], term.column, file, decimal)[keep] for term in channel.terms]
            _add(result, channel, raw, skip, file)
    if result.utc is None and table.started is not None and table.started.tzinfo is not None:
        result.utc = table.started + timedelta(seconds=result.time.get("first", 0.0))
    return result


def _without_holes(table: Table, mapping: Mapping, file: str) -> Table:
    """The rows in which every channel that says so has a value, and a note of the others."""
    notes = list(table.notes)
    keep = np.ones(refuse.same_length(table.columns, file), dtype=bool)
    for name, channel in mapping.channels.items():
        raws = [table.columns[term.column] for term in channel.terms] if channel.drop_holes else []
        hole = np.zeros(keep.size, dtype=bool)
        for raw in raws:
            hole |= np.isnat(raw) if raw.dtype.kind == "M" else ~np.isfinite(raw) if raw.dtype.kind == "f" else False
        if count := int(np.count_nonzero(hole)):
            row = int(hole.argmax()) + 1
            notes.append(
                f"{count} of {hole.size} rows left out: {name} has no value there, first in row {row} of the file"
            )
        keep &= ~hole
    if keep.all():
        return table
    return table._replace(columns={n: c[keep] for n, c in table.columns.items()}, notes=tuple(notes))


def with_file_units(mapping: Mapping, stated: dict[str, str], file: str) -> Mapping:
    """The mapping with every unit filled in from the file. Raises UsageError where none is stated, or they differ."""
    channels = {}
    for name, channel in mapping.channels.items():
        says = channel.plain and channel.unit != "datetime"  # then what the file states is about these very numbers
        column = channel.terms[0].column
        said = stated.get(column) or in_name(column)
        found = known(said) if says else None
        where = f"{mapping.source}: channels.{name}"
        if not channel.unit:
            others = ", ".join(u.word for u in UNITS.values() if u.quantity == channel.quantity)
            if found is None or found.quantity != channel.quantity:
                what = f"{file} states '{said}'" if said and channel.plain else f"{file} states none"
                raise UsageError(f"{where} has no unit and {what}; expected one of {others}")
            if found.word == "counts" and not channel.counts_per_turn:
                raise UsageError(f"{where}: {file} states counts, so counts_per_turn is needed")
            channel = replace(channel, unit=found.word)
        elif found and found.word != channel.unit and found.quantity == channel.quantity and not _waived(mapping):
            raise UsageError(
                f"{where}.unit = '{channel.unit}', but {file} states '{found.word}' for column "
                f"'{column}'; set unit = \"{found.word}\", or say why not in accept.file_unit"
            )
        channels[name] = channel
    return replace(mapping, channels=channels)


def _waived(mapping: Mapping) -> bool:
    return "file_unit" in mapping.accept


def _time(result: Converted, table: Table, clock: ChannelMap, file: str, decimal: str) -> Array:
    """Add `t`; the rows to keep."""
    column = clock.terms[0].column
    raw = table.columns[column]
    if raw.dtype.kind == "M":
        refuse.holes(np.isnat(raw).astype(float), np.isnat(raw), "t", column, file)
    elif clock.unit == "datetime":
        raise UsageError(
            f"{file}: column '{column}' is no date (first value {raw[0]}); expected one, as unit = 'datetime'"
        )
    else:
        raw = _numbers(raw, column, file, decimal)
        refuse.holes(raw, ~np.isfinite(raw), "t", column, file)
    keep = timing.check_order(raw, "" if clock.unit == "datetime" else clock.unit, file, clock.drop_duplicates)
    if dropped := int((~keep).sum()):
        result.notes.append(f"{dropped} rows dropped: they had the time stamp of the row before")
    refuse.enough(int(keep.sum()), file)
    found = timing.stamps(raw[keep], clock, clock.unit)
    result.utc, result.time = found.utc, {"first": found.first, **timing.facts(found.t)}
    result.notes += timing.notes(result.time)
    if found.first and raw.dtype.kind != "M":
        result.notes.append(f"t was moved to start at 0: the file's first stamp is {found.first:.9g} s")
    if raw.dtype.kind == "M":
        result.notes.append("t was dates; those without a time zone were read as UTC")
    result.channels["t"] = Channel(found.t, "s", clock.meaning or "time since the first row, as the logger stamped it")
    return keep


def _numbers(raw: Array, column: str, file: str, decimal: str) -> Array:
    """The column as int64 or float64. Raises UsageError for text, with its first cell that is none."""
    match raw.dtype.kind:
        case "f":
            return raw.astype(np.float64)
        case "u" if raw.size and raw.max() > np.iinfo(np.int64).max:
            return raw.astype(np.float64)
        case "i" | "u" | "b":
            return raw.astype(np.int64)
    raise refuse.not_numbers(raw, column, file, decimal)


def _add(result: Converted, channel: ChannelMap, raw: list[Array], skip: Array | None, file: str) -> None:
    """Check, unwrap and scale one channel; keep its counts when it has them."""
    name, column = channel.name, " + ".join(t.column for t in channel.terms)
    joined = raw[0] if len(raw) == 1 else sum((r * 0.0 for r in raw), np.zeros(len(raw[0])))
    hole = ~np.isfinite(joined)
    refuse.holes(joined, hole if name in NEEDED else np.isinf(joined), name, column, file)
    if name not in NEEDED and (nulls := int(hole.sum())):
        result.notes.append(f"{name}: {nulls} of {len(hole)} values are null in the file and stay null")
    if channel.unit == "counts" and not hole.any():
        raw = [refuse.whole_counts(r, t.column, name, file) for r, t in zip(raw, channel.terms, strict=True)]
    if channel.modulus:
        refuse.beyond_modulus(raw[0], channel, file)
        raw = [unwrap(raw[0], channel.modulus)]
    elif channel.quantity in ("angle", "counts") and channel.plain and name in (*NEEDED, *COUNTED.values()):
        refuse.undeclared_wrap(raw[0], channel, skip, file)
    if name in COUNTED and channel.unit == "counts" and channel.plain:
        counts = CHANNEL[COUNTED[name]]
        result.channels.setdefault(counts.name, Channel(raw[0], counts.unit, counts.meaning))
    result.channels[name] = _scaled(channel, raw)


def _scaled(channel: ChannelMap, raw: list[Array]) -> Channel:
    """value = sign·(Σ scale·(column − zero)) + offset in its unit, then in SI."""
    meaning = channel.meaning or CHANNEL[channel.name].meaning
    if channel.quantity == "counts" and channel.name in QUANTITY:
        return Channel(raw[0], "counts", meaning)
    zero = int(channel.zero) if raw[0].dtype.kind == "i" and channel.zero == int(channel.zero) else channel.zero
    total = sum((term.scale * (r - zero) for term, r in zip(channel.terms, raw, strict=True)), np.zeros(len(raw[0])))
    values = channel.sign * total + channel.offset
    if channel.unit == "counts" and channel.counts_per_turn:
        return Channel(values * (TURN / channel.counts_per_turn), "rad", meaning)
    if channel.quantity in SI:
        return Channel(values * (UNITS[channel.unit].factor or 1.0), SI[channel.quantity], meaning)
    return Channel(values, channel.unit, meaning)
