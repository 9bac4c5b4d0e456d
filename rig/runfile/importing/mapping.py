"""The mapping file (schema hdrig.import/1): which column of a foreign file is which channel, read strictly, with the
keys of `keys.KEYS`."""

from __future__ import annotations

from collections.abc import Mapping as Dict
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rig.core.errors import UsageError
from rig.core.kinds import KINDS
from rig.core.regular import regular
from rig.core.toml import read_toml
from rig.runfile.importing.channel import ChannelMap, read_channel
from rig.runfile.importing.strict import Section, nearest

SCHEMA = "hdrig.import/1"
SHIPPED = Path(__file__).parent / "mappings"
COUNTED = {"theta_m": "counts_m", "theta_l": "counts_l"}  # angles, and the counts they may come from
SERIAL = 64  # characters of a gear's, as in a bench file: it is part of a folder's name
CHECKS = ("period", "epoch", "speed", "ratio", "torque", "stiffness", "file_unit", "column")
"""Plausibility that an [accept] may waive."""


@dataclass(frozen=True)
class Dialect:
    """[csv]: how the text is to be read."""

    delimiter: str = ","
    decimal: str = "."
    encoding: str = "utf-8"
    skip_rows: int = 0  # lines before the header
    units_row: bool = False  # the line after the header holds units
    names: tuple[str, ...] = ()  # for a file without a header


@dataclass(frozen=True)
class Mapping:
    """A whole mapping file."""

    source: str  # what errors call it
    text: str
    procedure: str
    gear: dict[str, Any]
    channels: dict[str, ChannelMap]
    declared: dict[str, Any] = field(default_factory=dict)
    conditions: dict[str, Any] = field(default_factory=dict)
    encoders: dict[str, int] = field(default_factory=dict)
    description: str = ""
    csv: Dialect = Dialect()
    accept: Dict[str, str] = field(default_factory=dict)

    @property
    def columns(self) -> list[str]:
        """Every column asked for, each once."""
        return list(dict.fromkeys(t.column for c in self.channels.values() for t in c.terms))


def shipped() -> list[str]:
    """Names of the mappings that come with the program."""
    return sorted(p.stem for p in SHIPPED.glob("*.toml"))


def load_mapping(mapping: Path | str) -> Mapping:
    """The mapping in a file, or the shipped one of that name. Raises UsageError, one sentence."""
    path = Path(mapping)
    if isinstance(mapping, str) and path.suffix != ".toml" and len(path.parts) == 1:
        if mapping not in shipped():
            raise UsageError(f"no mapping is called '{mapping}'; {nearest(mapping, shipped())} (or give a .toml file)")
        path = SHIPPED / f"{mapping}.toml"
    try:
        regular(path)
        return read_mapping(path.read_text(encoding="utf-8"), path.name)
    except UnicodeDecodeError:
        raise UsageError(f"{path} is not UTF-8 text; expected a mapping file in TOML") from None
    except OSError as error:
        raise UsageError(f"cannot read the mapping {path}: {error.strerror}") from None


def read_mapping(text: str, source: str) -> Mapping:
    """The mapping in `text`; `source` is what errors call it. Raises UsageError: file, key and what was expected."""
    raw = read_toml(text, source)
    top = Section(source, "", raw)
    top.text("schema", choices=(SCHEMA,))
    tables = top.table("channels")
    result = Mapping(
        source=source,
        text=text,
        description=top.text("description", ""),
        procedure=_procedure(top),
        gear=_gear(top.table("gear")),
        declared=_numbers(top.table("declared", {}), ("J_m", "J_l", "K"), whole=("fourier_terms",)),
        conditions=_conditions(top.table("conditions", {})),
        encoders=_numbers(top.table("encoders", {}), (), whole=("motor_counts_per_rev", "load_counts_per_rev")),
        csv=_dialect(top.table("csv", {})),
        accept=_accept(top.table("accept", {})),
        channels={name: read_channel(name, tables.table(name)) for name in tables.names()},
    )
    top.done()
    _angles(result)
    _columns(result)
    return replace(result, encoders=_encoders(result))


def _procedure(top: Section) -> str:
    """As manifests write it; the command line's name, with dashes, means the same."""
    said = top.text("procedure")
    name = said.replace("-", "_")
    if name not in KINDS:
        raise UsageError(f"{top.file}: procedure = '{said}'; {nearest(name, KINDS, most=len(KINDS))}")
    return name


