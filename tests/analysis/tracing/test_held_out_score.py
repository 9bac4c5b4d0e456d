"""An effect has one size in all runs; what only looks like it has another in each."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.selection import score as held_out_score
from rig.analysis.tracing.selection.done import Without, noise_in
from rig.analysis.tracing.selection.elimination import unresolved
from rig.analysis.tracing.selection.score import HeldOutScore, Unsteadiness, overall, unsteadiness
from rig.model.effect import Parameter
from rig.model.effects.torsional_mode import TorsionalMode
from tests.contract.test_effects import REACH

KEYS = [(i, "M") for i in range(6)]


def solved(
    rng: np.random.Generator,
    true: dict[Any, Any],
    noise: float,
    shown: dict[Any, float] | None = None,
    parts: int = 1,
    spoilt: float = 0.0,
) -> Unsteadiness:
    """Unsteadiness of an effect of fitted size 1 whose true size in each block is `true` (a number, or row by row), and
    how many show it; `shown`: its RMS there; `spoilt`: RMS of what sensor noise makes of it."""
    f = {k: (shown or {}).get(k, 1.0) * rng.standard_normal(4000) for k in KEYS}
    e = {k: (true[k] - 1.0) * f[k] + noise * rng.standard_normal(4000) for k in KEYS}
    mine, again = ({k: spoilt * rng.standard_normal(4000) for k in KEYS} for _ in range(2))
    f, e = {k: f[k] + mine[k] for k in KEYS}, {k: e[k] - mine[k] for k in KEYS}
    design: Any = SimpleNamespace(
        eq=SimpleNamespace(
            noise=SimpleNamespace(kappa={"M": 1.0}), runs=[SimpleNamespace(procedure="speed") for _ in KEYS]
        ),
        noise=dict.fromkeys(KEYS[:2]),
        noise_left=lambda key, x: -again[key][:, None] * x,
    )
    whole: Any = SimpleNamespace(x=np.ones(1), design=design)
    rest: Any = SimpleNamespace(x=np.zeros(1))
    (made,) = noise_in(whole, [rest])
    one = Without(rest, design, e, {k: e[k] + f[k] for k in KEYS}, made)
    return unsteadiness(one, dict.fromkeys(KEYS, 1.0), parts)


def test_the_same_size_everywhere_is_steady_whatever_the_noise(rng: np.random.Generator) -> None:
    assert solved(rng, dict.fromkeys(KEYS, 1.0), 0.1)[0] < 0.01
    assert solved(rng, dict.fromkeys(KEYS, 1.0), 1.0)[0] < 0.02


def test_a_compromise_between_runs_is_told_by_its_spread(rng: np.random.Generator) -> None:
    halves = {k: 1.5 if i % 2 else 0.5 for i, k in enumerate(KEYS)}
    assert solved(rng, halves, 0.3)[0] == pytest.approx(0.5, abs=0.02)


def test_a_run_in_which_it_hardly_shows_does_not_say_how_large_it_is(rng: np.random.Generator) -> None:
    wrong = dict.fromkeys(KEYS, 1.0) | {KEYS[0]: 25.0}
    assert solved(rng, wrong, 0.3, {KEYS[0]: 0.02})[0] < 0.02
    assert solved(rng, wrong, 0.3, {KEYS[0]: 0.3})[0] > 1.0


def test_what_sensor_noise_makes_of_an_effect_says_nothing_of_its_size(rng: np.random.Generator) -> None:
    """A torque sensor's noise excites a resonance that the slow runs do not: its column is all noise there, and the
    reading, which has none of it, wants none of it. Four of six runs were called of another size for it."""
    shown = dict.fromkeys(KEYS, 0.0) | dict.fromkeys(KEYS[4:], 1.0)
    assert solved(rng, dict.fromkeys(KEYS, 1.0), 0.3, shown, spoilt=0.25)[0] < 0.1
    assert solved(rng, dict.fromkeys(KEYS, 1.0) | {KEYS[5]: 2.0}, 0.3, shown, spoilt=0.25)[0] > 0.5


def test_stretches_of_a_lone_run_tell_what_runs_would(rng: np.random.Generator) -> None:
    """A size that grows along the one run has its mean in it, and another one in every eighth of it."""
    lone = dict.fromkeys(KEYS, 0.0) | {KEYS[0]: 1.0}  # the others hardly show it
    grows = np.linspace(0.0, 2.0, 4000)
    whole, _, runs, _ = solved(rng, dict.fromkeys(KEYS, grows), 0.1, lone)
    stretched, _, stretches, _ = solved(rng, dict.fromkeys(KEYS, grows), 0.1, lone, parts=8)
    assert (whole < 0.1, runs) == (True, 1)
    assert (stretched > 0.5, stretches) == (True, 8)
    assert solved(rng, dict.fromkeys(KEYS, 1.0), 0.1, lone, parts=8)[0] < 0.02


def test_a_score_is_fair_within_a_fifth() -> None:
    plain = HeldOutScore("stribeck_friction", 1.0, 1.2, 0.9, 1.1, (), unsteady=0.1, apart=0.15)
    assert plain.fairly
    assert not replace(plain, true=1.3).fairly
    assert not replace(plain, unsteady=0.25).fairly
    assert not replace(plain, apart=0.25).fairly


def test_a_name_beside_a_loud_rest_takes_what_it_should() -> None:
    edge = HeldOutScore("torsional_mode", 0.81, 1.97, 1.39, 1.1, (), unsteady=0.15, apart=0.15)
    assert edge.named
    assert not replace(edge, true=1.21).named
    assert not replace(edge, unsteady=0.21).named
    assert replace(edge, true=1.21, left=1.2).named
    assert replace(edge, true=1.21, share=0.95).named


def test_a_score_is_plain_however_many_floors_its_law_leaves() -> None:
    plain = HeldOutScore("presliding_friction", 0.89, 46.0, 8.6, 0.99, (), unsteady=0.06, apart=0.06)
    assert plain.plain
    assert not replace(plain, runs=2).plain  # which have one size for want of others
    assert not replace(plain, share=0.75).plain
    assert not replace(plain, true=1.4).plain
    assert not replace(plain, unsteady=0.35).plain
    assert not replace(plain, apart=0.35).plain
    assert not replace(plain, stretched=0.35).plain


def found(frequency: float, *scales: tuple[float, float], zeta: tuple[float, ...] = ()) -> list[str]:
    """What stays unresolved of a mode at `frequency` Hz whose frequencies have those intervals."""
    damped = zeta or (0.04,) * len(scales)
    terms = tuple(Term(TorsionalMode(), (0.0, frequency, z, 0.0)) for z in damped)
    solution: Any = SimpleNamespace(design=SimpleNamespace(terms=terms))
    words = [Parameter(f"frequency_{i}" if i > 1 else "frequency", 50.0, c, "Hz") for i, c in enumerate(scales, 1)]
    return unresolved(solution, {"torsional_mode": words}, REACH)


def test_a_law_is_unresolved_only_when_no_term_of_it_shows_its_scale() -> None:
    assert found(50.0, (-3.0, 90.0)) == ["torsional_mode"]
    assert found(50.0, (-3.0, 90.0), (48.0, 52.0)) == []


def test_a_resonance_above_the_band_is_no_resonance() -> None:
    assert found(1.19 * REACH.band, (48.0, 52.0)) == ["torsional_mode"]


def test_a_mode_damped_until_it_is_no_peak_is_none_and_makes_no_other_ones_scale_known() -> None:
    """A jump of speeds had been fitted by two: one of 6 to 165 Hz, one of ζ = 0.4, the most that is fitted."""
    assert found(50.0, (48.0, 52.0), zeta=(0.4,)) == ["torsional_mode"]
    assert found(50.0, (6.0, 165.0), (48.0, 52.0), zeta=(0.29, 0.4)) == ["torsional_mode"]
    assert found(50.0, (6.0, 165.0), (48.0, 52.0), zeta=(0.29, 0.04)) == []


def held(**rows: int) -> Any:
    """Blocks by channel and run, as `M0`; run 9 has a locked output."""
    keys = {(int(name[1:]), name[0]): np.zeros(n) for name, n in rows.items()}
    return SimpleNamespace(y=keys, eq=SimpleNamespace(runs={i: SimpleNamespace(locked=i == 9) for i in range(10)}))


def test_an_effect_is_as_large_as_in_the_channel_it_does_most_in_over_all_its_runs() -> None:
    many_rows, few = {(0, "A"): 4000.0}, {(0, "R"): 400.0}
    d = held(A0=4000, A1=12000, R0=25)
    assert overall(many_rows, d) == pytest.approx(0.5)  # run 1 has none of it
    assert overall(few, d) == pytest.approx(4.0)
    assert overall(many_rows | few, d) == pytest.approx(4.0)


def test_the_torque_that_holds_a_locked_output_counts_only_for_what_acts_nowhere_else() -> None:
    d = held(M0=100, M9=100)
    assert overall({(9, "M"): 10_000.0, (0, "M"): 100.0}, d) == pytest.approx(1.0)
    assert overall({(9, "M"): 10_000.0}, d) == pytest.approx(np.sqrt(50.0))


def test_a_term_that_does_nothing_on_unseen_runs_has_no_share(monkeypatch: pytest.MonkeyPatch) -> None:
    """It was divided by what it does there: a campaign without a load encoder ended in an internal error."""
    key = (0, "A")
    part = SimpleNamespace(at=np.array([7]))
    d = SimpleNamespace(
        y={key: np.zeros(9)},
        parts={key: (part,)},
        terms=(SimpleNamespace(name="gap"),),
        place=lambda i: slice(7, 8),
        residual=lambda key, x: np.ones((9, x.shape[1])),
        noise={},
    )
    s = SimpleNamespace(x=np.zeros(8), design=d)
    at = SimpleNamespace(floors={key: 1.0}, residuals=lambda s, d, left=None: {key: np.ones(9)})
    monkeypatch.setattr(held_out_score, "without", lambda s, mine: s)
    (found,) = held_out_score.scores(cast(Any, s), cast(Any, d), cast(Any, at))
    assert (found.share, found.size, found.ground) == (0.0, 0.0, ())
    assert not found.named


def test_what_is_large_and_all_there_is_in_its_channels_is_no_part_of_a_rest() -> None:
    """Friction with a long tail: of one size, but of which single runs tell it hardly."""
    fall = HeldOutScore("stribeck_friction", 1.0, 4.8, 1.0, 0.97, (), unsteady=0.36, apart=0.36, anywhere=1.1)
    assert fall.all_there_is
    assert not fall.whatever_the_floor
    assert not replace(fall, size=2.4).all_there_is
    assert not replace(fall, anywhere=1.5).all_there_is
    assert not replace(fall, true=0.7).all_there_is
