"""How the packages are installed that only some formats need: the extra `exchange` of pyproject.toml."""

from __future__ import annotations

import sys
from pathlib import Path

CHECKOUT = Path(__file__).parents[2]


def how_to_install(checkout: Path = CHECKOUT) -> str:
    """The command, as it is typed in the clone hdrig runs from; hdrig is on no registry, a name alone would fetch
    something foreign."""
    if not (checkout / "pyproject.toml").exists():
        return "install hdrig again from where it came from, with its extra 'exchange'"
    pip = Path(sys.prefix) / "bin" / "pip"
    shown = pip.relative_to(checkout) if pip.is_relative_to(checkout) else pip
    return f"in {checkout}: {shown} install -e '.[exchange]'"
