"""A recorded step test to inertia and friction at the motor."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rig.analysis.friction.step_response import StepResponse


def response_of(folder: Path) -> StepResponse:
    """Inertia and friction from the step test in `folder`. Raises DataError."""
    from rig.analysis.friction.step_response import step_response
    from rig.runfile.run import Run

    run = Run.open(folder)
    return step_response(run.need("t"), run.need("theta_m"), run.need("tau_applied"))
