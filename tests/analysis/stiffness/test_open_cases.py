"""Recorded lock tests of known truth, with the slow run of their campaign."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from rig.analysis import analyse
from rig.core.units import ARCMIN
from rig.runfile.run import Run
from tests.analysis.stiffness.test_spring import figures
from tests.some import some

pytestmark = pytest.mark.slow


def found(shared: Path, case: str, name: str) -> dict[str, Any]:
    folder = shared / "cases" / case
    return figures(analyse(Run.open(folder / name), Run.open(folder / "slow_ke_1")))


def truth(shared: Path, case: str) -> dict[str, Any]:
    cases: dict[str, dict[str, Any]] = json.loads((shared / "cases" / "TRUTH.json").read_text())
    return cases[case]


@pytest.mark.parametrize("case", some(["open-1", "open-2", "open-3", "open-4", "open-5", "open-6"], 3))
@pytest.mark.parametrize("name", ["lock_20_1", "lock_60_2"])
def test_the_stiffness_is_the_true_one_within_an_interval_of_half_a_per_cent(
    shared: Path, case: str, name: str
) -> None:
    K, figure = truth(shared, case)["baseline"]["K"], found(shared, case, name)["torsional_stiffness"]
    assert figure.ci95[0] < K < figure.ci95[1]
    assert (figure.ci95[1] - figure.ci95[0]) / 2 < 0.005 * K


@pytest.mark.parametrize("name", ["lock_20_1", "lock_60_1"])
def test_the_hysteretic_gear_has_its_loop_and_the_elastic_one_none(shared: Path, name: str) -> None:
    told = truth(shared, "open-3")
    force, B_sp = told["parameters"]["bw_k"] * told["parameters"]["bw_xy"], told["baseline"]["Bsp"]
    rate = 0.0006 if name == "lock_20_1" else 0.0017  # rad/s, these runs'
    true = 2 * (force + B_sp * rate) / told["baseline"]["K"] / ARCMIN
    assert abs(found(shared, "open-3", name)["hysteresis_loss"].value / true - 1) < 0.05
    assert abs(found(shared, "open-1", name)["hysteresis_loss"].value) < 0.02
