"""From a bench file to a rig: devices, limits, gains, clock. Beside the first bench, the drill and the commands
`devices` and `twin` the only place that knows drivers/ and sim/.
"""

from rig.bench.assignments import override, toml_value
from rig.bench.bench import Bench, ClockName
from rig.bench.devices import ROLES, device_class
from rig.bench.reading import BENCHES, read, shipped
from rig.bench.twin import twin_parameters

__all__ = [
    "BENCHES",
    "ROLES",
    "Bench",
    "ClockName",
    "device_class",
    "override",
    "read",
    "shipped",
    "toml_value",
    "twin_parameters",
]
