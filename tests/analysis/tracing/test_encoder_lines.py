"""Line counts of an encoder, found in what the model leaves."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.encoder_lines import with_lines
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.prepared import Prepared, prepare
from rig.analysis.tracing.runs.campaign import read_campaign

pytestmark = pytest.mark.xdist_group("encoder lines")  # what the module makes is made once, not for every worker

LINES = 2750  # divides no power of two


@pytest.fixture(scope="module")
def clean(shared: Path) -> Prepared:
    """A campaign of which the baseline leaves nothing."""
    return prepare(read_campaign(shared / "cases" / "open-1"), ())


def _with_waves(p: Prepared, amplitude: float) -> Solution:
    """The baseline's fit, the load encoder's reading off by `amplitude` rad once a line."""
    eq, runs = p.eq, p.split.fitted
    d = design(eq, (), runs)
    for key in [k for k in d.y if k[1] == "A"]:
        run = eq.runs[key[0]]
        at = np.concatenate([q.theta_l[run.smoother.centres(q.t.size)] for q in run.pieces])[eq.rows[key].keep]
        d.y[key][:] -= amplitude * np.cos(LINES * at + 0.3)
    return fit(d)


@pytest.mark.slow
@pytest.mark.long
def test_a_line_count_that_no_manifest_says_is_found_to_the_line(clean: Prepared) -> None:
    runs = clean.split.fitted
    covered = reach([clean.eq.runs[i] for i in runs])
    assert LINES not in with_lines(covered, _with_waves(clean, 0.0), runs).lines_l
    assert with_lines(covered, _with_waves(clean, 6e-6), runs).lines_l[0] == LINES


@pytest.mark.slow
@pytest.mark.long
def test_an_encoder_that_hardly_moves_has_no_lines(clean: Prepared) -> None:
    runs = clean.split.fitted
    covered = reach([clean.eq.runs[i] for i in runs])
    s = _with_waves(clean, 6e-6)
    eq = s.design.eq
    dead = tuple(
        dataclasses.replace(r, pieces=tuple(dataclasses.replace(p, theta_l=1e-6 * p.theta_l) for p in r.pieces))
        for r in eq.runs
    )
    s = dataclasses.replace(s, design=dataclasses.replace(s.design, eq=dataclasses.replace(eq, runs=dead)))
    assert with_lines(covered, s, runs).lines_l == ()
