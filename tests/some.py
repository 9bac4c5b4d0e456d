"""Of many like cases some in `make test`, all in `make long`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def some(values: Iterable[Any], keep: int) -> list[Any]:
    """The values to parametrize a test with, one by one, of which `keep`, spread evenly, stay in `make test`."""
    every = list(values)
    kept = {round(k * (len(every) - 1) / max(keep - 1, 1)) for k in range(keep)}
    return [value if i in kept else pytest.param(value, marks=pytest.mark.long) for i, value in enumerate(every)]
