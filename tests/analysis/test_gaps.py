"""A run with a gap gives the figures of the rest of it."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import analyse
from tests.analysis.synthetic import MadeRun, slow_run


@pytest.mark.parametrize("lost", [2000, 6250, 12_000])
def test_the_kinematic_error_of_a_run_with_a_gap_is_that_of_the_rest(lost: int) -> None:
    run = slow_run(1)
    t = run.column("t")
    assert t is not None
    keep = np.r_[0:36_000, 36_000 + lost : t.size]
    names = [n for n in ("t", "theta_m", "theta_l", "theta_ref", "tau_m", "tau_l", "flags") if run.has(n)]
    gapped = MadeRun({n: run.column(n)[keep] for n in names}, dict(run.manifest))  # type: ignore[index]
    whole, found = (
        next(e for e in analyse(r).estimates if e.name == "kinematic_error_peak_to_peak") for r in (run, gapped)
    )
    assert found.ci95[0] - 0.5 < whole.value < found.ci95[1] + 0.5
    assert found.ci95[1] - found.ci95[0] < 0.1 * found.value
    assert any(f"gap of {(lost + 1) * 1e-3:.3g} s at t = 36.0 s" in note for note in analyse(gapped).cannot)
