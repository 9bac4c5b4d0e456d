"""Real devices, one per file. The catalogue: device type in the bench file → "module:class"."""

CATALOGUE: dict[str, str] = {
    "can.cia402": "drivers.cia402:Cia402",
    "can.cia406": "drivers.cia406:Cia406",
    "can.cia404": "drivers.cia404:Cia404",
    "can.odrive": "drivers.odrive:ODrive",
    "serial.qsb": "drivers.qsb:Qsb",
    "serial.ascii_torque": "drivers.ascii_torque:AsciiTorque",
}

NO_PROFILE = -1  # in the place of a CiA number: an axis that speaks CANSimple
PROFILES: dict[int, tuple[str, str]] = {  # CiA profile → (role on a bench, device type)
    NO_PROFILE: ("drive", "can.odrive"),
    402: ("drive", "can.cia402"),
    406: ("load_encoder", "can.cia406"),
    404: ("torque_sensor", "can.cia404"),
}
