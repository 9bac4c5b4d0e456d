"""The bench file, read strictly: an error names file, key, value, what was expected and the nearest valid key.

Numbers may be bare (`K = 7160`) or carry unit and provenance:
`K = { value = 7160, unit = "N·m/rad", from = "paper" }`.
Units are compared with the expected one, never converted.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field, ValidationError

from rig.config.quantities import Strict
from rig.config.sections import (
    BusSection,
    ConsoleSection,
    ControlSection,
    DevicesSection,
    EncoderSection,
    GearSection,
    HandSection,
    LimitsSection,
    LoopSection,
    MotorSection,
    PathSection,
    TorqueSensorSection,
)
from rig.config.sentence import sentence
from rig.config.twin import TwinSection
from rig.core.errors import UsageError
from rig.core.toml import read_toml


class BenchFile(Strict):
    """A whole bench file, schema hdrig.bench/1."""

    schema_name: Literal["hdrig.bench/1"] = Field(alias="schema")
    name: str = Field(min_length=1, max_length=64)
    loop: LoopSection
    bus: dict[str, BusSection] = Field(default_factory=dict)
    devices: DevicesSection
    gear: GearSection
    path: PathSection = Field(default_factory=PathSection)
    motor: MotorSection
    load_encoder: EncoderSection | None = None
    torque_sensor: TorqueSensorSection | None = None
    limits: LimitsSection
    control: ControlSection
    console: ConsoleSection = Field(default_factory=ConsoleSection)
    hand: HandSection | None = None
    twin: TwinSection | None = None


def read_bench(text: str, source: str) -> BenchFile:
    """The bench file in `text`; `source` is what errors call it. Raises UsageError, one sentence."""
    raw = read_toml(text, source)
    try:
        return BenchFile.model_validate(raw)
    except ValidationError as error:
        raise UsageError(f"{source}: {sentence(error, BenchFile)}") from None
