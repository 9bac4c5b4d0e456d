"""The runs of a folder: listed, compared, followed over time. Reads manifest.json and result.json, writes nothing.

| file | one idea |
|---|---|
| row | one run in a list |
| remembered | what was read from a file, read again only when the file is another |
| scan | every run below a folder |
| filter | which of them, in which order |
| figures | the figures of one run, by the words people use |
| sameness | which runs are repeats of one another |
| scatter | how far repeats lie apart, and what is more than that |
| lacking | which of the runs side by side has not which figure |
| compare | runs side by side |
| trend | one figure over days and assemblies |
"""

from rig.catalogue.compare import Comparison, compare
from rig.catalogue.filter import Filter
from rig.catalogue.row import Row
from rig.catalogue.scan import runs
from rig.catalogue.trend import Trend, trend

__all__ = ["Comparison", "Filter", "Row", "Trend", "compare", "runs", "trend"]
