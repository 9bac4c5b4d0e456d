"""Whether the sensors' calibrations are known and still hold."""

from __future__ import annotations

from datetime import UTC, date, datetime

from rig.bench import Bench
from rig.doctor.finding import Finding, Health


def check_calibration(bench: Bench) -> list[Finding]:
    """`calibrated` and `calibration_due` of the torque sensor and the load encoder."""
    today = datetime.now(UTC).date()
    sections = {"torque sensor": bench.file.torque_sensor, "load encoder": bench.file.load_encoder}
    return [
        judge(what, section.calibrated, section.calibration_due, today)
        for what, section in sections.items()
        if section is not None
    ]


def judge(what: str, made: date | None, due: date | None, today: date) -> Finding:
    """One sensor."""
    name = f"calibration of the {what}"
    if made is None:
        return Finding(
            name, Health.DOUBTFUL, "no date in the bench file (key `calibrated`): its scale is taken on trust"
        )
    if due is not None and due < today:
        return Finding(name, Health.BAD, f"made on {made}, expired on {due}")
    until = f"valid until {due}" if due else "no date of expiry (key `calibration_due`)"
    return Finding(name, Health.GOOD if due else Health.DOUBTFUL, f"made on {made}, {until}")
