"""How many threads share the work of a trace."""

from typing import Final

WORKERS: Final = 2  # numpy leaves the interpreter's lock for nearly all of the work
