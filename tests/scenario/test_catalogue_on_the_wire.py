"""Every procedure of the catalogue over frames: real drivers, the twin's nodes, virtual time, shortened."""

from __future__ import annotations

import math

import pytest

from rig.core.channels import Flag
from rig.core.procedure import Procedure
from rig.procedures import CATALOGUE
from rig.procedures.speed_convergence import SpeedConvergence
from sim.wire.states402 import DriveState
from tests.contract.test_procedures import made
from tests.drivers.running import run
from tests.drivers.virtual import Driven, Wired, odriven, wired

pytestmark = [pytest.mark.slow, pytest.mark.long]
SHORTEST = {"speed-convergence": SpeedConvergence(amplitude_deg=360.0, speeds_rpm="120,80,60", least=4.0)}
STALE = Flag.STALE_M | Flag.STALE_L | Flag.STALE_TAU
AGAIN = [name for name in CATALOGUE if name in ("sign-and-scale", "stiffness-lock", "coast-down")]


def ready(w: Wired | Driven, procedure: Procedure) -> Wired | Driven:
    """Connected, with the lock pin as the procedure needs it."""
    w.instruments.connect()
    world = w.wire.assembly.world
    world.advance_to(w.wire.now())
    if procedure.output_locked:
        world.lock_output()
    return w


@pytest.mark.parametrize("name", CATALOGUE)
def test_it_completes_over_canopen_with_every_row_fresh_and_leaves_no_torque(name: str) -> None:
    procedure = SHORTEST.get(name) or made(name)
    w = ready(wired(), procedure)
    ending, sink = run(w, procedure)
    assert ending.status == "completed", ending.reason
    assert sum(bool(row[0].flags & STALE) for row in sink.rows) == 0
    assert all(math.isfinite(row[0].theta_m + row[0].theta_l + row[0].tau_l) for row in sink.rows)
    assert w.wire.assembly.drive.drive_state is DriveState.SWITCH_ON_DISABLED
    w.instruments.close()


@pytest.mark.parametrize("name", AGAIN)
def test_it_completes_with_an_odrive_as_well(name: str) -> None:
    procedure = made(name)
    w = ready(odriven(), procedure)
    ending, _ = run(w, procedure)
    assert ending.status == "completed", ending.reason
    assert abs(w.wire.assembly.world.truth().tau_m) < 1e-3
    w.instruments.close()
