"""Numbers of the paper's model that are no constants: what changes with what is said in a sentence, none is named."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.nameless.angles import WarmedMount
from rig.analysis.tracing.nameless.drags import OvalPulley, SectorDrag, SlowingDrag, UnevenDrag, WoundCable
from rig.analysis.tracing.nameless.errors import ErrorBySpeed, ErrorDrift
from rig.analysis.tracing.nameless.inertias import UnevenInertia
from rig.analysis.tracing.nameless.law import LONG
from rig.analysis.tracing.nameless.readings import TwoConstants, TwoGains
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.trace import trace
from rig.core.units import ARCSEC
from rig.model.effect import Effect, Fit, Port
from rig.model.effect.signals import Moved
from tests.analysis.tracing.spiked import Columns, spiked
from tests.analysis.tracing.test_gains import SOME
from tests.blind.cases import Request
from tests.blind.forms import OUTSIDE
from tests.blind.generate import write_case
from tests.contract.test_effects import KNOWN, REACH, motion


@pytest.mark.parametrize("law", [TwoConstants(), UnevenDrag()], ids=lambda law: law.name)
def test_what_differs_between_the_ways_is_even_in_them(law: Effect) -> None:
    for shape in law.shapes(REACH):
        forth, back = (next(iter(law.columns(motion(sign), shape).values())) for sign in (1.0, -1.0))
        np.testing.assert_allclose(forth, back)
        assert np.ptp(forth) > 0


def test_two_torque_constants_differ_by_a_tenth_at_most() -> None:
    """A friction that grows with the load, under weights that pull one way alone, wanted 0.42 of it."""

    def fit(share: float) -> Fit:
        return Fit(np.array([share]), (), np.eye(1), KNOWN, 50.0)

    assert all(TwoConstants().plausible(fit(share)) for share in (0.04, -0.04))
    assert not any(TwoConstants().plausible(fit(share)) for share in (0.21, -0.21))


def test_two_gains_are_one_gain_for_torque_of_one_sign() -> None:
    s = replace(motion(), torque=np.abs(motion().torque) + 1.0)
    alike, more = TwoGains().columns(s, ())[Port.READS_TAU_L].T
    np.testing.assert_array_equal(alike, s.torque)
    np.testing.assert_allclose(more, s.torque**2 / 50.0)


def test_friction_of_a_sector_takes_both_ways_and_a_pulley_gives_as_it_takes() -> None:
    loaded = [replace(motion(way), tau_ext=np.full(motion().t.size, -5.0)) for way in (1.0, -1.0)]
    there = [replace(s, theta_l=loaded[0].theta_l) for s in loaded]
    (drag, back), (pulls, again) = (
        [law.columns(s, ())[Port.LOAD_TORQUE] for s in there] for law in (SectorDrag(), OvalPulley())
    )
    np.testing.assert_allclose(drag, -back)
    np.testing.assert_array_equal(pulls, again)


@pytest.mark.parametrize(("side", "port"), [(0.0, Port.MOTOR_TORQUE), (1.0, Port.LOAD_TORQUE)])
def test_a_drag_that_grows_with_less_than_the_speed_brakes_the_motor_or_the_load(side: float, port: Port) -> None:
    s, drag = motion(), SlowingDrag()
    assert {shape[1] for shape in drag.shapes(REACH)} == {0.0, 1.0}
    made = drag.columns(s, (0.5, side))
    assert made.keys() == {port}
    speed = s.omega_l if side else s.omega_m
    assert np.all(made[port][:, 0] * speed >= 0)
    fit = Fit(np.array([0.2]), (0.5, side), np.eye(3), s.gear, s.ratio)
    assert drag.plausible(fit)
    assert ("of the load" if side else "of the motor") in drag.amount(fit).says


@pytest.mark.parametrize("theta_0", [0.5, 1e3])
def test_a_cable_gives_back_what_it_took_and_pulls_towards_where_it_was_not_wound(theta_0: float) -> None:
    s, cable = motion(), WoundCable()
    made = cable.columns(s, (theta_0,))[Port.LOAD_TORQUE][:, 0]
    np.testing.assert_array_equal(made, cable.columns(replace(s, way=-s.way), (theta_0,))[Port.LOAD_TORQUE][:, 0])
    work, ends = np.trapezoid(made, s.theta_l), s.theta_l[[0, -1]] / theta_0
    assert work == pytest.approx(np.diff(theta_0**2 * np.log(np.cosh(ends)))[0], rel=1e-4)
    fits = [Fit(np.array([k]), (theta_0,), np.eye(2) * 1e-4, s.gear, s.ratio) for k in (0.2, -0.2)]
    assert [cable.plausible(fit) for fit in fits] == [True, False]
    assert cable.amount(fits[0]).value == pytest.approx(0.2 * theta_0 * np.tanh(2 * np.pi / theta_0))


def test_a_cable_whose_clamp_slips_is_asked_for_where_the_output_goes_beyond_it() -> None:
    far = [shape for (shape,) in WoundCable().shapes(replace(REACH, load_turns=3.0))]
    assert far[1:] == [0.5, 2.0]
    assert far[0] > 100.0
    assert len(WoundCable().shapes(replace(REACH, load_turns=0.6))) == 3
    assert WoundCable().shapes(replace(REACH, load_turns=0.1)) == ()


def test_a_mount_that_warmed_in_a_fast_run_creeps_back_in_a_slow_one_and_reads_nothing_where_a_run_begins() -> None:
    t, gear = np.linspace(0.0, 90.0, 500), replace(KNOWN, tau_c=0.2)
    before, now = Moved(-61.0, -1.0, 40.0, 1600.0), Moved(0.0, 90.0, 1.0, 1.0)
    after = WarmedMount().columns(replace(motion(n=500), t=t, past=(before, now), gear=gear), (45.0,))
    cold = WarmedMount().columns(replace(motion(n=500), t=t, past=(now,), gear=gear), (45.0,))
    (creeps,), (warms,) = (made[Port.READS_THETA_L].T for made in (after, cold))
    assert creeps[0] == warms[0] == 0.0
    assert np.all(np.diff(creeps) < 0)
    assert np.all(np.diff(warms) > 0)
    power = 0.2 * 1.0 + KNOWN.B_m  # W
    assert warms[-1] == pytest.approx(power * 45.0 * (1 - np.exp(-2.0)) / WarmedMount.HEATED)


@pytest.mark.parametrize(("law", "shape"), [(ErrorDrift(), ()), (ErrorBySpeed(), (1.0,))], ids=["time", "speed"])
def test_the_lever_is_the_slope_of_the_error_along_the_motors_angle(law: Effect, shape: tuple[float, ...]) -> None:
    n = 2000
    turning = replace(motion(n=n), theta_m=np.linspace(0.0, 2.0, n), omega_m=np.full(n, 10.0), t=np.full(n, LONG))
    made = law.columns(turning, shape)
    slope = np.gradient(made[Port.KINEMATIC_ERROR], turning.theta_m, axis=0)
    np.testing.assert_allclose(made[Port.LEVER][5:-5], slope[5:-5], atol=1e-4)


def test_an_inertia_that_changes_along_the_turn_gives_back_what_it_took() -> None:
    """Its torque does no work over a swing but to change ½·J·ω²."""
    t = np.linspace(0.0, 1.3, 20_001)
    theta, omega, alpha = 2.0 * np.sin(3.0 * t), 6.0 * np.cos(3.0 * t), -18.0 * np.sin(3.0 * t)
    s = replace(motion(n=t.size), theta_l=theta, omega_l=omega, alpha_l=alpha)
    made = UnevenInertia().columns(s, ())[Port.LOAD_TORQUE]
    inertia = np.stack([np.cos(theta), np.sin(theta), np.cos(2 * theta), np.sin(2 * theta)], 1)
    kinetic = 0.5 * inertia * omega[:, None] ** 2
    work = np.trapezoid(made * omega[:, None], t, axis=0)
    np.testing.assert_allclose(work, kinetic[-1] - kinetic[0], atol=1e-5)


@pytest.mark.parametrize(("once", "twice", "possible"), [(0.5, 0.0, True), (1.2, 0.0, False), (0.1, 1.2, False)])
def test_an_inertia_is_at_no_angle_less_than_nothing(once: float, twice: float, possible: bool) -> None:
    J_l = KNOWN.J_l
    fit = Fit(np.array([once, 0.0, 0.0, twice]) * J_l, (), np.zeros((4, 4)), KNOWN, 50.0)
    assert UnevenInertia().plausible(fit) == possible


def test_what_a_campaign_cannot_show_is_not_searched_for() -> None:
    def laws(**reach: float) -> set[str]:
        covered = replace(REACH, **reach)
        return {c.effect.name for c in CONFOUNDERS.values() if c.effect.shapes(covered)}

    everything = laws()
    assert everything - laws(backwards=0.02) == {"sector_drag", "dragged_sensor"}
    # slow runs alone go both ways: any drag does so
    assert everything - laws(fast_backwards=0.02) == {"uneven_drag", "thrown_sensor"}
    assert everything - laws(turned_both_ways=0.1) == {"sector_drag"}  # of a turn: a weight does as much one way
    assert everything - laws(pulled=0.02) == {"two_gains", "two_constants", "sensor_jump", "even_spring"}
    assert everything - laws(torque=20.0) == {"sensor_curve"}
    assert everything - laws(weights=1) == {"oval_pulley", "sensor_scale"}
    drifting = {"spring_drift", "spring_by_warmth", "error_drift", "sensor_gain_drift", "constant_drift"}
    assert everything - laws(runs=2) == drifting | {"sensor_ripple", "thrown_sensor", "other_scale", "warmed_mount"}
    by_speed = {"error_by_speed", "spring_by_speed", "slowing_drag", "thrown_sensor", "other_scale", "warmed_mount"}
    assert everything - laws(slowest=REACH.fastest) == by_speed
    assert everything - laws(load_turns=0.1) == {"uneven_inertia", "wound_cable"}


def two_gains(c: Columns, began: float) -> Columns:
    return {"tau_l": c["tau_l"] + 0.01 * np.abs(c["tau_l"])}


def two_constants(c: Columns, began: float) -> Columns:
    return {"tau_m": c["tau_m"] + 0.04 * np.abs(c["tau_m"])}


MORNING: Final = float(np.datetime64("2026-11-01T09:00:00").astype(float))  # s, when the open campaign began


def constant_drift(c: Columns, began: float) -> Columns:
    return {"tau_m": c["tau_m"] * (1 + 0.03 * (began + c["t"] - MORNING) / LONG)}


def sensor_ripple(c: Columns, began: float) -> Columns:
    return {"tau_l": c["tau_l"] * (1 + 0.02 * np.cos(2 * c["theta_m"] + 0.3))}


def sensor_curve(c: Columns, began: float) -> Columns:
    share = (c["tau_l"] / 40.0) ** 2
    return {"tau_l": c["tau_l"] * (1 - 0.01 * share / (1 + share))}


def sensor_knee(c: Columns, began: float) -> Columns:
    beyond = np.maximum(np.abs(c["tau_l"]) - 30.0, 0.0)
    return {"tau_l": c["tau_l"] - 0.02 * beyond * np.sign(c["tau_l"])}


def dent(c: Columns, began: float) -> Columns:
    """30 arcsec, 0.1 rad wide, once a turn of the motor, and what it takes of the load's torque."""
    off, wide, high = (c["theta_m"] - 1.0 + np.pi) % (2 * np.pi) - np.pi, 0.1, 30 * ARCSEC
    bump = high * np.exp(-((off / wide) ** 2) / 2)
    return {"theta_l": c["theta_l"] - bump, "tau_m": c["tau_m"] + c["tau_l"] * bump * off / wide**2}


