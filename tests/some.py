"""Of many like cases some in `make test`, all in `make long`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from _pytest.mark import ParameterSet


def some(values: Iterable[Any], keep: int) -> list[Any]:
    """The values to parametrize a test with, of which `keep`, spread evenly, stay in `make test`."""
    every = list(values)
    kept = {round(k * (len(every) - 1) / max(keep - 1, 1)) for k in range(keep)}
    return [value if i in kept else _long(value) for i, value in enumerate(every)]


def _long(value: Any) -> Any:
    if isinstance(value, ParameterSet):
        return pytest.param(*value.values, marks=(*value.marks, pytest.mark.long), id=value.id)
    return pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=pytest.mark.long)
