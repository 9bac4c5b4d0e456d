"""What was held out, in words: whole runs, or parts of runs that the fit saw the rest of."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.report.trace.channels import held_out_with


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["a_2"], "1 held-out run"),
        (["a_2", "b_2"], "2 held-out runs"),
        ([f"a ({HELD_PART})"], "the held-out part of 1 run"),
        ([f"a ({HELD_PART})", f"b ({HELD_PART})"], "the held-out parts of 2 runs"),
        (["a_2", f"b ({HELD_PART})"], "1 held-out run and the held-out part of 1 run"),
        ([], "0 held-out runs"),
    ],
)
def test_parts_of_runs_are_not_called_runs(names: list[str], said: str) -> None:
    errors = SimpleNamespace(kinematic_error_rms_arcsec=1.0, tau_m_rms=None, tau_l_rms=None)
    trace: Any = SimpleNamespace(before=SimpleNamespace(per_run=dict.fromkeys(names, errors)))
    assert held_out_with(trace, "theta_l") == said
    assert held_out_with(trace, "tau_m") == "0 held-out runs"
