"""Friction that is another one in every run: what all pairs of repeats say of it is in the floor of runs that go both
ways, and chance knows of how few they are."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import friction as module
from rig.analysis.tracing.floor.friction import Scattering, evened
from rig.analysis.tracing.floor.held_out import HeldOut
from rig.analysis.tracing.floor.repeats import Scatter
from rig.analysis.tracing.floor.rubbing import Rubbing

ROWS, NOISE, SCATTERS = 2000, 2e-3, 2e-3  # N·m
BOTH = np.repeat([1.0, -1.0], ROWS // 2)


def run(way: np.ndarray, start: float, locked: bool = False, wound: bool = False) -> Any:
    piece = SimpleNamespace(way=way, t=np.arange(float(way.size)))
    smoother = SimpleNamespace(centres=lambda n: slice(0, n))
    return SimpleNamespace(pieces=(piece,), smoother=smoother, start=start, locked=locked, is_wound=wound)


def pairs(
    monkeypatch: pytest.MonkeyPatch,
    seed: int,
    both_ways: int,
    one_way: int,
    drift: float = 0.0,
    scatters: float = SCATTERS,
) -> tuple[Any, list[Scatter]]:
    """A solution with pairs of repeats, the later of each with `drift` N·m less friction, and what they differ by."""
    rng = np.random.default_rng(seed)
    ways = [BOTH] * both_ways + [np.ones(ROWS), -np.ones(ROWS)] * one_way
    ways = ways[: both_ways + one_way]
    runs = [run(way, start) for way in ways for start in (0.0, 500.0)]
    friction = scatters * rng.standard_normal(len(runs)) - drift * (np.arange(len(runs)) % 2)
    left = {
        (i, "M"): friction[i] * r.pieces[0].way * (np.ptp(r.pieces[0].way) > 0) + NOISE * rng.standard_normal(ROWS)
        for i, r in enumerate(runs)
    }
    rows = {key: SimpleNamespace(keep=np.ones(ROWS, bool)) for key in left}
    s: Any = SimpleNamespace(
        design=SimpleNamespace(eq=SimpleNamespace(runs=runs, rows=rows)), residual=lambda key: left[key]
    )
    monkeypatch.setattr(module, "offset", lambda _, i, channel: friction[i] * runs[i].pieces[0].way[0])
    made = []
    for a in range(0, len(runs), 2):
        d = (left[a, "M"] - left[a + 1, "M"]) / np.sqrt(2)
        made.append(Scatter((a, a + 1), float(np.std(d)), ROWS, 0.0, np.ones(1), 50.0))
    return s, made


def test_all_pairs_tell_how_much_friction_scatters_and_runs_that_go_both_ways_have_it_in_their_floor(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    s, found = pairs(monkeypatch, 3, both_ways=2, one_way=40)
    made, friction = evened(s, found, NOISE**2)
    assert friction.pairs == 41
    assert np.sqrt(friction.square) == pytest.approx(SCATTERS, rel=0.25)
    for one in made[:2]:
        assert one.rms == pytest.approx(np.hypot(NOISE, np.sqrt(friction.square)), rel=0.05)
    assert made[2:] == found[2:]  # their means are their own


def test_what_all_later_repeats_have_less_of_is_no_scatter(monkeypatch: pytest.MonkeyPatch) -> None:
    s, found = pairs(monkeypatch, 4, both_ways=3, one_way=5, drift=20e-3)
    made, friction = evened(s, found, NOISE**2)
    assert np.sqrt(friction.square) < 2 * SCATTERS
    assert max(one.rms for one in made[:3]) < 0.4 * min(one.rms for one in found[:3])


def test_without_scatter_floors_stay_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    s, found = pairs(monkeypatch, 5, both_ways=3, one_way=4, scatters=0.0)
    made, friction = evened(s, found, NOISE**2)
    assert friction.square < 1e-3 * NOISE**2
    assert [one.rms for one in made] == pytest.approx([one.rms for one in found], rel=1e-2)


@pytest.mark.parametrize(("both_ways", "one_way"), [(1, 1), (0, 6)])
def test_of_too_few_pairs_or_of_none_that_go_both_ways_nothing_is_said(
    monkeypatch: pytest.MonkeyPatch, both_ways: int, one_way: int
) -> None:
    s, found = pairs(monkeypatch, 6, both_ways=both_ways, one_way=one_way)
    assert evened(s, found, NOISE**2) == (found, Scattering())


def test_the_share_of_a_floor_is_none_of_runs_that_go_one_way_or_have_a_friction_of_their_own() -> None:
    """As lock tests without a torque sensor do."""
    friction = Scattering(SCATTERS**2, 6)
    floor = float(np.hypot(NOISE, SCATTERS))
    assert friction.share(run(BOTH, 0.0), floor) == pytest.approx(0.5)
    assert friction.share(run(BOTH, 0.0), SCATTERS / 2) == 1.0
    assert friction.share(run(BOTH, 0.0, locked=True), floor) == pytest.approx(0.5)
    assert friction.share(run(BOTH, 0.0, locked=True, wound=True), floor) == 0.0
    assert friction.share(run(np.ones(ROWS), 0.0), floor) == 0.0


def test_few_runs_with_much_friction_in_their_floor_may_leave_more_of_it() -> None:
    """Of six, known of five pairs: one campaign in fifty by more than is allowed, drawn with both at random."""
    rng = np.random.default_rng(7)
    share, pairs_known = 0.5, 5
    friction = Scattering(1.0, pairs_known)
    known = rng.chisquare(pairs_known, 20_000) / pairs_known
    left = np.sqrt(1 - share + share * rng.chisquare(6, 20_000) / 6 / known)
    allowed = friction.of_a_channel(np.full(6, share / 6))
    assert 0.01 < float(np.mean(left > allowed)) < 0.03
    assert friction.of_one_run(share) > allowed > 1.0
    assert friction.of_one_run(0.0) == friction.of_a_channel(np.zeros(3)) == 1.0


def test_a_channel_is_loud_by_less_where_friction_does_not_scatter() -> None:
    e = {(i, "M"): np.full(100, 1.45) for i in range(6)}
    ones = dict.fromkeys(e, 1.0)
    quiet = HeldOut(tuple(range(6)), ones, {}, ones, {})
    rubs = HeldOut(
        tuple(range(6)), ones, {}, dict.fromkeys(e, 1.5), {}, frozenset(), Scattering(0.5, 6), dict.fromkeys(e, 0.5)
    )
    assert quiet.loud(e, 1.4)
    assert not rubs.loud(e, 1.4)
    assert rubs.loud({key: 1.6 * x for key, x in e.items()}, 1.4)


def test_a_run_is_judged_beside_a_friction_of_its_own() -> None:
    """More than one coefficient of friction makes is loud, however far friction scatters; that itself is not."""
    way = np.repeat([1.0, -1.0], 200)
    torque = np.tile(np.linspace(0.0, 2.0, 200), 2)
    key = (0, "M")
    rubs = HeldOut(
        (0,), {key: 1.5}, {}, {key: 2.0}, {}, friction=Scattering(1.25, 4), rubs={key: 0.5},
        rubbing={key: Rubbing(way, 1.0, 1.0)},
    )  # fmt: skip
    assert not rubs.loud({key: 1.8 * way + 0.4}, 1.4)
    assert rubs.loud({key: 3.0 * torque * way}, 1.4)
