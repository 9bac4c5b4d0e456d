"""Why no fall of friction is assumed is not said against what the slow runs show."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.identify.identified import _always, _no_fall
from rig.model.gearfile import Parameter


@pytest.mark.parametrize(
    ("friction", "said"),
    [
        (None, "no fall of friction with speed was seen"),
        (SimpleNamespace(doubt=""), "no fall of friction with speed was seen"),
        (SimpleNamespace(doubt="Below 48 rpm it is off."), "slow runs rub otherwise than fast ones"),
    ],
)
def test_slow_runs_off_the_line_are_not_said_to_be_on_it(friction: Any, said: str) -> None:
    fits: Any = SimpleNamespace(motor_friction=friction)
    assert _no_fall(fits).startswith(said)


def test_what_the_trace_may_find_besides_is_said_where_nothing_was_measured() -> None:
    assumed = _always({"tau_s": Parameter(0.3, origin="assumed")})
    assert "three speeds held constant below 48 rpm" in assumed[-1]
    assert "hdrig trace reads every row" in assumed[-1]
    assert not any("hdrig trace" in text for text in _always({"tau_s": Parameter(0.3)}))
