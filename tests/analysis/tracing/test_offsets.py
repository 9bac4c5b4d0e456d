"""The zero of a run is what is left of its mean beside the effects of the model."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import offsets
from rig.analysis.tracing.floor.offsets import of_effects, zero


def test_what_effects_shift_a_mean_by_is_none_of_its_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wave of the output over a part of its turn has a mean (exam 94, case 18)."""
    part = np.linspace(0.0, 1.0, 50)
    columns = {"crosstalk": {"A": np.stack([np.cos(part), np.sin(part)], 1)}, "ripple": {"M": np.ones((50, 1))}}
    terms = tuple(SimpleNamespace(name=name) for name in columns)
    design = SimpleNamespace(
        terms=terms,
        eq=SimpleNamespace(term=lambda run, term: columns[term.name]),
        place=lambda i: (slice(0, 2), slice(2, 3))[i],
    )
    s: Any = SimpleNamespace(design=design, x=np.array([2.0, 3.0, 7.0]))
    mean = 2.0 * np.cos(part).mean() + 3.0 * np.sin(part).mean()
    monkeypatch.setattr(offsets, "offset", lambda s, run, channel: {"A": 5.0, "M": 8.0, "L": 1.0}[channel])
    assert (zero(s, 0, "A"), zero(s, 0, "M"), zero(s, 0, "L")) == (pytest.approx(5.0 - mean), 1.0, 1.0)
    assert of_effects(s, 0, "A", but=["crosstalk"]) == 0.0
