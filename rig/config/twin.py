"""The section of a bench file that the twin alone has: what the simulated plant is."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from rig.config.effects import EffectsSection
from rig.config.quantities import NotNegative, Positive, Strict, quantity


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