DIFFER = {two_gains: 2.0, two_constants: 8.0}  # %, between one way and the other


@pytest.mark.long
@pytest.mark.parametrize("law", [two_gains, two_constants])
def test_readings_of_two_gains_are_told_and_not_named(
    shared: Path, tmp_path: Path, law: Callable[[Columns, float], Columns]
) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", law, (*SOME, "lock_60_1", "lock_60_2"))
    told = CONFOUNDERS[law.__name__]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law_said in found.law if (match := re.search(r"larger by (\S+) ± (\S+) %", law_said))]
    assert float(much[1]) == pytest.approx(DIFFER[law], abs=1.5 * float(much[2]))


@pytest.mark.slow
@pytest.mark.long
def test_a_sensor_that_reads_more_one_way_in_slow_runs_and_lock_tests_alone_is_no_stiffness_of_an_angle(
    shared: Path, tmp_path: Path
) -> None:
    def square(c: Columns, began: float) -> Columns:
        return {"tau_l": c["tau_l"] + 8e-4 * c["tau_l"] ** 2 / 40.0}

    runs = ("slow_ke_1", "slow_ke_2", "lock_20_1", "lock_20_2", "lock_60_1", "lock_60_2")
    found = spiked(tmp_path, shared / "cases" / "open-1", square, runs)
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert found.verdict.coordinate == "load"


