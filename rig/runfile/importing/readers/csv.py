"""Delimited text, through pyarrow, after its encoding and its header have been looked at."""

from __future__ import annotations

import codecs
import contextlib
import csv
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from rig.core.errors import UsageError
from rig.runfile.importing.mapping import Dialect
from rig.runfile.importing.readers.parquet import to_numpy
from rig.runfile.importing.table import Table, locate
from rig.runfile.importing.units import known
from rig.runfile.manifest import SIMULATED

CHUNK = 1 << 20  # bytes
PREAMBLE = 100  # lines that a logger may write before its header
LOOKED_AT = 64  # bytes at the start of a file whose zeros tell two-byte letters
MOSTLY = 0.5  # of the letters: a header may hold a θ, which has no zero byte
LONGEST_LINE = 1 << 20  # characters; a table of ten thousand columns has a header of a fifth of that


def read(path: Path, wanted: Sequence[str], dialect: Dialect) -> Table:
    """The wanted columns. Raises UsageError."""
    check_text(path, dialect.encoding)
    names, units = header(path, dialect)
    check_preamble(path, names, wanted, dialect)
    check_delimiter(path, names, dialect)
    found = locate(names, wanted, path.name)
    check_units_row(path, names, list(found.values()), dialect)
    lines = dialect.skip_rows + (0 if dialect.names else 1) + (1 if dialect.units_row else 0)

    import pyarrow.csv as pacsv

    with rows_counted_from(lines):
        table = pacsv.read_csv(
            path,
            # one thread: only then does the library say which row a complaint is about
            pacsv.ReadOptions(
                use_threads=False,
                block_size=4 * LONGEST_LINE,
                skip_rows=lines,
                column_names=names,
                encoding=dialect.encoding,
            ),
            pacsv.ParseOptions(delimiter=dialect.delimiter),
            pacsv.ConvertOptions(
                include_columns=list(dict.fromkeys(found.values())),
                decimal_point=dialect.decimal,
                strings_can_be_null=True,
            ),
        )
    said = f"row {table.num_rows}, the last, has no line end: the file may be cut short in its last number"
    stated = dict(zip(names, units, strict=False))
    return Table(
        {name: to_numpy(table[full]) for name, full in found.items()},
        {name: stated[full] for name, full in found.items() if stated.get(full)},
        notes=() if ends_a_line(path) else (said,),
        simulated=SIMULATED in names,
        text=True,
    )


@contextlib.contextmanager
def rows_counted_from(lines: int) -> Iterator[None]:
    """Complaints count rows as ours do, from the first after the header: the library's are lines of the file, of which
    `lines` come before that."""
    try:
        yield
    except ValueError as error:
        said = re.sub(r"Row #(\d+)", lambda m: f"row {int(m[1]) - lines} (line {m[1]} of the file)", str(error))
        raise ValueError(said) from error


def ends_a_line(path: Path) -> bool:
    """False when a kill may have cut the last number in two without that showing."""
    with path.open("rb") as file:
        file.seek(-4, 2)
        return file.read().rstrip(b"\0").endswith((b"\n", b"\r"))  # of a wide encoding zeros are part of it


def check_text(path: Path, encoding: str) -> None:
    """Raises UsageError when the file is not text of this encoding, with the byte at which it is not."""
    try:
        decoder = codecs.getincrementaldecoder(encoding)()
    except LookupError:
        raise UsageError(
            f"csv.encoding = '{encoding}' is no encoding Python knows; expected e.g. 'utf-8' or 'cp1252'"
        ) from None
    wide = encoding.lower().replace("_", "-").startswith(("utf-16", "utf-32"))
    done = 0
    with path.open("rb") as file:
        while True:
            block = file.read(CHUNK)
            if not wide and (at := block.find(b"\0")) >= 0:
                raise UsageError(
                    f"{path.name} is not text: byte {done + at} is 0 (csv.encoding = '{encoding}'){utf16(block)}"
                )
            held = len(decoder.getstate()[0])
            try:
                decoder.decode(block, final=not block)
            except UnicodeError as error:
                at = done - held + getattr(error, "start", 0)
                raise UsageError(
                    f"{path.name} is not {encoding} text: byte {at} cannot be read; set [csv] encoding, e.g. 'cp1252'"
                ) from None
            if not block:
                return
            done += len(block)


