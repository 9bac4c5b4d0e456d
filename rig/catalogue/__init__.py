"""The runs of a folder: listed, compared, followed over time. Reads manifest.json and result.json, writes nothing.

`scan` finds rows, `filter` picks among them; `sameness` says which are repeats of one another, and `scatter` how far
those lie apart. Each module says at its top what it is for.
"""

from rig.catalogue.compare import Comparison, compare
from rig.catalogue.filter import Filter
from rig.catalogue.row import Row
from rig.catalogue.scan import runs
from rig.catalogue.trend import Trend, trend

__all__ = ["Comparison", "Filter", "Row", "Trend", "compare", "runs", "trend"]
