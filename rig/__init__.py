"""hdrig: the instrument. What a run is, how it is made, what it means."""

__version__ = "0.1.0"
