"""Every claim holds on data that obey it, fails on data that violate it, and is open where nothing was measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rig.analysis.reproduction import (
    figure_2,
    figure_3,
    figure_6,
    figure_7,
    figure_9,
    figure_10,
    figure_11,
    figure_13,
    load_effect,
    table_1,
    table_2,
)
from rig.analysis.reproduction.catalogue import exhibits
from rig.analysis.reproduction.claim import Claim, Number, Ruling
from rig.analysis.reproduction.figure_10 import Fitted
from rig.analysis.reproduction.load_effect import UnderLoad
from rig.model.gearfile import Parameter
from tests.analysis.reproduction.campaigns import (
    GEAR,
    campaign,
    fast,
    scaled,
    slow,
    split,
    with_torque_times,
    without_torque,
)

TICK, CROSS, DASH = Ruling.HOLDS, Ruling.FAILS, Ruling.OPEN


def arcsec(*values: float, half: float = 0.5) -> list[Number]:
    return [Number.of(v, half, "arcsec") for v in values]


def curve(**at: float) -> list[tuple[float, Number]]:
    """Peak to peak by load; the keys are loads in tenths of a newton metre."""
    return [(float(load[1:]) / 10.0, Number.of(size, 0.5, "arcsec")) for load, size in at.items()]


FALLING = curve(_0=80, _20=70, _50=58, _75=54, _150=53)
SMOOTH = np.cos(2 * np.linspace(0, 2 * np.pi, 512, endpoint=False))
ROUGH = SMOOTH + 0.3 * np.cos(20 * np.linspace(0, 2 * np.pi, 512, endpoint=False))
NOISE = 0.001 * np.random.default_rng(1).standard_normal((12, 512))
DEEPER = [
    Fitted(0.0, 80, 50),
    Fitted(0.0, 79, 50.5),
    Fitted(0.0, 81, 49.5),
    Fitted(0.15, 74, 50),
    Fitted(0.3, 66, 50.2),
]
SCATTERED = [*DEEPER[:3], Fitted(0.0, 60, 38), Fitted(0.3, 66, 50)]
SINKING = [replace(a, plateau=50 - 40 * a.depth_mm) for a in DEEPER]
K1, K3, SAME_K = (Number.of(k, 100.0, "N·m/rad") for k in (7200.0, 11400.0, 7250.0))
JUDGED: list[tuple[str, Callable[[], Claim], Ruling]] = [
    ("order 2 leads", lambda: figure_2.twice(arcsec(4, 37, 2, 17)), TICK),
    ("order 4 leads", lambda: figure_2.twice(arcsec(4, 17, 2, 37)), CROSS),
    ("orders 2 and 4 alike", lambda: figure_2.twice(arcsec(4, 37.2, 2, 37)), DASH),
    ("line at 600", lambda: figure_3.strongest(601.0, 300.0, 5.0, 1.0), TICK),
    ("line at 300", lambda: figure_3.strongest(300.0, 300.0, 5.0, 1.0), CROSS),
    ("fifteen terms", lambda: figure_6.suffices(SMOOTH + NOISE), TICK),
    ("order 20 is there", lambda: figure_6.suffices(ROUGH + NOISE), CROSS),
    ("two turns only", lambda: figure_6.suffices(ROUGH + NOISE[:2]), DASH),
    ("larger at speed", lambda: figure_7.larger(*arcsec(117, 79)), TICK),
    ("smaller at speed", lambda: figure_7.larger(*arcsec(60, 79)), CROSS),
    ("falls", lambda: figure_9.falls(FALLING), TICK),
    ("rises", lambda: figure_9.falls(curve(_0=50, _75=54, _150=53)), CROSS),
    ("no run at 7.5 N·m", lambda: figure_9.falls(curve(_0=80, _20=70)), DASH),
    ("no run without load", lambda: figure_9.falls(curve(_20=70, _75=54, _150=53)), DASH),
    ("falls at every step", lambda: figure_9.steadily(FALLING, ""), TICK),
    ("rises at first", lambda: figure_9.steadily(curve(_0=80, _10=83, _75=54), ""), CROSS),
    ("flat", lambda: figure_9.levels(FALLING), TICK),
    ("falls on", lambda: figure_9.levels(curve(_0=80, _75=54, _150=40)), CROSS),
    ("rises again", lambda: figure_9.levels(curve(_0=80, _75=54, _150=70)), CROSS),
    ("nothing beyond 7.5 N·m", lambda: figure_9.levels(curve(_0=80, _75=54)), DASH),
    ("flat because it never fell", lambda: figure_9.levels(curve(_0=54, _75=54.1, _150=60)), CROSS),
    ("deeper is smaller", lambda: figure_10.smaller(DEEPER), TICK),
    ("deeper is larger", lambda: figure_10.smaller([replace(a, depth_mm=-a.depth_mm) for a in DEEPER]), CROSS),
    ("fitting anew does as much", lambda: figure_10.smaller(SCATTERED), DASH),
    ("three assemblies", lambda: figure_10.smaller(DEEPER[2:]), DASH),
    ("one depth", lambda: figure_10.smaller([replace(a, depth_mm=0.0) for a in DEEPER]), DASH),
    ("less goes with load", lambda: figure_10.less(DEEPER), TICK),
    ("more goes with load", lambda: figure_10.less([replace(a, depth_mm=-a.depth_mm) for a in DEEPER]), CROSS),
    ("one plateau", lambda: figure_10.same(DEEPER), TICK),
    ("plateau falls with depth", lambda: figure_10.same(SINKING), CROSS),
    ("grows", lambda: figure_11.grows(arcsec(90, 113, 127), [120, 300, 500]), TICK),
    ("does not grow", lambda: figure_11.grows(arcsec(90, 113, 100), [120, 300, 500]), CROSS),
    ("500 rpm is missing", lambda: figure_11.grows(arcsec(90, 113), [120, 300]), DASH),
    ("higher orders grow", lambda: figure_11.higher(arcsec(8, 12, 15), [120, 300, 500]), TICK),
    ("higher orders fall", lambda: figure_11.higher(arcsec(8, 15, 12), [120, 300, 500]), CROSS),
    ("worse at 500", lambda: figure_11.worse(arcsec(1, 2, 4)), TICK),
    ("better at 500", lambda: figure_11.worse(arcsec(1, 4, 2)), CROSS),
    ("as good at 500", lambda: figure_11.worse(arcsec(1, 2, 2.2)), DASH),
    ("hardening", lambda: figure_13.hardens({"stiffness_K1": K1, "stiffness_K3": K3}), TICK),
    ("softening", lambda: figure_13.hardens({"stiffness_K1": K3, "stiffness_K3": K1}), CROSS),
    ("straight", lambda: figure_13.hardens({"stiffness_K1": K1, "stiffness_K3": SAME_K}), DASH),
    ("the paper's K", lambda: figure_13.slope({"stiffness_K1": K1}), TICK),
    ("another K", lambda: figure_13.slope({"stiffness_K1": K3}), CROSS),
    ("no lines", lambda: figure_13.slope({}), DASH),
    ("friction", lambda: table_1.friction(Parameter(0.3, (0.29, 0.31))), TICK),
    ("friction not told", lambda: table_1.friction(Parameter(0.1, (-0.1, 0.3))), DASH),
    ("friction assumed", lambda: table_1.friction(Parameter(0.3, origin="assumed")), DASH),
    ("order 2 is most", lambda: table_2.leads(np.array([4.0, 37, 2]), np.full(3, 0.1)), TICK),
    ("order 2 is a third", lambda: table_2.leads(np.array([37.0, 37, 37]), np.full(3, 0.1)), CROSS),
]  # fmt: skip


@pytest.mark.parametrize(("claim", "ruling"), [pytest.param(c, r, id=name) for name, c, r in JUDGED])
def test_a_claim_is_ruled_by_its_numbers(claim: Callable[[], Claim], ruling: Ruling) -> None:
    found = claim()
    assert found.ruling is ruling, found
    assert found.words.count("{}") == len(found.numbers)
    assert found.rule or not found.numbers


@pytest.mark.slow
def test_the_true_gear_explains_what_speed_adds_and_a_gear_of_half_the_stiffness_does_not() -> None:
    assert figure_7.explained(split(310.0), "model").ruling is TICK
    soft = figure_7.explained(split(310.0, replace(GEAR, K=3500.0)), "model")
    assert soft.ruling is CROSS
    assert soft.numbers[0].value < 50.0


def test_without_a_model_nothing_is_explained() -> None:
    found = replace(split(310.0), simulated=None)
    assert figure_7.explained(found, "model").ruling is DASH


def test_the_sum_holds_with_the_true_torque_and_fails_with_a_sensor_of_half_the_gain() -> None:
    runs = campaign([slow(), fast(310.0)])
    true = split(310.0)
    assert figure_7.adds_up(runs, true).ruling is TICK
    assert figure_7.adds_up(runs, replace(true, reading=with_torque_times(true.reading, 0.5))).ruling is CROSS


def test_without_a_torque_sensor_the_sum_is_a_definition_and_gets_no_tick() -> None:
    true = split(310.0)
    found = figure_7.adds_up(campaign([slow(), fast(310.0)]), replace(true, reading=without_torque(true.reading)))
    assert found.ruling is DASH


def test_slow_is_slow_enough_where_twice_the_speed_gives_the_same_and_not_where_it_gives_more() -> None:
    error = slow().slow[0]
    assert figure_7.settled(error, [slow(hertz=0.02).slow[0]]).ruling is TICK
    assert figure_7.settled(error, [slow(kept=1.2, hertz=0.02).slow[0]]).ruling is CROSS
    assert figure_7.settled(error, [error]).ruling is DASH


def test_the_load_explains_the_misfit_only_where_less_is_left_with_it() -> None:
    true = split(500.0)
    assert true.simulated is not None
    wrong = replace(true, simulated=true.simulated * 1.15)  # as a model whose pure error is too large
    right = UnderLoad(true.simulated, 0.87, 1.0, 1.5, 3.0)
    assert load_effect.why_worse(wrong, right).ruling is TICK
    assert load_effect.why_worse(wrong, replace(right, simulated=true.simulated * 1.3)).ruling is CROSS
    assert load_effect.why_worse(wrong, None).ruling is DASH
    assert load_effect.why_worse(None, right).ruling is DASH


def test_a_campaign_without_runs_has_dashes_alone_and_says_what_it_would_take() -> None:
    made = exhibits(campaign([], None))
    assert {c.ruling for e in made for c in e.claims} == {DASH}
    assert all(e.missing and not e.curves and not e.rows for e in made)


def test_runs_of_one_kind_give_their_figures_and_dashes_for_the_rest() -> None:
    made = {e.number: e for e in exhibits(campaign([slow(), fast(300.0)], None))}
    assert made["Figure 2"].claims[0].ruling is TICK
    assert made["Figure 3"].claims[0].ruling is TICK
    assert made["Figure 6"].claims[0].ruling is TICK
    assert {c.ruling for name in ("Figure 9", "Figure 10", "Figure 13", "Table 1") for c in made[name].claims} == {DASH}
    assert made["Figure 11 b"].claims[0].ruling is DASH  # measured, and no model to set beside it
    assert "turn.model" not in made["Figure 11 b"].curves


@pytest.mark.slow
def test_load_and_depth_come_out_of_whole_runs() -> None:
    kept = {0.0: 1.0, 2.0: 0.8, 7.5: 0.6, 15.0: 0.59}
    runs = [slow(k, load) for load, k in kept.items()]
    deep = [slow(k, load, 0.3, 2) for load, k in {0.0: 0.8, 15.0: 0.59}.items()]
    made = {e.number: e for e in exhibits(campaign([*runs, *deep]))}
    assert [c.ruling for c in made["Figure 9"].claims] == [TICK, TICK, TICK]
    assert made["Figure 9"].curves["load.load"].tolist() == [0.0, 2.0, 7.5, 15.0]
    assert {c.ruling for c in made["Figure 10"].claims} == {DASH}  # two assemblies: no telling depth from fitting anew


def test_a_run_in_which_the_motor_stuck_does_not_count() -> None:
    stuck = replace(slow(), slow=(), rejected=("The motor did not run smoothly.",))
    found = campaign([stuck])
    assert found.pure() is None
    assert "did not run smoothly" in found.left_out[0]


def test_the_pure_error_follows_the_load_curve_at_the_torque_that_is_carried() -> None:
    way = load_effect.Way
    ways = [
        way(d, tau, size, 0.1, 6)
        for d, tau, size in ((1, 1.0, 24.0), (-1, -1.0, 24.2), (1, 2.0, 22.0), (-1, -4.0, 19.0))
    ]
    torque, size = load_effect.shrinking(ways, zero=0.0) or (None, None)
    assert torque is not None
    assert size is not None
    assert torque.tolist() == [1.0, 2.0, 4.0]
    assert size.tolist() == pytest.approx([24.1, 22.0, 19.0])
    assert scaled(0.5).peak_to_peak() == pytest.approx(0.5 * GEAR.kinematic_error.peak_to_peak())
