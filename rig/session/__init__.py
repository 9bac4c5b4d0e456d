"""From connect to a finished run folder: one bench opened, proven, changed by hand, run."""

from rig.session.done import Done, Ended, Watch
from rig.session.session import Session

__all__ = ["Done", "Ended", "Session", "Watch"]
