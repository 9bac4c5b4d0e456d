"""The figures of a trace: one figure, one file, one line here; drawn and dressed as those of a run are."""

from rig.report.figures.canvas import Drawing
from rig.report.trace.figures import angle, before_after, each_run, free_run, home, loop, spectrum, where

WHERE: tuple[Drawing, ...] = (where.DRAWING, home.DRAWING, spectrum.DRAWING, angle.DRAWING)
BEFORE_AFTER: tuple[Drawing, ...] = (
    each_run.DRAWING,
    before_after.KINEMATIC_ERROR,
    free_run.DRAWING,
    before_after.MOTOR_TORQUE,
    before_after.SHAFT_TORQUE,
    loop.DRAWING,
)
CATALOGUE: tuple[Drawing, ...] = WHERE + BEFORE_AFTER
