"""The sections of a bench file that a real rig has, one class each."""

from __future__ import annotations

from datetime import date
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from rig.config.quantities import NotNegative, Positive, Strict, quantity


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
    """[limits]: what the guard holds every run to. One that no rig can reach is a slip of unit."""

    speed_rpm: Annotated[float, quantity("rpm", **Positive, le=20_000)]
    torque: Annotated[float, quantity("N·m", **Positive, le=1000)]
    shaft_torque: Annotated[float, quantity("N·m", **Positive, le=100_000)]
    travel_turns: Annotated[float, quantity("turns", **Positive, le=1e6)]
    following_deg: Annotated[float, quantity("deg", **Positive, le=720)]
    following_s: Annotated[float, quantity("s", **NotNegative, le=10)]
    twist_deg: Annotated[float, quantity("deg", **Positive, le=30)]
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
