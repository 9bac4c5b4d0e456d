"""The lock test: torque against wind-up of a gear whose output is held fast."""

from rig.analysis.stiffness.words import add_stiffness

__all__ = ["add_stiffness"]
