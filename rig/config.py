"""The bench file, read strictly: an error names file, key, value, what was expected and the nearest valid key.

Numbers may be bare (`K = 7160`) or carry unit and provenance:
`K = { value = 7160, unit = "N·m/rad", from = "paper" }`.
Units are compared with the expected one, never converted.
"""

from __future__ import annotations

import difflib
import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from rig.core.errors import UsageError

PROVENANCE = ("paper", "catalogue", "assumed", "measured", "declared")
QUANTITY_KEYS = {"value", "unit", "from", "note"}
LARGEST = 10**300  # an integer beyond this is no measurement
PLAIN_UNITS = {"N.m": "N·m", "Nm": "N·m", "kg.m2": "kg·m²", "kg m^2": "kg·m²"}  # spellings of the same unit


def _quantity(unit: str, **limits: Any) -> Any:
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


class LoopSection(Strict):
    """[loop]"""

    rate: Annotated[float, _quantity("Hz", ge=10, le=10_000)]
    speed_filter: Annotated[float, _quantity("s", **Positive)]
    latch_lead: Annotated[float, _quantity("s", **NotNegative)] = 0.0  # SYNC goes out so long before the tick


class BusSection(Strict):
    """[bus.NAME]: a CAN bus, under python-can's name for its interface."""

    interface: str = Field(min_length=1)
    channel: str = Field(min_length=1)
    bitrate: Annotated[int | None, _quantity("bit/s", gt=0, le=8_000_000)] = None
    host_node: int = Field(default=127, ge=0, le=127)  # CANopen number of this host; 0: it sends no heartbeat
    options: dict[str, str | int | float | bool] = {}  # handed to python-can as they are


class DeviceSection(Strict):
    """[devices.*]: which driver, and where the device is; which keys are needed depends on the driver."""

    type: str
    bus: str | None = None  # [bus.NAME] it is on
    node: int | None = Field(default=None, ge=1, le=127)
    port: str | None = None  # serial port
    baud: Annotated[int | None, _quantity("bit/s", gt=0)] = None
    direction: Literal[1, -1] = 1  # -1 turns the sign of its readings (and commands) over
    watchdog: Annotated[float, _quantity("s", ge=0.01, le=10)] = 0.1  # the drive stops after this without its host
    delay: Annotated[float, _quantity("s", ge=0, le=1)] = 0.0  # from latching to arrival, where the device cannot say

    def options(self) -> dict[str, Any]:
        """For the driver: the keys as they are, without those not given."""
        return {key: value for key, value in self.model_dump().items() if value is not None}


class DevicesSection(Strict):
    """[devices]: a drive always; the other two where the bench has them."""

    drive: DeviceSection
    load_encoder: DeviceSection | None = None
    torque_sensor: DeviceSection | None = None


class GearSection(Strict):
    """[gear]: declared numbers of the gear and the two inertias."""

    serial: str = Field(min_length=1, max_length=64)
    output: Literal["flexspline", "circular_spline"]
    N: Annotated[float, _quantity("1", gt=1, le=1000)]
    K: Annotated[float, _quantity("N·m/rad", **Positive)]
    J_m: Annotated[float, _quantity("kg·m²", **Positive)]
    J_l: Annotated[float, _quantity("kg·m²", **Positive)]
    B_m: Annotated[float, _quantity("N·m·s/rad", **NotNegative)]
    B_ml: Annotated[float, _quantity("N·m·s/rad", **NotNegative)]
    B_l: Annotated[float, _quantity("N·m·s/rad", **NotNegative)]
    B_sp: Annotated[float, _quantity("N·m·s/rad", **NotNegative)]
    fourier_terms: Annotated[int, _quantity("1", ge=1, le=100)]


class MotorSection(Strict):
    """[motor]"""

    torque_rated: Annotated[float, _quantity("N·m", **Positive)]
    torque_limit: Annotated[float, _quantity("N·m", **Positive)]
    counts_per_turn: Annotated[int, _quantity("counts", gt=0, le=2**40)]


class EncoderSection(Strict):
    """[load_encoder]"""

    counts_per_turn: Annotated[int, _quantity("counts", gt=0, le=2**40)]


class TorqueSensorSection(Strict):
    """[torque_sensor]"""

    range: Annotated[float, _quantity("N·m", **Positive)]


class LimitsSection(Strict):
    """[limits]: what the guard holds every run to."""

    speed_rpm: Annotated[float, _quantity("rpm", **Positive)]
    torque: Annotated[float, _quantity("N·m", **Positive)]
    shaft_torque: Annotated[float, _quantity("N·m", **Positive)]
    travel_turns: Annotated[float, _quantity("turns", **Positive)]
    following_deg: Annotated[float, _quantity("deg", **Positive)]
    following_s: Annotated[float, _quantity("s", **NotNegative)]
    twist_deg: Annotated[float, _quantity("deg", **Positive)]
    stale_s: Annotated[float, _quantity("s", **Positive)]


class ControlSection(Strict):
    """[control]: gains of the host's position loop, motor side."""

    Kp: Annotated[float, _quantity("N·m/rad", **NotNegative)]
    Ki: Annotated[float, _quantity("N·m/(rad·s)", **NotNegative)]
    Kd: Annotated[float, _quantity("N·m·s/rad", **NotNegative)]
    integrator_limit: Annotated[float, _quantity("N·m", **NotNegative)]
    feedforward: Annotated[float, _quantity("N·m·s/rad", **NotNegative)]


