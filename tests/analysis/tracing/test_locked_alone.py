"""The floor where nothing is compared: an angle nobody read, in a lock test that was done once; one short run."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Noise
from rig.analysis.tracing.floor.noise import TOO_SHORT, Measured, _locked_alone, _of_a_few


def test_all_that_is_left_of_lock_tests_that_were_done_once_counts_as_noise(rng: np.random.Generator) -> None:
    eq: Any = SimpleNamespace(
        runs=[
            SimpleNamespace(locked=lock, has=has) for lock, has in ((True, set()), (False, set()), (True, {"theta_l"}))
        ]
    )
    e = {(0, "A"): 3e-6 * rng.standard_normal(4000), (1, "M"): rng.standard_normal(4000)}
    assert _locked_alone(eq, e, "A") == pytest.approx(3e-6, rel=0.05)
    assert _locked_alone(eq, e, "M") is None
    assert _locked_alone(eq, e | {(1, "A"): np.ones(100)}, "A") is None
    assert _locked_alone(eq, e | {(2, "A"): np.ones(100)}, "A") is None
    assert _locked_alone(eq, {}, "A") is None


def test_all_that_is_left_of_one_or_two_short_runs_counts_as_noise(rng: np.random.Generator) -> None:
    def run(name: str, locked: bool = False, procedure: str = "kinematic_error") -> Any:
        return SimpleNamespace(name=name, locked=locked, procedure=procedure)

    e = {(0, "A"): 1e-6 * rng.standard_normal(4000), (1, "M"): rng.standard_normal(4000)}
    both, still = run("slow (part held out)"), run("still", procedure="standstill")
    for others in ([], [run("the proof before it", procedure="other")]):
        few: Any = SimpleNamespace(runs=[run("slow"), both, still, *others])
        assert _of_a_few(few, e, "A") == pytest.approx(1e-6, rel=0.05)
        assert _of_a_few(few, e, "L") is None
    for several in ([run("fast"), run("faster")], [run("lock", locked=True)]):
        many: Any = SimpleNamespace(runs=[run("slow"), *several])
        assert _of_a_few(many, e, "A") is None


def test_that_all_of_it_counts_as_noise_is_said() -> None:
    noise = Noise({}, {}, {})
    said = Measured(noise, {}, {}, {"A": "a pair of repeats", "M": TOO_SHORT, "L": TOO_SHORT}, {}).never_compared()
    assert len(said) == 1
    assert said[0].startswith("The floor (of motor torque, shaft torque) is all that the baseline leaves")
    assert Measured(noise, {}, {}, {"A": "a pair of repeats"}, {}).never_compared() == []
