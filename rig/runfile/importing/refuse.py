"""Columns that cannot be meant: each refusal one sentence with row and number. Rows count from 1, without header."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.core.errors import UsageError
from rig.core.units import TURN
from rig.runfile.importing.channel import NEEDED, ChannelMap
from rig.runfile.importing.units import UNITS
from rig.runfile.importing.unwrap import wrapped_at

Array = npt.NDArray[Any]

COUNTERS = tuple(2.0**bits for bits in (*range(12, 25), 26, 28, 32))  # widths sold


def same_length(columns: Mapping[str, Array], file: str) -> int:
    """The number of rows. Raises UsageError when columns differ in it, or there are fewer than two."""
    lengths = {name: len(values) for name, values in columns.items()}
    if len(set(lengths.values())) > 1:
        said = ", ".join(f"'{name}' {n}" for name, n in list(lengths.items())[:8])
        raise UsageError(f"{file}: the columns are not equally long: {said} rows; expected one rate for all of them")
    rows = next(iter(lengths.values()))
    enough(rows, file)
    return rows


def enough(rows: int, file: str) -> None:
    """Raises UsageError for fewer than two rows."""
    if rows < 2:
        raise UsageError(f"{file} has {rows} row{'' if rows == 1 else 's'} of data; expected at least 2")


def not_numbers(raw: Array, column: str, file: str, decimal: str = ".") -> UsageError:
    """The sentence for a column of text, dates or the like, showing the first cell that is no number where the mapping
    says that `decimal` divides; "" is of a file that is no text: [csv] cannot mend it."""
    cells = raw.tolist()
    if not decimal:
        shown = next((f": row {row} holds {cell!r}" for row, cell in enumerate(cells, 1) if isinstance(cell, str)), "")
        kind = "text" if shown else raw.dtype
        return UsageError(f"{file}: column '{column}' holds {kind}{shown}; expected whole numbers or floats")
    if said := _two_decimals(cells):
        return UsageError(f"{file}: column '{column}' is not numbers: {said}; expected one decimal character in all")
    for row, cell in enumerate(cells):
        try:
            float(cell.replace(decimal, ".") if isinstance(cell, str) else cell)
        except (TypeError, ValueError):
            hint = ""
            if decimal != "," and isinstance(cell, str) and _is_number(cell, ","):
                hint = '; set [csv] decimal = ","'
            return UsageError(f"{file}: column '{column}' is not numbers: row {row + 1} holds {cell!r}{hint}")
    text = next(((row, cell) for row, cell in enumerate(cells, 1) if isinstance(cell, str)), None)
    if text is not None:  # each would be a number where a point divides
        return UsageError(
            f"{file}: column '{column}' is not numbers: row {text[0]} holds {text[1]!r}; expected numbers as [csv] "
            "decimal says"
        )
    return UsageError(f"{file}: column '{column}' holds {raw.dtype}; expected numbers")


def _two_decimals(cells: Sequence[Any]) -> str:
    """The first number with a comma and the first with a point, in words; "" where there is one kind at most."""
    first: dict[str, str] = {}
    for row, cell in enumerate(cells, 1):
        for mark in ",.":
            if isinstance(cell, str) and _is_number(cell, mark):
                first.setdefault(mark, f"row {row} holds {cell!r}")
    return " and ".join(first.values()) if len(first) > 1 else ""


def _is_number(cell: str, mark: str) -> bool:
    """Whether `mark` divides the digits of a number."""
    return cell.count(mark) == 1 and cell.replace(mark, "").strip(" +-").isdigit()


def holes(values: Array, bad: Array, name: str, column: str, file: str) -> None:
    """Raises UsageError when `bad` marks anything: how many, and the first row."""
    if not bad.any():
        return
    row = int(np.flatnonzero(bad)[0])
    what = "infinite" if np.isinf(values[bad]).all() else "missing (null or NaN)"
    mixed = "" if np.isinf(values[bad]).all() or not np.isinf(values[bad]).any() else " or infinite"
    raise UsageError(
        f"{file}: {int(bad.sum())} of {len(bad)} values of {name} (column '{column}') are {what}{mixed}, "
        f"first in row {row + 1}; expected a number in every row{_advised(name)}"
    )


def _advised(name: str) -> str:
    return f', or set channels.{name}.holes = "drop" to leave such rows out' if name in NEEDED else ""


def whole_counts(raw: Array, column: str, name: str, file: str) -> Array:
    """The counts as int64. Raises UsageError when they are not whole, or beyond what float64 holds exactly."""
    if raw.dtype.kind == "i":
        return raw
    odd = np.flatnonzero(raw != np.round(raw))
    if odd.size:
        row = int(odd[0])
        raise UsageError(
            f"{file}: {odd.size} of {len(raw)} values of {name} (column '{column}') are not whole counts, "
            f"first {raw[row].item()!r} in row {row + 1}; expected whole numbers with unit = 'counts'"
        )
    if np.abs(raw).max() > 2**53:
        raise UsageError(
            f"{file}: {name} reaches {np.abs(raw).max():g} counts; floating-point counts are exact to 2^53"
        )
    return raw.astype(np.int64)


def beyond_modulus(raw: Array, channel: ChannelMap, file: str) -> None:
    """Raises UsageError when a column spans more than the modulus at which it is said to wrap.

    Either end may be off by half of its last digit: 2π written to four places is 6.2832.
    """
    low, high = raw.min(), raw.max()
    if high - low > channel.modulus + last_digit(max(low, high, key=abs)):
        raise UsageError(
            f"{file}: channels.{channel.name} wraps at {channel.modulus:.10g} {channel.unit}, but column "
            f"'{channel.terms[0].column}' goes from {low:.10g} to {high:.10g}; take modulus (or bits) out, or correct "
            "it"
        )


def last_digit(value: Any) -> float:
    """What the last digit of `value` stands for as it was written, or its last bit in single precision; 0 for a whole
    number."""
    if np.issubdtype(type(value), np.integer):
        return 0.0
    single = np.float32(value)
    bit = float(np.spacing(np.abs(single))) if float(single) == float(value) else 0.0
    return max(10.0 ** int(Decimal(repr(float(value))).as_tuple().exponent), bit)


def undeclared_wrap(raw: Array, channel: ChannelMap, skip: Array | None, file: str) -> None:
    """Raises UsageError when the largest step is nearly a full turn or counter width: it wraps, and nobody said so."""
    candidates: tuple[float, ...] = COUNTERS
    if channel.unit != "counts":
        candidates = (TURN / (UNITS[channel.unit].factor or 1.0),)
    elif channel.counts_per_turn:
        candidates = (float(channel.counts_per_turn), *COUNTERS)
    found = wrapped_at(raw, candidates, np.zeros(len(raw) - 1, dtype=bool) if skip is None else skip)
    if found is None:
        return
    row, jump, modulus = found
    width = repr(modulus) if modulus % 1 else str(int(modulus))
    raise UsageError(
        f"{file}: column '{channel.terms[0].column}' jumps by {jump:.10g} {channel.unit} at row {row}, nearly a full "
        f"{modulus:.10g}: it wraps; set channels.{channel.name}.modulus = {width}"
    )
