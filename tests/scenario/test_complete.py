"""The plan that tracing needs, on the twin as it ships: nothing is missing from a rig that has what the model has."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rig.cli import main


@pytest.mark.long
def test_nothing_is_missing_from_the_twin_as_it_ships(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["campaign", "complete", "--out", str(tmp_path), "--seed", "3"]) == 0
    campaign = next(tmp_path.glob("*campaign-complete*"))
    assert main(["trace", str(campaign)]) == 0, capsys.readouterr().out
    verdict = json.loads((campaign / "trace.json").read_text())["verdict"]
    assert (verdict["status"], verdict["effects"]) == ("no_missing_effect", [])
