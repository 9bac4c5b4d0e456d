"""TOML that a person wrote: what is wrong with it is one sentence."""

from __future__ import annotations

import tomllib
from typing import Any, Final

from rig.core.errors import UsageError

MARK: Final = "\ufeff"  # of byte order, before the first character: editors of Windows leave it


def read_toml(text: str, source: str) -> dict[str, Any]:
    """The tables in `text`; `source` is what errors call it. Raises UsageError."""
    try:
        return tomllib.loads(text.removeprefix(MARK))
    except (ValueError, RecursionError) as error:  # also numbers of thousands of digits, and endless nesting
        raise UsageError(f"{source} is not valid TOML: {str(error).splitlines()[0]}") from None
