"""What was meant by a name that does not exist: a file of its own, for nothing here costs start-up."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

ALIKE = 0.65  # of the letters, in their order: with less, nonsense was taken for chosen_speed
SHORT = 2  # letters, one of which may be wrong: Kq


def nearest(wrong: str, valid: Iterable[str]) -> str:
    """ "did you mean 'x'?", or the list of what exists."""
    names = sorted(valid)
    close = difflib.get_close_matches(wrong, names, n=1, cutoff=ALIKE if len(wrong) > SHORT else 0.5)
    close = close or sorted((n for n in names if wrong in n.replace("-", "_").split("_")), key=len)  # rpm for speed_rpm
    return f"did you mean '{close[0]}'?" if close else f"expected one of {', '.join(names)}"
