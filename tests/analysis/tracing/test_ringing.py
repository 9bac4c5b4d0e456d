"""What a mode still swings by when a run begins: its free oscillation, in runs that begin in motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Equations, Noise, Term, equations
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.floor.ringing import ringing
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.model.effects import CATALOGUE
from tests.analysis.tracing.test_few_channels import reduced

HZ, ZETA = 11.8, 0.02
MODE = CATALOGUE["torsional_mode"]
ON_THE_MOTOR = Term(MODE, (1.0, HZ, ZETA, 0.0))
RUNS = ("lock_20_1", "slow_ke_1", "speed_200rpm_1")


@pytest.fixture(scope="module")
def eq(tmp_path_factory: pytest.TempPathFactory, shared: Path) -> Equations:
    """One run of each kind."""
    folder = reduced(tmp_path_factory.mktemp("runs"), shared / "cases" / "open-1", RUNS, ())
    return equations(read_campaign(folder).runs, Noise({}, {}, {}))


def test_a_run_that_begins_in_motion_has_a_ring_down_where_the_mode_acts(eq: Equations) -> None:
    found = ringing(eq, [ON_THE_MOTOR], range(len(eq.runs)))
    assert [(eq.runs[i].name, c) for i, c in found] == [("speed_200rpm_1", "M")]
    ((key, made),) = found.items()
    since = clock(eq, key) - eq.runs[key[0]].pieces[0].t[0]
    free = np.exp((-ZETA + 1j * np.sqrt(1 - ZETA**2)) * 2 * np.pi * HZ * since)
    both = np.stack([free.real, free.imag], 1)
    left = made - both @ np.linalg.lstsq(both, made, rcond=None)[0]
    assert np.abs(left).max() < 0.05 * np.abs(made).max()  # the low-pass of the rows takes a little of it


def test_what_soon_forgets_or_has_no_mode_of_its_own_rings_not(eq: Equations) -> None:
    runs = range(len(eq.runs))
    assert ringing(eq, [Term(MODE, (1.0, HZ, 0.2, 0.0))], runs) == {}
    assert ringing(eq, [Term(MODE, (2.0, HZ, ZETA, 0.0))], runs) == {}  # a stiff coupling
    assert ringing(eq, [Term(CATALOGUE["quadratic_drag"], (0.0, 2.0, 0.0))], runs) == {}


def test_a_mode_that_acts_in_several_channels_rings_in_all_of_them(eq: Equations) -> None:
    """A housing turns both encoders."""
    found = ringing(eq, [Term(CATALOGUE["support_compliance"], (0.0, HZ, ZETA))], range(len(eq.runs)))
    assert {eq.runs[i].name for i, _ in found} == {"speed_200rpm_1"}
    for key, made in found.items():
        assert made.shape[0] == eq.rows[key].y.size
        assert np.any(made, axis=0).all()