class TwinKinematicError(Strict):
    """[twin.kinematic_error]: C_n cos(n·θ_m − ψ_n), orders 1 to k."""

    provenance: str = Field(alias="from", default="declared")
    note: str = ""
    C_deg: list[Annotated[float, Field(allow_inf_nan=False)]] = Field(min_length=1)
    psi_deg: list[Annotated[float, Field(allow_inf_nan=False)]] = Field(min_length=1)

    @model_validator(mode="before")
    @classmethod
    def _floats(cls, raw: Any) -> Any:
        """Whole numbers will do; what is no number is left for the field to refuse."""
        if not isinstance(raw, dict):
            return raw
        lists = {k: raw[k] for k in ("C_deg", "psi_deg") if isinstance(raw.get(k), list)}
        return {**raw, **{k: [float(x) if type(x) is int else x for x in xs] for k, xs in lists.items()}}

    @model_validator(mode="after")
    def _same_length(self) -> TwinKinematicError:
        if len(self.C_deg) != len(self.psi_deg):
            raise ValueError(
                f"{len(self.C_deg)} amplitudes C_deg and {len(self.psi_deg)} phases psi_deg: expected as many"
            )
        return self


class TwinSection(Strict):
    """[twin]: what the simulated plant has; the analysis is never told."""

    seed: int = Field(ge=0)
    tau_c: Annotated[float, _quantity("N·m", **NotNegative)]
    tau_s: Annotated[float, _quantity("N·m", **NotNegative)]
    omega_s: Annotated[float, _quantity("rad/s", **Positive)]
    F_cl: Annotated[float, _quantity("N·m", **NotNegative)]
    friction_noise: Annotated[float, _quantity("1", ge=0, le=0.3)]
    friction_noise_s: Annotated[float, _quantity("s", ge=0.001, le=1e6)]
    tau_drive: Annotated[float, _quantity("s", **NotNegative)]
    torque_resolution: Annotated[float, _quantity("N·m", **NotNegative)]
    torque_noise: Annotated[float, _quantity("N·m", **NotNegative)]
    watchdog: Annotated[float, _quantity("s", **Positive)]
    sensor_noise: Annotated[float, _quantity("N·m", **NotNegative)]
    sensor_zero: Annotated[float, _quantity("N·m", allow_inf_nan=False)]
    sensor_lowpass_hz: Annotated[float, _quantity("Hz", **Positive)]
    sensor_resolution: Annotated[float, _quantity("N·m", **NotNegative)]
    latch_m: Annotated[float, _quantity("s", **NotNegative)]
    latch_l: Annotated[float, _quantity("s", **NotNegative)]
    latch_tau: Annotated[float, _quantity("s", **NotNegative)]
    kinematic_error: TwinKinematicError


class BenchFile(Strict):
    """A whole bench file, schema hdrig.bench/1."""

    schema_name: Literal["hdrig.bench/1"] = Field(alias="schema")
    name: str = Field(min_length=1, max_length=64)
    loop: LoopSection
    bus: dict[str, BusSection] = {}
    devices: DevicesSection
    gear: GearSection
    motor: MotorSection
    load_encoder: EncoderSection | None = None
    torque_sensor: TorqueSensorSection | None = None
    limits: LimitsSection
    control: ControlSection
    twin: TwinSection | None = None


def read_bench(text: str, source: str) -> BenchFile:
    """The bench file in `text`; `source` is what errors call it. Raises UsageError, one sentence."""
    try:
        raw = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also numbers of thousands of digits, and endless nesting
        raise UsageError(f"{source} is not valid TOML: {str(error).splitlines()[0]}") from None
    try:
        return BenchFile.model_validate(raw)
    except ValidationError as error:
        raise UsageError(f"{source}: {sentence(error, BenchFile)}") from None


def load_text(path: Path) -> str:
    """The text of a configuration file. Raises UsageError."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"{path} is not UTF-8 text; expected a TOML file") from None
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from None


def nearest(wrong: str, valid: Any) -> str:
    """ "did you mean 'x'?", or the list of what exists."""
    names = sorted(valid)
    close = difflib.get_close_matches(wrong, names, n=1, cutoff=0.5)
    return f"did you mean '{close[0]}'?" if close else f"expected one of {', '.join(names)}"


def sentence(error: ValidationError, model: type[BaseModel]) -> str:
    """The first complaint of pydantic as one sentence: key, value, what was expected, nearest valid key."""
    found = error.errors(include_url=False)
    first = next((e for e in found if e["type"] == "extra_forbidden"), found[0])  # a typo also shows as a missing key
    path = [str(p) for p in first["loc"]]
    key = ".".join(path) or "the file"
    match first["type"]:
        case "extra_forbidden":
            return f"unknown key '{key}'; {nearest(path[-1], _keys_beside(model, path))}"
        case "missing":
            unit = _unit_note(model, path).strip()
            return f"'{key}' is missing" + (f"; expected a number in {unit}" if unit else "")
        case "value_error":
            return f"{'.'.join(path)}: {first['ctx']['error']}" if path else str(first["ctx"]["error"])
        case _:
            expected = first["msg"].removeprefix("Input should be ")
            shown = repr(first["input"])
            shown = shown if len(shown) <= 60 else shown[:57] + "..."
            return f"{key} = {shown}{_unit_note(model, path)}: expected {expected}"


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
