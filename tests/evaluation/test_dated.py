"""A gear file says of which days its runs are, and of which none are known."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.evaluation.identification import made_with

pytestmark = pytest.mark.usefixtures("no_pictures")

FIRST, LAST = "2026-11-16T06:00:00+00:00", "2026-11-18T06:00:00+00:00"


@pytest.mark.parametrize(
    ("started", "said"),
    [
        ([LAST, FIRST], "runs of 2026-11-16 to 2026-11-18"),
        ([LAST, None, FIRST], "runs of 2026-11-16 to 2026-11-18, 1 undated run"),
        ([None, None], "2 undated runs"),
    ],
)
def test_a_run_without_a_date_is_called_undated(started: list[str | None], said: str) -> None:
    runs: Any = [SimpleNamespace(manifest={"started_utc": one}) for one in started]
    assert made_with(runs).endswith(f", {said}")
