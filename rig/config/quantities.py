"""Numbers in TOML, read strictly: unit and provenance beside the value, checked and taken off.

`K = 7160`, or `K = { value = 7160, unit = "N·m/rad", from = "paper" }`. Units are compared, never converted.
"""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, Field, model_validator

from rig.core.nearest import nearest

PROVENANCE = ("paper", "catalogue", "assumed", "measured", "declared")
QUANTITY_KEYS = {"value", "unit", "from", "note"}
LARGEST = 10**300  # an integer beyond this is no measurement
PLAIN_UNITS = {"N.m": "N·m", "Nm": "N·m", "kg.m2": "kg·m²", "kg m^2": "kg·m²"}  # spellings of the same unit


def quantity(unit: str, **limits: Any) -> Any:
    """A field that is a number in `unit`, within pydantic's `limits`."""
    return Field(json_schema_extra={"unit": unit}, **limits)


Positive = {"gt": 0, "allow_inf_nan": False}
NotNegative = {"ge": 0, "allow_inf_nan": False}


class Strict(BaseModel):
    """Unknown keys and wrong units are refused; values do not change once read."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    @model_validator(mode="before")
    @classmethod
    def _strip_quantities(cls, raw: Any) -> Any:
        return {k: cls._plain(k, v) for k, v in raw.items()} if isinstance(raw, dict) else raw

    @classmethod
    def _plain(cls, key: str, raw: Any) -> Any:
        field = cls.model_fields.get(key)
        wanted = (field.json_schema_extra or {}).get("unit") if field else None  # type: ignore[union-attr]
        if wanted is None:
            return raw
        value = raw
        if isinstance(raw, dict):
            for other in raw.keys() - QUANTITY_KEYS:
                raise ValueError(f"unknown key '{other}' in {key}; {nearest(other, QUANTITY_KEYS)}")
            if "value" not in raw:
                raise ValueError(f'{key} has no value; expected {{ value = …, unit = "{wanted}", from = … }}')
            unit = raw.get("unit", wanted)
            if not isinstance(unit, str) or PLAIN_UNITS.get(unit, unit) != wanted:
                raise ValueError(f"{key} = {raw['value']} {unit}: expected the unit {wanted}")
            if raw.get("from", "declared") not in PROVENANCE:
                raise ValueError(f"{key} is from '{raw['from']}'; expected one of {', '.join(PROVENANCE)}")
            value = raw["value"]
        if field is not None and field.annotation is float and isinstance(value, int) and not isinstance(value, bool):
            if abs(value) > LARGEST:
                raise ValueError(f"{key} has {len(str(abs(value)))} digits; expected a number in {wanted}")
            return float(value)
        return value
