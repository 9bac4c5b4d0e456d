"""The look at slow rows: asked for where a reading stands in for another, and believed where it leaves nothing."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.looks import narrow

ALL = frozenset({"t", "theta_m", "theta_l", "tau_m", "tau_l"})
GEAR = SimpleNamespace(K=16_000.0, J_l=1.0)  # 20.1 Hz


def selected(*names: str, loud: bool = True, has: frozenset[str] = ALL - {"theta_l"}, locked: bool = False) -> Any:
    run = SimpleNamespace(has=has, locked=locked, smoother=SimpleNamespace(sigma_hz=36.0), gear=GEAR)
    p = SimpleNamespace(campaign="campaign", floors={}, held_out=SimpleNamespace(residuals=lambda s, held: {}))
    s = SimpleNamespace(design=SimpleNamespace(eq=SimpleNamespace(runs=[run])))
    return SimpleNamespace(names=set(names), loud=loud, fitted_runs=[run], solution=s, held=None, p=p)


def test_it_is_asked_for_where_much_is_left_and_an_angle_or_a_torque_was_not_read() -> None:
    assert narrow.wanted(selected())
    assert narrow.wanted(selected(has=ALL - {"tau_l"}))
    assert not narrow.wanted(selected(loud=False))
    assert not narrow.wanted(selected(has=ALL))
    assert not narrow.wanted(selected(has=frozenset({"theta_m", "theta_l"})))  # no time
    assert not narrow.wanted(selected(locked=True))


@pytest.mark.parametrize(
    ("before", "after", "loud", "inside", "counts"),
    [
        ((), (), False, False, True),
        ((), (), False, True, False),  # an order that is in the floor of slow rows too
        (("error_by_speed",), (), False, False, True),  # no name of the library
        (("torque_ripple",), (), False, False, False),
        (("torque_ripple",), ("torque_ripple", "cogging_torque"), False, False, True),
        ((), ("torque_ripple",), True, False, False),
    ],
)
def test_it_counts_where_it_leaves_nothing_and_takes_no_name_away(
    monkeypatch: pytest.MonkeyPatch,
    before: tuple[str, ...],
    after: tuple[str, ...],
    loud: bool,
    inside: bool,
    counts: bool,
) -> None:
    asked: list[float] = []
    monkeypatch.setattr(narrow, "read_again", lambda campaign, narrow: asked.append(narrow) or campaign)
    monkeypatch.setattr(narrow, "hidden", lambda *_: "an order" if inside else None)
    monkeypatch.setattr(narrow, "prepare", lambda campaign, hold_out: None)
    other = selected(*after, loud=loud)
    monkeypatch.setattr(narrow, "searched", lambda p: (other, "ranked"))
    so_far, nothing = selected(*before), None
    found: Any = "found"
    got = narrow.taken(so_far, found, nothing, ())  # type: ignore[arg-type]
    assert got == ((other, "ranked") if counts else (so_far, "found"))
    assert asked == [pytest.approx(10.07, abs=0.01)]
