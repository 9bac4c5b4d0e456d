"""Every procedure and sweep of the catalogues, typed by name against `hdrig twin`: two processes, real time."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.core.errors import Exit
from tests.scenario.real_time import NAMES, by_name, twin_at
from tests.scenario.test_over_the_wire import Twin

pytestmark = [pytest.mark.slow, pytest.mark.long, pytest.mark.xdist_group("real time")]
UNDECIDED = ("speed-convergence",)  # three speeds above 60 rpm are too few to say which is slow enough


@pytest.fixture(scope="module")
def twin() -> Iterator[Twin]:
    with tempfile.TemporaryDirectory(dir="/tmp", prefix="hdrig-") as doors, twin_at(Path(doors), 3600.0) as made:
        yield made


@pytest.mark.parametrize("name", NAMES)
def test_it_completes_over_frames_and_lines_with_the_hand_of_the_twin(name: str, twin: Twin, tmp_path: Path) -> None:
    outcome = by_name(twin, name, tmp_path)
    assert outcome.exit in (Exit.PASS, *((Exit.INCOMPLETE,) if name in UNDECIDED else ())), outcome.said
    assert set(outcome.status) == {"completed"}, outcome.said
    assert "SIMULATED" in outcome.said
    assert abs(float(str(twin.ask(do="truth")["tau_m"]))) < 1e-3, "N·m: the motor is without torque"
