"""The plan of a campaign, read strictly: an error names file, key, value, what was expected, the nearest valid key."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import tomlkit
from pydantic import Field, ValidationError

from rig.config.quantities import Strict
from rig.config.sentence import sentence
from rig.config.text_file import load_text
from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.core.toml import read_toml

PLANS = Path(__file__).parents[1] / "plans"  # plans that ship with hdrig
Moment = Literal["start", "middle", "end"]
NewtonMetres = Annotated[float, Field(json_schema_extra={"unit": "N·m"}, allow_inf_nan=False)]


class StepSection(Strict):
    """[[step]]: one procedure (or sweep) with its parameters, and what the rig must be like for it."""

    procedure: str
    parameters: dict[str, Any] = Field(alias="with", default_factory=dict)
    repeats: int = Field(default=1, ge=1, le=100)
    weight: NewtonMetres = 0.0  # on the load, positive drives it forward
    depth_mm: float | None = Field(default=None, allow_inf_nan=False)  # None: as the step before
    reassemble: bool = False  # take the wave generator out and fit it again before it, whatever the depth
    allow_resonance: bool = False
    note: str = ""
    way: Literal["up", "down"] | None = None  # of a sweep that goes both ways, for its manifest


class SentinelSection(StepSection):
    """[sentinel]: the same run again and again, so that drift is told from what a step does."""

    procedure: str = "sentinel"
    at: list[Moment] = Field(default=["start", "middle", "end"], min_length=1)


class PlanFile(Strict):
    """A whole plan, schema hdrig.plan/1."""

    schema_name: Literal["hdrig.plan/1"] = Field(alias="schema")
    name: str = Field(min_length=1, max_length=40, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")
    title: str = ""
    order: Literal["as-written", "random"] = "as-written"
    on_failure: Literal["stop", "continue"] = "stop"
    order_2_arcmin: Annotated[float, Field(json_schema_extra={"unit": "arcmin"}, gt=0, le=60)] = (
        1.0  # arcmin, zero to peak, for predictions: twice what a catalogue's 1 arcmin peak to peak can hold
    )
    warm_up: StepSection | None = None  # before everything else, on a bare rig
    sentinel: SentinelSection | None = None
    step: list[StepSection] = Field(min_length=1)


@dataclass(frozen=True)
class Plan:
    """One plan, read."""

    file: PlanFile
    text: str
    source: str

    @property
    def sha256(self) -> str:
        """Of its text."""
        return digest(self.text)


def digest(text: str) -> str:
    """SHA-256 of a configuration's text."""
    return hashlib.sha256(text.encode()).hexdigest()


def read_plan(source: str) -> Plan:
    """The plan called `source`: a file, or the name of one that ships. Raises UsageError, one sentence."""
    path = Path(source) if source.endswith(".toml") or "/" in source else PLANS / f"{source}.toml"
    known = [p.stem for p in PLANS.glob("*.toml")]
    if path.parent == PLANS and path.stem not in known:
        raise UsageError(f"no plan called '{source}'; {nearest(source, known)}; or give the path of a .toml file")
    return parse_plan(load_text(path), str(path))


def plan_of(procedure: str, parameters: Mapping[str, Any]) -> Plan:
    """The plan of one step, for a sweep asked for by name."""
    step = {"procedure": procedure, "with": dict(parameters)}
    text = tomlkit.dumps({"schema": "hdrig.plan/1", "name": procedure, "step": [step]})
    return parse_plan(text, f"run {procedure}")  # no name of a plan that ships


def parse_plan(text: str, source: str) -> Plan:
    """The plan in `text`; `source` is what errors call it. Raises UsageError."""
    raw = read_toml(text, source)
    try:
        return Plan(PlanFile.model_validate(raw), text, source)
    except ValidationError as error:
        raise UsageError(f"{source}: {sentence(error, PlanFile)}") from None
