"""A line of the clock has to stand out in some run."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from rig.analysis.tracing.residual import ticking
from rig.analysis.tracing.residual.ticking import _of_the_clock


def test_a_frequency_that_stands_out_in_no_run_is_not_of_the_clock() -> None:
    keys = [(0, "M"), (1, "M")]
    eq = cast(Any, SimpleNamespace(runs=[SimpleNamespace(turning=1.0), SimpleNamespace(turning=5.0)]))
    hz = np.linspace(0.1, 10.0, 100)
    flat = {key: (0.1, 10.0, hz, np.ones(hz.size)) for key in keys}
    assert not _of_the_clock(eq, {key: np.ones(300) for key in keys}, flat, 2.0)


def test_runs_of_two_speeds_far_apart_of_which_none_is_near_the_middle_tell_no_clock(monkeypatch: Any) -> None:
    keys = [(0, "M"), (1, "M")]
    eq = cast(Any, SimpleNamespace(runs=[SimpleNamespace(turning=1.0), SimpleNamespace(turning=5.0)]))
    hz = np.linspace(0.1, 10.0, 100)
    line = {key: (0.1, 10.0, hz, np.where(np.abs(hz - 2.0) < 0.3, 1e3, 1.0)) for key in keys}
    monkeypatch.setattr(ticking, "_part", lambda eq, key, e, hz: None)
    assert not _of_the_clock(eq, {key: np.ones(300) for key in keys}, line, 2.0)