@pytest.mark.long
def test_a_torque_sensor_whose_scale_is_off_is_told_with_how_much(shared: Path, tmp_path: Path) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", lambda c, began: {"tau_l": 1.05 * c["tau_l"]}, SOME)
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert found.verdict.sentence == CONFOUNDERS["sensor_scale"].sentence
    (much,) = [match for said in found.law if (match := re.search(r"too much is (\S+) ± (\S+) %", said))]
    assert float(much[1]) == pytest.approx(100 * (1 - 1 / 1.05), abs=max(0.1, 1.5 * float(much[2])))


@pytest.mark.slow
@pytest.mark.long
def test_a_weight_that_shifts_the_load_angle_is_neither_a_spring_nor_a_creep(shared: Path, tmp_path: Path) -> None:
    def aside(c: Columns, began: float) -> Columns:
        locked, weight = np.ptp(c["theta_l"]) < 1e-3, round(float(c["tau_l"].mean()))  # a held one has none hung on it
        return {"theta_l": c["theta_l"] + (0.0 if locked else -1.2e-6 * weight)}

    found = spiked(tmp_path, shared / "cases" / "open-1", aside)
    told = CONFOUNDERS["pulled_aside"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law in found.law if (match := re.search(r"the angle by (\S+) ± (\S+) arcsec", law))]
    assert float(much[1].replace("−", "-")) == pytest.approx(1.2e-6 / ARCSEC, abs=max(0.01, 1.5 * float(much[2])))


