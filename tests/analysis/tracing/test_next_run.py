"""The run that is asked for takes part in the next fit, and a rival may bend its shape before it is told apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.court.expected import proposals, sigmas
from rig.analysis.tracing.court.next_run import _fitted, _refined, _yielding
from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.trace import Prepared, prepare
from rig.model.effects import CATALOGUE
from tests.analysis.tracing.test_few_channels import reduced

RUNS = [f"{name}_{k}" for name in ("slow_ke", "speed_120rpm", "speed_300rpm", "speed_400rpm") for k in (1, 2)]

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def prepared(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> Prepared:
    folder = reduced(tmp_path_factory.mktemp("few"), shared / "cases" / "open-5", RUNS, ())
    return prepare(read_campaign(folder), ())


def test_a_speed_between_others_would_be_held_out_whole_and_one_beside_them_would_not(prepared: Prepared) -> None:
    by_speed = {
        q.conditions["speed_rpm"]: _fitted(prepared, q)
        for q in proposals(prepared.eq.runs[0].pieces[0].dt)
        if q.procedure == "constant_torque"
    }
    assert by_speed[200.0] == 0.0, "the second of four speeds"
    assert by_speed[60.0] == 0.5, "the slowest: its repeat tests the fit"
    assert all(share > 0.0 for rpm, share in by_speed.items() if rpm != 200.0)


def test_a_rival_free_in_its_shape_is_told_apart_by_less_even_by_the_best_run(prepared: Prepared) -> None:
    p = prepared
    covered = reach([p.eq.runs[i] for i in p.split.fitted])
    falling = _refined(p, Term(CATALOGUE["stribeck_friction"], CATALOGUE["stribeck_friction"].shapes(covered)[0]))
    drag = _refined(p, Term(CATALOGUE["quadratic_drag"], CATALOGUE["quadratic_drag"].shapes(covered)[0]))
    term, proposed = drag.design.terms[-1], proposals(p.eq.runs[0].pieces[0].dt)
    stiff = np.array(sigmas(p.baseline, term, falling.design.terms[-1], p.split.fitted, proposed))
    bent = np.array(sigmas(p.baseline, term, _yielding(falling, covered), p.split.fitted, proposed))
    assert np.argmax(bent) == np.argmax(stiff), "stairs through all speeds"
    assert bent.max() < 0.9 * stiff.max()
    signals = p.eq.runs[p.split.fitted[0]].pieces[0]
    wide, bare = (t.effect.columns(signals, t.shape) for t in (_yielding(falling, covered), falling.design.terms[-1]))
    loose = len(_yielding(falling, covered).effect.slopes)  # type: ignore[attr-defined]
    assert 1 <= loose <= sum(falling.design.terms[-1].effect.loose)
    assert {port: c.shape[1] for port, c in wide.items()} == {port: c.shape[1] + loose for port, c in bare.items()}
