"""What a terminal shows of characters its encoding lacks: a mark that decides something must not become a `?`."""

from __future__ import annotations

import codecs
from typing import Final

NAME: Final = "hdrig-plain"
PLAIN: Final = {
    "✓": "[yes]", "✗": "[no]", "–": "-", "—": "-", "−": "-", "±": "+/-", "·": "*", "×": "x", "→": "->", "…": "...",
    "°": " deg", "µ": "u", "μ": "u", "²": "^2", "³": "^3", "’": "'", "“": '"', "”": '"', "≤": "<=", "≥": ">=",
    "θ": "theta", "ω": "omega", "τ": "tau", "φ": "phi", "π": "pi", "Ω": "ohm", "\u0303": "~", "\u0307": "'",
    "\u0308": "''", "\u00a0": " ", "\u202f": " ",
}  # fmt: skip


def _plainly(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    missing = error.object[error.start : error.end]
    return "".join(PLAIN.get(letter, "?") for letter in missing), error.end


codecs.register_error(NAME, _plainly)
