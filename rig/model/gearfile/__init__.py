"""The gear file: an identified gear on disk. Every number has its unit, its 95 % interval, its origin and its runs.

TOML, read strictly: an error names file, key, value, what was expected and the nearest valid key. What is written is
read back as the same value, bit by bit.
"""

from rig.model.gearfile.content import CHARACTERISTICS, UNITS, Covered, GearFile, MeasuredSeries, Parameter, declared
from rig.model.gearfile.reading import loads, read
from rig.model.gearfile.writing import dumps, write

__all__ = [
    "CHARACTERISTICS",
    "UNITS",
    "Covered",
    "GearFile",
    "MeasuredSeries",
    "Parameter",
    "declared",
    "dumps",
    "loads",
    "read",
    "write",
]
