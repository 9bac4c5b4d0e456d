"""Keys of a manifest that hold what they cannot mean, in words: else nobody knows why they count as not said."""

from __future__ import annotations

import difflib
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import datetime
from typing import Any, NamedTuple

from rig.core.kinds import KINDS
from rig.core.nearest import nearest
from rig.core.numbers import number, stated

OUTPUTS = ("flexspline", "circular_spline")


class Kind(NamedTuple):
    """What a key may hold."""

    expected: str
    fits: Callable[[object], bool]


def _is_text(said: object) -> bool:
    return isinstance(said, str)


def _is_table(said: object) -> bool:
    return isinstance(said, Mapping)


def _is_name(said: object) -> bool:
    """A number is one too."""
    return isinstance(said, str) or math.isfinite(number(said))


def _is_time(said: object) -> bool:
    try:
        return isinstance(said, str) and (not said or bool(datetime.fromisoformat(said)))
    except ValueError:
        return False


def _are_numbers(said: object) -> bool:
    return isinstance(said, list) and all(math.isfinite(number(one)) for one in said)


def _between(low: float, high: float, unit: str) -> Kind:
    """Of what a gear has, from a watch's to a ship's: beyond, a digit or a unit is wrong."""
    return Kind(f"a number from {low:g} to {high:g} {unit}".rstrip(), lambda said: low <= stated(said) <= high)


def _not_negative(unit: str) -> Kind:
    return Kind(f"a number of 0 or more in {unit}", lambda said: stated(said) >= 0.0)


def _any(unit: str) -> Kind:
    return Kind(f"a number in {unit}", lambda said: math.isfinite(stated(said)))


TEXT, TABLE, TIME = Kind("text", _is_text), Kind("an object", _is_table), Kind("ISO 8601", _is_time)
NAME = Kind("a number or a name", _is_name)
NUMBER = Kind("a number", lambda said: math.isfinite(number(said)))
COUNT = Kind("a whole number", lambda said: isinstance(said, int) and math.isfinite(number(said)))
LIST = Kind("a list of numbers", _are_numbers)

Path = tuple[str, ...]
Kinds = Mapping[Path, Kind]
FORMAT: Kinds = {  # the keys that exchange needs
    ("started_utc",): TIME,
    ("gear", "serial"): NAME,
    ("gear", "output"): Kind(" or ".join(OUTPUTS), lambda said: said in OUTPUTS),
    ("declared", "J_m"): _between(1e-10, 1e3, "kg·m²"),
    ("declared", "J_l"): _between(1e-9, 1e6, "kg·m²"),
    ("declared", "K"): _between(1e-2, 1e9, "N·m/rad"),
    ("declared", "B_m"): _not_negative("N·m·s/rad"),
    ("declared", "B_ml"): _not_negative("N·m·s/rad"),
    ("declared", "B_l"): _not_negative("N·m·s/rad"),
    ("declared", "B_sp"): _not_negative("N·m·s/rad"),
    ("declared", "fourier_terms"): _between(1, 1000, ""),
    ("conditions", "tau_ext"): _any("N·m"),
    ("conditions", "output_locked"): Kind("true or false", lambda said: isinstance(said, bool)),
    ("conditions", "depth_mm"): _any("mm"),
    ("conditions", "speed_rpm"): _any("rpm"),
    ("conditions", "assembly"): NAME,
    ("conditions", "note"): TEXT,
    ("encoders", "motor_counts_per_rev"): _between(4, 1e12, "counts"),
    ("encoders", "load_counts_per_rev"): _between(4, 1e12, "counts"),
}
OURS: Kinds = {  # what our own runs say besides, and somebody else may mean otherwise
    ("label",): TEXT,
    ("operator",): TEXT,
    ("verdict",): TEXT,
    ("finding",): TEXT,
    ("ended_utc",): TIME,
    ("rows",): COUNT,
    ("rows_expected",): COUNT,
    ("duration",): NUMBER,
    ("limits",): TABLE,
    ("latch_skew",): TABLE,
    ("loop",): TABLE,
    ("loop", "rate"): NUMBER,
    ("loop", "mode"): TEXT,
    ("loop", "clock"): TEXT,
    ("campaign",): TABLE,
    ("campaign", "uid"): TEXT,
    ("campaign", "kind"): TEXT,
    ("campaign", "way"): TEXT,
    ("campaign", "run"): COUNT,
    ("campaign", "session"): COUNT,
    ("campaign", "rig_time_s"): NUMBER,
    ("conditions", "settle_s"): NUMBER,
    ("conditions", "tolerance"): NUMBER,
    ("conditions", "revolutions"): NUMBER,
    ("conditions", "lead_turns"): NUMBER,
    ("conditions", "speeds_rpm"): LIST,
    ("conditions", "feedforward_a"): LIST,
    ("conditions", "feedforward_b"): LIST,
}
ALIKE = 0.75  # of a key and one of the format: "tau_exr" of "tau_ext"
OF_A_FILE: Mapping[str, Kind] = {"sha256": TEXT, "rows": COUNT, "bytes": COUNT}
BARE = ("conditions", "encoders")  # tables whose numbers are read bare, as most write them


