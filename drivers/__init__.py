"""Real devices, one per file. The catalogue: device type in the bench file → "module:class"."""

CATALOGUE: dict[str, str] = {}