def utf16(start: bytes) -> str:
    """What to set for a file that starts as UTF-16 does, with a mark or with letters of two bytes; "" for others.

    One byte of each Latin letter is zero there and the other is none; in a binary file zeros stand where they like."""
    odd, even = (start[at:LOOKED_AT:2].count(0) / max(1, len(start[at:LOOKED_AT:2])) for at in (1, 0))
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        found = "utf-16"
    elif odd > MOSTLY and not even:
        found = "utf-16-le"
    elif even > MOSTLY and not odd:
        found = "utf-16-be"
    else:
        return ""
    return f'; it looks like UTF-16: set [csv] encoding = "{found}"'


def check_preamble(path: Path, names: list[str], wanted: Sequence[str], dialect: Dialect) -> None:
    """Raises UsageError when a later line than the header is the one with all the wanted names."""
    if dialect.names or set(wanted) <= set(names):
        return
    with path.open(encoding=dialect.encoding, newline="") as file:
        lines = [file.readline(LONGEST_LINE) for _ in range(PREAMBLE)]
    for before, line in enumerate(lines):
        if set(wanted) <= {cell.strip().strip('"') for cell in line.split(dialect.delimiter)}:
            raise UsageError(
                f"{path.name}: line {dialect.skip_rows + 1} is read as the header, but line {before + 1} holds the "
                f"names of the columns; set [csv] skip_rows = {before}"
            )


def header(path: Path, dialect: Dialect) -> tuple[list[str], list[str]]:
    """(names, units) of the columns; units is empty where the file has no row of them."""
    rows = 2 if dialect.units_row and not dialect.names else 1
    with path.open(encoding=dialect.encoding, newline="") as file:
        if file.read(1) != "\ufeff":  # a byte order mark is no part of the first name
            file.seek(0)
        lines = [file.readline(LONGEST_LINE) for _ in range(dialect.skip_rows + rows)]
    for number, line in enumerate(lines, start=1):
        if len(line) >= LONGEST_LINE:
            raise UsageError(f"{path.name}: line {number} is longer than {LONGEST_LINE} characters; expected a table")
    lines = lines[dialect.skip_rows :]
    if not lines[0].strip():
        where = f"line {dialect.skip_rows + 1}"
        raise UsageError(f"{path.name}: {where} is empty or past the end; expected the header (see csv.skip_rows)")
    try:
        cells = [[c.strip() for c in row] for row in csv.reader(lines, delimiter=dialect.delimiter)]
    except csv.Error as error:
        raise ValueError(f"header: {error}") from None
    names = list(dialect.names) or cells[0]
    units = cells[-1] if dialect.units_row else []
    if dialect.names and len(cells[0]) != len(names):
        raise UsageError(f"{path.name} has {len(cells[0])} columns, but csv.names gives {len(names)} names")
    return names, units


def check_units_row(path: Path, names: Sequence[str], wanted: Sequence[str], dialect: Dialect) -> None:
    """Raises UsageError when the first row of numbers holds a unit in a wanted column: a row of them nobody named."""
    if dialect.units_row:
        return
    before = dialect.skip_rows + (0 if dialect.names else 1)
    with path.open(encoding=dialect.encoding, newline="") as file:
        first = [file.readline(LONGEST_LINE) for _ in range(before + 1)][-1]
    with contextlib.suppress(csv.Error):  # what reads the whole file says more of such a line
        cells = dict(zip(names, next(csv.reader([first], delimiter=dialect.delimiter), []), strict=False))
        for name in wanted:
            if known(cell := cells.get(name, "").strip()):
                raise UsageError(
                    f"{path.name}: row 1 holds {cell!r}, a unit, in column '{name}'; set [csv] units_row = true"
                )


def check_delimiter(path: Path, names: list[str], dialect: Dialect) -> None:
    """Raises UsageError when everything is one column because the delimiter is not the file's."""
    if len(names) == 1:
        for other, spelt in ((";", ";"), (",", ","), ("\t", "\\t"), ("|", "|")):
            if other != dialect.delimiter and (count := names[0].count(other)):
                raise UsageError(
                    f"{path.name} has 1 column when split at '{dialect.delimiter}', but its header holds '{spelt}' "
                    f'{count} times; set [csv] delimiter = "{spelt}"'
                )
