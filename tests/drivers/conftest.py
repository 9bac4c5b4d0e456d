"""Buses that tests opened are closed behind them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.drivers import virtual


@pytest.fixture(autouse=True)
def _close_buses() -> Iterator[None]:
    yield
    for made in virtual.MADE:
        made.instruments.close()
    virtual.MADE.clear()
