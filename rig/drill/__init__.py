"""Every fault of bus and devices, in every phase of a run, on virtual time: how long until the torque is off."""
