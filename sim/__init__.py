"""The twin: a rig that is not there. The catalogue: device type in the bench file → "module:class", made of a World."""

CATALOGUE: dict[str, str] = {
    "twin.drive": "sim.drive:TwinDrive",
    "twin.load_encoder": "sim.sensors:TwinLoadEncoder",
    "twin.torque_sensor": "sim.sensors:TwinTorqueSensor",
}
