"""Whether a gear file is of the gear on the bench, by ratio and serial."""

from __future__ import annotations

import math

from rig.bench import Bench
from rig.core.errors import UsageError
from rig.model.gearfile import GearFile

SAME = 1e-6  # of the ratio: a count of teeth, written down with a few digits


def refuse_other_gear(bench: Bench, gear: GearFile) -> None:
    """The error of another gear fed forward makes this one's worse. Raises UsageError; where the file names no serial
    the ratio decides."""
    here, ratio = bench.file.gear, gear.parameters["N"].value
    if math.isclose(ratio, here.N, rel_tol=SAME) and gear.serial in ("", here.serial):
        return
    raise UsageError(
        f"the error to feed forward is of gear {gear.serial or 'without serial'}, ratio {ratio:.9g}, and bench "
        f"'{bench.file.name}' declares gear {here.serial}, ratio {here.N:.9g}; expected the gear that is on the bench"
    )
