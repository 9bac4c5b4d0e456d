"""The gear the figures are simulated with, from runs on disk."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.analysis.reproduction.model import identify_gear
from rig.model.gear import sigma_of
from tests.commands.made_run import made_run, manifest


@pytest.mark.slow
@pytest.mark.parametrize(("output", "sigma"), [("flexspline", 1), ("circular_spline", 0)])
def test_the_gear_is_simulated_with_the_output_it_was_identified_with(tmp_path: Path, output: str, sigma: int) -> None:
    run = made_run(tmp_path / "run", {"gear": {**manifest()["gear"], "output": output}})
    assert identify_gear([run], []).gear.sigma == sigma


def test_a_run_that_names_no_output_or_an_unknown_one_is_taken_with_the_usual_one() -> None:
    assert [sigma_of(said) for said in (None, "", 3, "wave_generator", "circular_spline")] == [1, 1, 1, 1, 0]
