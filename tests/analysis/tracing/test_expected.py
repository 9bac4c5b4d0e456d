"""What a run is expected to tell two effects apart by has the signs physics gives it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.expected import proposals, sigmas, unexplained
from rig.model.effects import CATALOGUE
from tests.analysis.tracing.test_few_channels import reduced

RUNS = ("slow_ke_1", "slow_ke_2", "speed_120rpm_1", "speed_120rpm_2", "speed_300rpm_1", "speed_300rpm_2")


def test_what_the_others_cannot_explain_is_what_is_left_of_a_column_beside_them():
    rng = np.random.default_rng(1)
    z = rng.standard_normal((200, 4))
    z[:, 3] = z[:, 0] + 0.1 * z[:, 3]
    beside = z[:, :3] @ np.linalg.lstsq(z[:, :3], z[:, 3], rcond=None)[0]
    wanted = 4.0 * float(np.sum((z[:, 3] - beside) ** 2))
    assert unexplained(z.T @ z, slice(3, 4), np.array([2.0])) == pytest.approx(wanted, rel=1e-6)


@pytest.mark.slow
def test_friction_laws_are_told_apart_by_speeds_and_not_by_a_locked_output(tmp_path: Path, shared: Path):
    p = prepare(read_campaign(reduced(tmp_path, shared / "cases" / "open-5", RUNS, ())), ())
    covered = reach([p.eq.runs[i] for i in p.split.fitted])
    falling, drag = (
        Term(CATALOGUE[n], CATALOGUE[n].shapes(covered)[0]) for n in ("stribeck_friction", "quadratic_drag")
    )
    proposed = proposals(p.eq.runs[0].pieces[0].dt)
    told = sigmas(p.baseline, falling, drag, p.split.fitted, proposed)
    found = {f"{q.conditions}{q.procedure}": x for q, x in zip(proposed, told, strict=True)}
    best = max(found, key=lambda name: found[name])
    assert best.endswith("friction"), "eight speeds both ways"
    assert found["{'output_locked': True}stiffness_lock"] < 1.0
    assert found["{}kinematic_error"] < 0.2 * found[best], "all it has of other speeds are its reversals"
