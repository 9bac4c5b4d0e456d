"""The bench file, read strictly: an error names file, key, value, what was expected and the nearest valid key.

Numbers may be bare (`K = 7160`) or carry unit and provenance:
`K = { value = 7160, unit = "N·m/rad", from = "paper" }`.
Units are compared with the expected one, never converted.
"""

from __future__ import annotations

import tomllib
from datetime import date
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field, ValidationError, model_validator

from rig.config.effects import EffectsSection
from rig.config.quantities import NotNegative, Positive, quantity
from rig.config.quantities import Strict as Strict  # these two also for readers of other files of the same kind
from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.core.regular import regular

LONGEST = 2**20  # bytes: the longest bench that ships has under 20 000


class LoopSection(Strict):
    """[loop]"""

    rate: Annotated[float, quantity("Hz", ge=10, le=10_000)]
    speed_filter: Annotated[float, quantity("s", **Positive)]
    latch_lead: Annotated[float, quantity("s", **NotNegative)] = 0.0  # SYNC goes out so long before the tick


class BusSection(Strict):
    """[bus.NAME]: a CAN bus, under python-can's name for its interface."""

    interface: str = Field(min_length=1)
    channel: str = Field(min_length=1)
    bitrate: Annotated[int | None, quantity("bit/s", gt=0, le=8_000_000)] = None
    host_node: int = Field(default=127, ge=0, le=127)  # CANopen number of this host; 0: it sends no heartbeat
    options: dict[str, str | int | float | bool] = Field(default_factory=dict)  # handed to python-can as they are


class DeviceSection(Strict):
    """[devices.*]: which driver, and where the device is; which keys are needed depends on the driver."""

    type: str
    bus: str | None = None  # [bus.NAME] it is on
    node: int | None = Field(default=None, ge=0, le=127)
    port: str | None = None  # serial port
    baud: Annotated[int | None, quantity("bit/s", gt=0)] = None
    direction: Literal[1, -1] = 1  # -1 turns the sign of its readings (and commands) over
    watchdog: Annotated[float | None, quantity("s", ge=0.01, le=10)] = None  # the drive stops this long after its host
    torque_constant: Annotated[float | None, quantity("N·m/A", **Positive)] = None  # where a drive tells current only
    rated_step: Annotated[float | None, quantity("N·m", gt=0, le=1)] = None  # of 6076h, where that is not mN·m
    unit_code: int | None = Field(default=None, ge=0, lt=2**32)  # what 6131h holds when it means N·m, by its manual
    delay: Annotated[float, quantity("s", ge=0, le=1)] = 0.0  # from latching to arrival, where the device cannot say

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
    N: Annotated[float, quantity("1", gt=1, le=1000)]
    K: Annotated[float, quantity("N·m/rad", **Positive)]
    J_m: Annotated[float, quantity("kg·m²", **Positive)]
    J_l: Annotated[float, quantity("kg·m²", **Positive)]
    B_m: Annotated[float, quantity("N·m·s/rad", **NotNegative)]
    B_ml: Annotated[float, quantity("N·m·s/rad", **NotNegative)]
    B_l: Annotated[float, quantity("N·m·s/rad", **NotNegative)]
    B_sp: Annotated[float, quantity("N·m·s/rad", **NotNegative)]
    fourier_terms: Annotated[int, quantity("1", ge=1, le=100)]
    tau_c: Annotated[float, quantity("N·m", **NotNegative)] = 0.0  # Coulomb friction of the whole rig, at the motor
    T_rated: Annotated[float | None, quantity("N·m", **Positive)] = None  # maker's rated torque at the output
    T1: Annotated[float | None, quantity("N·m", **Positive)] = None  # where the maker's K1 ends
    T2: Annotated[float | None, quantity("N·m", **Positive)] = None  # and his K2


class PathSection(Strict):
    """[path]: what lies in series with the gear between motor encoder and lock, where it is known."""

    K_sensor: Annotated[float | None, quantity("N·m/rad", **Positive)] = None
    K_coupling: Annotated[float | None, quantity("N·m/rad", **Positive)] = None
    K_fixture: Annotated[float | None, quantity("N·m/rad", **Positive)] = None


class MotorSection(Strict):
    """[motor]"""

    torque_rated: Annotated[float, quantity("N·m", **Positive)]
    torque_limit: Annotated[float, quantity("N·m", **Positive)]
    counts_per_turn: Annotated[int, quantity("counts", gt=0, le=2**40)]


class LatchedSection(Strict):
    """A channel whose latch skew `hdrig run skew` has measured: both numbers, or neither."""

    skew: Annotated[float | None, quantity("s", ge=-0.1, le=0.1)] = None
    skew_half_width: Annotated[float | None, quantity("s", ge=0, le=0.1)] = None  # of its 95 % interval

    @model_validator(mode="after")
    def _both(self) -> LatchedSection:
        if (self.skew is None) is not (self.skew_half_width is None):
            raise ValueError("skew and skew_half_width belong together: a skew without its interval is no measurement")
        return self


