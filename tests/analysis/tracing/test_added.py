"""A disc added to the load of some runs is what their manifests declare of it, where the shaft torque agrees."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.runs.added import _is_shown
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.trace import trace
from tests.blind import rig as rigs
from tests.blind.cases import Request
from tests.blind.generate import write_case

DISC = 0.3  # kg·m²


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The paper's runs on one rig, those at 300 and 500 rpm with a disc."""
    root, bare = tmp_path_factory.mktemp("disc"), rigs.draw

    def heavier(rng: np.random.Generator, lowest_hz: float, highest_hz: float) -> rigs.Rig:
        drawn = bare(rng, lowest_hz, highest_hz)
        return replace(drawn, J_l=drawn.J_l + DISC)

    write_case(Request("clean", 5, "paper"), root / "bare", "case")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rigs, "draw", heavier)
        write_case(Request("clean", 5, "paper"), root / "heavy", "case")
    for run in sorted((root / "heavy" / "case").iterdir()):
        if any(rpm in run.name for rpm in ("300", "500")):
            shutil.rmtree(root / "bare" / "case" / run.name)
            shutil.copytree(run, root / "bare" / "case" / run.name)
    return root / "bare" / "case"


def declared(campaign: Path, to: Path, change: Callable[[float], float]) -> Path:
    """The campaign with other declared J_l."""
    shutil.copytree(campaign, to)
    for path in to.glob("*/manifest.json"):
        said = json.loads(path.read_text())
        said["declared"]["J_l"] = change(said["declared"]["J_l"])
        path.write_text(json.dumps(said))
    return to


@pytest.mark.slow
@pytest.mark.long
def test_a_disc_that_is_declared_is_no_effect_and_the_inertia_told_is_without_it(campaign: Path) -> None:
    found, read = trace(campaign), read_campaign(campaign)
    assert {run.name for run in read.runs if run.added} == {r.name for r in read.runs if r.speed_rpm in (300, 500)}
    assert found.verdict.status is Status.NOTHING
    (J_l,) = (p for p in found.baseline if p.name == "J_l")
    least = min(run.declared["J_l"] for run in read.runs)
    assert J_l.value == pytest.approx(least, rel=5e-3)
    assert any("0.3 kg·m² more is taken for a disc" in note for note in found.notes)


@pytest.mark.slow
@pytest.mark.long
def test_a_disc_that_the_shaft_torque_knows_nothing_of_is_none(campaign: Path, tmp_path: Path) -> None:
    numbers = sorted({run.declared["J_l"] for run in read_campaign(campaign).runs})
    other = declared(campaign, tmp_path / "other", lambda J: numbers[0] if numbers[1] == J else numbers[1])
    read = read_campaign(other)
    assert not any(run.added for run in read.runs)
    assert any("it is one number" in note for note in read.notes)


@pytest.mark.parametrize(
    ("disc", "more", "shown"),
    [(0.3, 0.29, True), (0.3, 0.02, False), (0.3, -0.3, False), (0.3, None, True), (700.0, None, False)],
)
def test_a_disc_is_one_that_a_torque_shows_or_nothing_speaks_against(
    disc: float, more: float | None, shown: bool
) -> None:
    assert _is_shown(disc, more, least=0.7) is shown
