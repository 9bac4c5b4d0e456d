"""A serial port that nobody read for a while: what it kept is old, and passes for nothing new."""

from __future__ import annotations

import os
import time
import tty

import pytest

from drivers import port
from drivers.ascii_torque import AsciiTorque
from drivers.wiring import Place, Wiring
from rig.core.clock import WallClock


def test_what_a_port_kept_while_nobody_read_it_is_not_told_as_a_reading_of_now(monkeypatch: pytest.MonkeyPatch):
    """It was stamped with the time of the look, 4 kB a look: seconds of it came as five new readings."""
    monkeypatch.setattr(port, "UNREAD", 0.05)
    master, slave = os.openpty()
    tty.setraw(slave)
    place = Place("torque_sensor", {"port": os.ttyname(slave), "baud": 115200}, range=50.0)
    sensor = AsciiTorque(Wiring(WallClock()), place)
    sensor.port.open()
    os.write(master, b"1.00 Nm\r\n1.00 Nm\r\n")
    while sensor.read().tau != 1.0:
        time.sleep(0.001)
    os.write(master, b"2.00 Nm\r\n" * 300 + b"2.0")
    time.sleep(0.1)  # nobody reads
    before = sensor.read()
    assert before.tau == 1.0
    os.write(master, b"3.00 Nm\r\n4.00 Nm\r\n")
    until = time.monotonic() + 5.0
    seen = {before.tau}
    while sensor.read().tau != 4.0 and time.monotonic() < until:
        seen.add(sensor.read().tau)
        time.sleep(0.001)
    assert sensor.read().tau == 4.0
    assert not seen & {2.0, 2.03}
    sensor.close()
    os.close(master)
    os.close(slave)