class EncoderSection(LatchedSection):
    """[load_encoder]; `skew`: latched so much later than the motor angle"""

    counts_per_turn: Annotated[int, quantity("counts", gt=0, le=2**40)]
    calibrated: date | None = None
    calibration_due: date | None = None


class TorqueSensorSection(LatchedSection):
    """[torque_sensor]; `skew`: latched so much later than the load angle"""

    range: Annotated[float, quantity("N·m", **Positive)]
    calibrated: date | None = None
    calibration_due: date | None = None


class LimitsSection(Strict):
    """[limits]: what the guard holds every run to."""

    speed_rpm: Annotated[float, quantity("rpm", **Positive)]
    torque: Annotated[float, quantity("N·m", **Positive)]
    shaft_torque: Annotated[float, quantity("N·m", **Positive)]
    travel_turns: Annotated[float, quantity("turns", **Positive)]
    following_deg: Annotated[float, quantity("deg", **Positive)]
    following_s: Annotated[float, quantity("s", **NotNegative)]
    twist_deg: Annotated[float, quantity("deg", **Positive)]
    stale_s: Annotated[float, quantity("s", **Positive, le=1)]  # a motor at 600 rpm turns ten times in a second


class HandSection(Strict):
    """[hand]: of a twin in another process; a person is the hand of every other bench."""

    control: str = Field(min_length=1)  # socket of the twin's command channel


class ControlSection(Strict):
    """[control]: gains of the host's position loop, motor side; `mode` says which loop the drive closes by itself."""

    mode: Literal["torque", "velocity", "position"] = "torque"

    Kp: Annotated[float, quantity("N·m/rad", **NotNegative)]
    Ki: Annotated[float, quantity("N·m/(rad·s)", **NotNegative)]
    Kd: Annotated[float, quantity("N·m·s/rad", **NotNegative)]
    integrator_limit: Annotated[float, quantity("N·m", **NotNegative)]
    feedforward: Annotated[float, quantity("N·m·s/rad", **NotNegative)]


class ConsoleSection(Strict):
    """[console]: what becomes of a run whose page is lost, chosen beforehand. For `hdrig serve` alone."""

    page_lost: Literal["continue", "stop"] = "stop"  # stop: category 1, brought to rest, torque off
    page_lost_s: Annotated[float, quantity("s", ge=0.5, le=3600)] = 3.0  # without a sign of life of any page


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
    tau_c: Annotated[float, quantity("N·m", **NotNegative)]
    tau_s: Annotated[float, quantity("N·m", **NotNegative)]
    omega_s: Annotated[float, quantity("rad/s", **Positive)]
    F_cl: Annotated[float, quantity("N·m", **NotNegative)]
    friction_noise: Annotated[float, quantity("1", ge=0, le=0.3)]
    friction_noise_s: Annotated[float, quantity("s", ge=0.001, le=1e6)]
    tau_drive: Annotated[float, quantity("s", **NotNegative)]
    torque_resolution: Annotated[float, quantity("N·m", **NotNegative)]
    torque_noise: Annotated[float, quantity("N·m", **NotNegative)]
    watchdog: Annotated[float, quantity("s", **Positive)]
    sensor_noise: Annotated[float, quantity("N·m", **NotNegative)]
    sensor_zero: Annotated[float, quantity("N·m", allow_inf_nan=False)]
    sensor_lowpass_hz: Annotated[float, quantity("Hz", **Positive)]
    sensor_resolution: Annotated[float, quantity("N·m", **NotNegative)]
    latch_m: Annotated[float, quantity("s", **NotNegative)]
    latch_l: Annotated[float, quantity("s", **NotNegative)]
    latch_tau: Annotated[float, quantity("s", **NotNegative)]
    kinematic_error: TwinKinematicError
    effects: EffectsSection = EffectsSection()


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
    try:
        raw = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also numbers of thousands of digits, and endless nesting
        raise UsageError(f"{source} is not valid TOML: {str(error).splitlines()[0]}") from None
    try:
        return BenchFile.model_validate(raw)
    except ValidationError as error:
        raise UsageError(f"{source}: {sentence(error, BenchFile)}") from None


def load_text(path: Path) -> str:
    """The text of a configuration file, which is a regular file: a device or a pipe never ends. Raises UsageError."""
    try:
        if regular(path).st_size > LONGEST:
            raise UsageError(f"{path} is no text file of at most {LONGEST // 2**20} MiB; expected a TOML file")
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"{path} is not UTF-8 text; expected a TOML file") from None
    except OSError as error:
        raise UsageError(f"cannot read {str(path)[:200]}: {error.strerror}") from None
    except ValueError:  # a zero byte, or half a character
        raise UsageError(f"{str(path)[:200]!a} is no name of a file") from None


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