@pytest.mark.slow
@pytest.mark.long
def test_a_load_angle_to_another_scale_loses_no_counts_and_comes_late_at_no_speed(shared: Path, tmp_path: Path) -> None:
    def rounded(c: Columns, began: float) -> Columns:
        return {"theta_l": c["theta_l"] * (1 + 9e-6)}

    found = spiked(tmp_path, shared / "cases" / "open-1", rounded)
    told = CONFOUNDERS["other_scale"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law in found.law if (match := re.search(r"too much by (\S+) ± (\S+) arcsec", law))]
    assert float(much[1]) == pytest.approx(9e-6 * 2 * np.pi / ARCSEC, abs=max(0.2, 1.5 * float(much[2])))


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_sensor_that_is_thrown_outward_goes_with_the_speed_and_drags_no_motor(
    shared: Path, tmp_path: Path
) -> None:
    def thrown(c: Columns, began: float) -> Columns:
        return {"tau_l": c["tau_l"] + 0.3 * (np.gradient(c["theta_m"], c["t"]) / 40.0) ** 2}

    found = spiked(tmp_path, shared / "cases" / "open-1", thrown)
    told = CONFOUNDERS["thrown_sensor"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law in found.law if (match := re.search(r"reads too much by (\S+) ± (\S+) N", law))]
    assert float(much[1]) == pytest.approx(0.3, abs=max(0.03, 1.5 * float(much[2])))


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_sensor_whose_own_bearing_drags_winds_nothing_up(shared: Path, tmp_path: Path) -> None:
    def dragged(c: Columns, began: float) -> Columns:
        locked = np.ptp(c["theta_l"]) < 1e-3
        return {"tau_l": c["tau_l"] + (0.0 if locked else 0.4 * np.sign(np.gradient(c["theta_m"])))}

    kinds = ("slow_ke", "speed_120rpm", "speed_minus200rpm", "speed_300rpm", "lock_60")
    found = spiked(tmp_path, shared / "cases" / "open-1", dragged, [f"{kind}_{k}" for kind in kinds for k in (1, 2)])
    told = CONFOUNDERS["dragged_sensor"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law in found.law if (match := re.search(r"its own: it is (\S+) ± (\S+) N", law))]
    assert float(much[1]) == pytest.approx(0.4, abs=max(0.04, 1.5 * float(much[2])))