def _gear(raw: Section) -> dict[str, Any]:
    gear: dict[str, Any] = {"ratio": raw.number("ratio", above=1.0)}
    if raw.has("output"):
        gear["output"] = raw.text("output", choices=("flexspline", "circular_spline"))
    if raw.has("serial"):
        gear["serial"] = raw.text("serial", longest=SERIAL)
    raw.done()
    return gear


def _numbers(raw: Section, numbers: tuple[str, ...], whole: tuple[str, ...]) -> dict[str, Any]:
    found: dict[str, Any] = {key: raw.number(key, None, above=0) for key in numbers}
    found |= {key: raw.whole(key, None, least=1) for key in whole}
    raw.done()
    return {key: value for key, value in found.items() if value is not None}


def _conditions(raw: Section) -> dict[str, Any]:
    found: dict[str, Any] = {key: raw.number(key, None) for key in ("tau_ext", "depth_mm", "speed_rpm")}
    found |= {"output_locked": raw.flag("output_locked", None), "note": raw.text("note", None)}
    raw.done()
    return {key: value for key, value in found.items() if value is not None}


def _dialect(raw: Section) -> Dialect:
    dialect = Dialect(
        delimiter=raw.text("delimiter", ",", blank=True),
        decimal=raw.text("decimal", ".", choices=(".", ",")),
        encoding=raw.text("encoding", "utf-8"),
        skip_rows=raw.whole("skip_rows", 0, most=100_000),
        units_row=raw.flag("units_row", False),
        names=raw.texts("names"),
    )
    raw.done()  # first: a misspelt delimiter leaves the usual one, which may not go with decimal
    if len(dialect.delimiter) != 1 or dialect.delimiter in '\r\n"':
        raw.refuse("delimiter", dialect.delimiter, "one character, such as ',', ';' or '\\t'")
    if dialect.delimiter == dialect.decimal:
        raw.refuse("delimiter", dialect.delimiter, f"another character than decimal = '{dialect.decimal}'")
    return dialect


def _accept(raw: Section) -> dict[str, str]:
    found = {key: raw.text(key, "") for key in CHECKS}
    raw.done()
    return {key: why for key, why in found.items() if why}


def _angles(mapping: Mapping) -> None:
    """A run needs an angle, and two angles need two columns. Raises UsageError."""
    motor, load = (mapping.channels.get(name) for name in ("theta_m", "theta_l"))
    if not (motor or load):
        raise UsageError(f"{mapping.source} maps no angle; expected [channels.theta_m] or [channels.theta_l]")
    if motor and load and motor.terms == load.terms:
        column = motor.terms[0].column
        raise UsageError(f"{mapping.source}: theta_m and theta_l are both column '{column}'; expected one column each")


def _columns(mapping: Mapping) -> None:
    """No column is two channels, but counts are also their angle, and what is scaled is another number of one kind.
    Raises UsageError unless waived."""
    first: dict[str, ChannelMap] = {}
    for channel in mapping.channels.values() if "column" not in mapping.accept else ():
        if len(channel.terms) > 1:
            continue
        column = channel.terms[0].column
        other = first.setdefault(column, channel)
        counted = {other.name, channel.name} in [set(pair) for pair in COUNTED.items()]
        if other is not channel and not counted and not _another(channel, other):
            said = f"{mapping.source}: channels.{channel.name}: column '{column}' is already {other.name}"
            raise UsageError(f"{said}; expected one column each, or say why not in accept.column")


def _another(channel: ChannelMap, other: ChannelMap) -> bool:
    """Whether two channels of one column are different numbers of one kind: it stands in the mapping how."""
    return channel.quantity == other.quantity and channel.terms != other.terms


def _encoders(mapping: Mapping) -> dict[str, int]:
    """[encoders], completed from counts_per_turn. Raises UsageError where the two differ."""
    found = dict(mapping.encoders)
    for name, key in (("theta_m", "motor_counts_per_rev"), ("theta_l", "load_counts_per_rev")):
        stated = mapping.channels[name].counts_per_turn if name in mapping.channels else 0
        if stated and found.setdefault(key, stated) != stated:
            raise UsageError(
                f"{mapping.source}: encoders.{key} = {found[key]} but channels.{name}.counts_per_turn = {stated}; "
                "expected the same number"
            )
    return found
