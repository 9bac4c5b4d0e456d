"""What a run's manifest says of the bench."""

from __future__ import annotations

from typing import Any

from rig.config.bench_file import BenchFile


def manifest_of(f: BenchFile, simulated: bool) -> dict[str, Any]:
    """The bench's part of a run's manifest."""
    encoders = {"motor_counts_per_rev": f.motor.counts_per_turn}
    if f.load_encoder:
        encoders["load_counts_per_rev"] = f.load_encoder.counts_per_turn
    gear = {"ratio": f.gear.N, "output": f.gear.output, "serial": f.gear.serial}
    keys = ("J_m", "J_l", "K", "B_m", "B_ml", "B_l", "B_sp", "fourier_terms")
    declared = {key: getattr(f.gear, key) for key in keys}
    optional = {key: getattr(f.gear, key) for key in ("T_rated", "T1", "T2")} | f.path.model_dump()
    declared |= {key: value for key, value in optional.items() if value is not None}
    backend = "sim" if simulated else f.devices.drive.type.partition(".")[0]
    own = {"backend": backend, "bench": f.name, "gear": gear, "declared": declared, "encoders": encoders}
    return own | ({"latch_skew": skew} if (skew := _latch_skew(f)) else {})


def _latch_skew(f: BenchFile) -> dict[str, dict[str, float]]:
    """What `hdrig run skew` has measured on this bench, of the channels where it has; s."""
    sections = {"theta_l": f.load_encoder, "tau_l": f.torque_sensor}
    return {
        channel: {"value": section.skew, "half_width": section.skew_half_width}
        for channel, section in sections.items()
        if section is not None and section.skew is not None and section.skew_half_width is not None
    }
