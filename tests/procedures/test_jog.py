"""A jog turns as far as was asked, either way, and nobody can ask for much."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from rig.cli import main
from rig.core.errors import UsageError
from rig.procedures.jog import Jog
from tests.analysis.recorded import Rig


@pytest.mark.parametrize("turns", [0.25, -1.0])
def test_it_ends_at_rest_where_it_was_asked_to_and_without_torque(turns: float) -> None:
    columns = Rig().run(Jog(turns=turns, speed_rpm=30.0)).run.columns
    moved = (columns["theta_m"][-1] - columns["theta_m"][0]) / (2 * math.pi)
    assert moved == pytest.approx(turns, abs=0.005)
    assert abs(columns["omega_m"][-1]) < 0.1
    assert columns["tau_applied"][-1] == 0.0


def test_it_is_no_faster_than_asked() -> None:
    columns = Rig().run(Jog(turns=1.0, speed_rpm=30.0)).run.columns
    reference = np.diff(columns["theta_ref"][1:-1]) / np.diff(columns["t"][1:-1])
    assert np.nanmax(np.abs(reference)) == pytest.approx(math.pi, rel=0.01)


@pytest.mark.parametrize(
    ("turns", "speed_rpm"), [(0.0, 15.0), (10.5, 15.0), (-11.0, 15.0), (math.nan, 15.0), (1.0, 61.0), (1.0, math.nan)]
)
def test_what_is_no_jog_is_refused_with_the_bound(turns: float, speed_rpm: float) -> None:
    with pytest.raises(UsageError, match=r"expected up to (10 turns|60 rpm)"):
        Jog(turns=turns, speed_rpm=speed_rpm)


@pytest.mark.slow
def test_by_name_it_says_how_far_the_motor_turned(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "jog", "--out", str(tmp_path), "--with", "turns=-0.5"]) == 0
    assert re.search(r"the motor turned -1(79|80)\.\d\d°, -180\.00° were asked for", capsys.readouterr().out)
