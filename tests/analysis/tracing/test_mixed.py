"""Runs of one folder that may be of two rigs are told of."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from rig.analysis.tracing.runs.mixed import mixed


def run(name: str, simulated: bool = False, **declared: Any) -> Any:
    return SimpleNamespace(name=name, simulated=simulated, declared=declared)


def test_runs_of_one_rig_are_not_spoken_of() -> None:
    assert mixed([run("a", K=7160.0, J_l=0.88), run("b", K=7160.0, J_l=0.8801), run("c")]) == []
    assert mixed([run("a", simulated=True), run("b", simulated=True)]) == []


def test_a_number_declared_differently_is_said_with_the_runs_that_do() -> None:
    (said,) = mixed([run("a", J_l=0.88), run("b", J_l=0.44), run("c", J_l=0.88)])
    assert said.startswith("The manifests declare J_l from 0.44 (b) to 0.88 (a)")


def test_simulated_runs_beside_measured_ones_are_said() -> None:
    (said,) = mixed([run("a"), run("b", simulated=True), run("c")])
    assert said.startswith("1 of 3 runs are simulated (b)")
