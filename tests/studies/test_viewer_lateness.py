"""The study of the viewer's effect on the loop runs, and loses no row under any condition."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.studies.viewer_lateness import CONDITIONS, Condition, measure, table


@pytest.mark.long
@pytest.mark.parametrize("condition", CONDITIONS, ids=lambda condition: condition.name)
def test_every_tick_has_its_row_whatever_becomes_of_the_viewer(condition: Condition, tmp_path: Path) -> None:
    found = measure(condition, 3.0, tmp_path)
    assert found.rows == found.ticks
    assert found.ticks + found.missed == pytest.approx(3000, abs=2)
    assert condition.name in table({condition.name: [found]})[1]
