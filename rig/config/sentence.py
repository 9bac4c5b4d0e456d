"""What pydantic refuses as one sentence: key, value, what was expected, the nearest valid key."""

from __future__ import annotations

import math

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from rig.core.nearest import nearest

WORDS = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
    "dict_type": "a table",
}  # what pydantic calls by Python's names
BOUNDS = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
NUMBERS = ("float_type", "float_parsing", "int_type", "int_from_float")


def sentence(error: ValidationError, model: type[BaseModel]) -> str:
    """The first complaint of pydantic as one sentence: key, value, what was expected, nearest valid key."""
    found = error.errors(include_url=False)
    first = next((e for e in found if e["type"] == "extra_forbidden"), found[0])  # a typo also shows as a missing key
    path = [str(p + 1 if isinstance(p, int) else p) for p in first["loc"]]  # people count from 1
    key = ".".join(path) or "the file"
    match first["type"]:
        case "extra_forbidden":
            return f"unknown key '{key}'; {nearest(path[-1], _keys_beside(model, path))}"
        case "missing":
            unit = _unit_note(model, path).strip()
            return f"'{key}' is missing" + (f"; expected a number in {unit}" if unit else "")
        case "value_error":
            return f"{'.'.join(path)}: {first['ctx']['error']}" if path else str(first["ctx"]["error"])
        case "model_type":
            keys = ", ".join(_keys_beside(model, [*path, ""])[:3])
            return f"{key} = {_shown(first['input'])}: expected a table of keys such as {keys}"
        case kind:
            expected = WORDS.get(kind) or _expected(first)
            unit = _unit_note(model, path)
            of_value = unit if type(first["input"]) in (int, float) else ""  # text may have one of its own
            of_bound = unit if kind in BOUNDS else " in" * bool(unit) + unit if kind in NUMBERS else ""
            return f"{key} = {_shown(first['input'])}{of_value}: expected {expected}{of_bound}"


def _shown(given: object) -> str:
    """A value as TOML writes it, not too long."""
    text = str(given).lower() if isinstance(given, bool) else repr(given)
    return text if len(text) <= 60 else text[:57] + "..."


def _expected(first: ErrorDetails) -> str:
    """What pydantic wanted, to stand behind "expected": of no number it names the limit that it is not within."""
    if isinstance(first["input"], float) and not math.isfinite(first["input"]):
        return "a finite number"
    if first["type"] == "too_short":
        return f"a list of {first['ctx']['min_length']} or more"
    said = first["msg"].removeprefix("Input should be ")
    return said.replace("String should have", "a text of").replace("String should match", "a text that matches")


def _model_at(model: type[BaseModel], path: list[str]) -> type[BaseModel]:
    """The model that holds the last key of `path`."""
    for part in path[:-1]:
        field = model.model_fields.get(part)
        options = getattr(field.annotation, "__args__", (field.annotation,)) if field else ()
        inner = [o for o in options if isinstance(o, type) and issubclass(o, BaseModel)]
        if not inner:
            break
        model = inner[0]
    return model


def _keys_beside(model: type[BaseModel], path: list[str]) -> list[str]:
    return [f.alias or name for name, f in _model_at(model, path).model_fields.items()]


def _unit_note(model: type[BaseModel], path: list[str]) -> str:
    field = _model_at(model, path).model_fields.get(path[-1]) if path else None
    unit = (field.json_schema_extra or {}).get("unit") if field else None  # type: ignore[union-attr]
    return f" {unit}" if unit and unit != "1" else ""
