"""Where a rest is said to live: in the channels that have a fair part of what is left."""

from __future__ import annotations

from typing import Any

import pytest

from rig.analysis.tracing.residual import lives


@pytest.mark.parametrize(
    ("over", "said"),
    [
        ({"A": 4.0, "L": 2.0, "M": 1.1}, ("speed", "time_periodic", "load")),
        ({"A": 230.0, "L": 3.3, "M": 1.1}, ("speed", "load")),
        ({"A": 1.2, "L": 1.0, "M": 1.1}, ()),
        ({}, ()),
    ],
)
def test_a_channel_beside_which_another_has_far_more_left_is_not_asked(
    monkeypatch: pytest.MonkeyPatch, over: dict[str, float], said: tuple[str, ...]
) -> None:
    where = {"A": ["speed", "load"], "L": ["time_periodic"], "M": ["direction"]}
    monkeypatch.setattr(lives, "loudness", lambda e, floors: over)
    monkeypatch.setattr(lives, "_in_channel", lambda eq, e, floors, channel: where[channel])
    nothing: Any = {}
    assert lives.lives_in(nothing, nothing, nothing) == said
