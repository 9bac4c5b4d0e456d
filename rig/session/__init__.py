"""From connect to a finished run folder: one bench opened, proven, changed by hand, run."""

from rig.core.errors import Ended
from rig.session.done import Done, Watch
from rig.session.session import Session

__all__ = ["Done", "Ended", "Session", "Watch"]