@pytest.mark.slow
@pytest.mark.long
def test_a_sensor_that_feels_bending_by_as_much_as_it_carries_has_crosstalk(shared: Path, tmp_path: Path) -> None:
    def bends(c: Columns, began: float) -> Columns:
        return {"tau_l": c["tau_l"] * (1 + 0.012 * np.cos(c["theta_l"] + 0.7))}

    found = spiked(tmp_path, shared / "cases" / "open-1", bends, SOME)
    assert found.verdict.effects == ("torque_sensor_crosstalk",)
    told = {p.name: p for p in found.effects[0].parameters}["order_1_of_the_torque_amplitude"]
    assert told.value == pytest.approx(0.012, abs=max(4e-4, 1.5 * (told.ci95[1] - told.value)))
    assert told.unit == "1"


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_sensor_that_compresses_is_told_and_no_spring_is_named(shared: Path, tmp_path: Path) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", sensor_curve)
    told = CONFOUNDERS["sensor_curve"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law in found.law if (match := re.search(r"at 50 N·m it reads too much by −(\S+) ±", law))]
    assert float(much[1]) == pytest.approx(0.01 * 50 * 1.5625 / 2.5625, rel=0.15)


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_sensor_that_gives_way_near_its_end_is_told_with_where(shared: Path, tmp_path: Path) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", sensor_knee)
    told = CONFOUNDERS["sensor_curve"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [
        match for law in found.law if (match := re.search(r"exceeds (\S+) N·m it reads too much by −(\S+) ±", law))
    ]
    assert float(much[1]) == pytest.approx(30.0, rel=0.1)
    assert float(much[2]) == pytest.approx(2.0, rel=0.15)


@pytest.mark.slow
@pytest.mark.long
def test_a_dent_in_a_race_is_told_and_no_ripple_is_named_for_its_lever(shared: Path, tmp_path: Path) -> None:
    still = [
        run.name for run in (shared / "cases" / "open-1").iterdir() if run.name.startswith(("slow", "load", "lock"))
    ]
    found = spiked(tmp_path, shared / "cases" / "open-1", dent, still)  # at speed it would shake the load as well
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert found.verdict.coordinate == "motor_angle"


@pytest.mark.slow
@pytest.mark.long
def test_gauges_that_feel_the_wave_generator_are_told_with_how_much(shared: Path, tmp_path: Path) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", sensor_ripple, (*SOME, "lock_60_1", "lock_60_2"))
    told = CONFOUNDERS["sensor_ripple"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law in found.law if (match := re.search(r"turn by (\S+) ± (\S+) % of the torque", law))]
    assert float(much[1]) == pytest.approx(2.0, abs=1.5 * float(much[2]))


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_constant_that_changes_through_the_campaign_is_told_with_how_much(
    shared: Path, tmp_path: Path
) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", constant_drift, SOME)
    told = CONFOUNDERS["constant_drift"]
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.sentence) == (told.coordinate, told.sentence)
    (much,) = [match for law in found.law if (match := re.search(r"changes by (\S+) ± (\S+) %", law))]
    assert float(much[1]) == pytest.approx(3.0, rel=0.05)  # as read: of what is told, which has grown


OF_THE_BLIND_PLANT: Final = ("growing_error", "stiffness_aging", "one_way_drag", "sensor_gain_temperature")


@pytest.mark.long
@pytest.mark.parametrize("form", OF_THE_BLIND_PLANT)
def test_what_the_blind_plant_lets_drift_is_told(tmp_path: Path, form: str) -> None:
    write_case(Request("outside", 11, "complete", form, over_floor=3.0), tmp_path, "case")
    verdict = trace(tmp_path / "case").verdict
    (made,) = [one for one in OUTSIDE if one.effect == form]
    assert verdict.status is Status.UNKNOWN
    assert verdict.effects == ()
    assert verdict.coordinate in made.coordinates