def misfits(about: Mapping[str, Any]) -> list[str]:
    """One clause for every value of the manifest `about` that is none: key, value, what was expected. Keys that are
    absent or null, and such as the format does not name, are no misfits."""
    return [*_procedure(about.get("procedure")), *(said for _, said in _wrong(about, FORMAT))]


def misfits_of_ours(about: Mapping[str, Any]) -> list[str]:
    """The same of keys the format does not name, that this program writes."""
    return [said for _, said in _wrong(about, {**OURS, **_of_files(about)})]


def mistyped(about: Mapping[str, Any]) -> Iterator[str]:
    """One clause for every key that nobody reads and that looks like one of the format's."""
    known = {**FORMAT, **OURS}
    for table in sorted({path[0] for path in FORMAT if len(path) > 1}):
        keys = {path[1] for path in known if path[0] == table and len(path) > 1} | {"ratio"}
        said = _at(about, (table,))
        for key in (key for key in said if isinstance(key, str) and key not in keys):
            whole = [name for name in keys if len(key) > 2 and f"_{key}_" in f"_{name}_" and name not in said]
            if close := whole or difflib.get_close_matches(key, sorted(keys - said.keys()), n=1, cutoff=ALIKE):
                yield f"{table}.{key} is no key that is read; did you mean '{close[0]}'?"


def usable(about: Mapping[str, Any]) -> dict[str, Any]:
    """The manifest without those values: what they would say is unknown. Numbers with their unit beside them stand
    bare where most write them so."""
    out = {key: dict(said) if isinstance(said, Mapping) else said for key, said in about.items()}
    if entries := {name: dict(_at(about, ("files", name))) for name in _at(about, ("files",))}:
        out["files"] = entries
    for path, _ in _wrong(about, {**FORMAT, **OURS, **_of_files(about)}):
        _at(out, path[:-1]).pop(path[-1], None)
    for table in (_at(out, (name,)) for name in BARE):
        beside = {key: stated(said) for key, said in table.items() if isinstance(said, Mapping)}
        table.update({key: value for key, value in beside.items() if math.isfinite(value)})
    return out


def notes(clauses: Iterable[str]) -> list[str]:
    """Misfits as sentences of an analysis that goes on without them."""
    return [f"manifest.json: {said}{'' if said.endswith('?') else '.'} It counts as not said." for said in clauses]


def _procedure(said: object) -> Iterator[str]:
    if isinstance(said, str) and said.replace("-", "_") not in KINDS:
        yield f"procedure is {_short(said)}, no kind of run there is; {nearest(said.replace('-', '_'), KINDS)}"


def _of_files(about: Mapping[str, Any]) -> Kinds:
    names = _at(about, ("files",))
    return {("files", name, key): kind for name in names for key, kind in OF_A_FILE.items()}


def _wrong(about: Mapping[str, Any], kinds: Kinds) -> Iterator[tuple[Path, str]]:
    for path, kind in kinds.items():
        said = _at(about, path[:-1]).get(path[-1])
        if said is not None and not kind.fits(said):
            yield path, f"{'.'.join(path)} is {_short(said)}, expected {kind.expected}"


def _at(about: Any, path: Path) -> Any:
    """The table at `path`; an empty one where there is none."""
    for key in path:
        about = about.get(key) if isinstance(about, Mapping) else None
    return about if isinstance(about, Mapping) else {}


def _short(value: object) -> str:
    """As JSON writes it; a number may have more digits than Python prints."""
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError):
        text = f"a {type(value).__name__}"
    return text if len(text) <= 60 else f"{text[:57]}..."
