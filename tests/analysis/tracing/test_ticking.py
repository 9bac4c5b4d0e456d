"""A line of the clock has to stand out in some run."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from rig.analysis.tracing.rest.ticking import _of_the_clock


def test_a_frequency_that_stands_out_in_no_run_is_not_of_the_clock() -> None:
    keys = [(0, "M"), (1, "M")]
    eq = cast(Any, SimpleNamespace(runs=[SimpleNamespace(turning=1.0), SimpleNamespace(turning=5.0)]))
    hz = np.linspace(0.1, 10.0, 100)
    flat = {key: (0.1, 10.0, hz, np.ones(hz.size)) for key in keys}
    assert not _of_the_clock(eq, {key: np.ones(300) for key in keys}, flat, 2.0)
