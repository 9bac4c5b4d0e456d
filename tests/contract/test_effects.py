"""What every effect of the library promises."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Term, acting
from rig.analysis.tracing.floor.own_delays import OwnDelays
from rig.analysis.tracing.floor.steps import Steps
from rig.analysis.tracing.floor.vibration import Line, Vibration
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.model.effect import MEASURED, Effect, Fit, Known, Port, Reach, Signals
from rig.model.effect.signals import Moved
from rig.model.effects import CATALOGUE, EACH_RUN, LIBRARY, missed_counts
from rig.model.effects.presliding_friction import EACH_WAY
from rig.model.fourier import FourierSeries
from rig.model.gloss import gloss
from rig.model.references import REFERENCES
from rig.report.trace.words import PARAMETERS

N, DT = 50.0, 0.001
KNOWN = Known(7000.0, 5.0, 1.5e-3, 0.8, FourierSeries((1e-5, 2e-4, 0.0), (0.0, 1e-4, 1e-5)))
REACH = Reach(
    ratio=N, fastest=50.0, slowest=1.0, torque=40.0, duration=2700.0, rate=1000.0, band=72.0, load_turns=1.0,
    counts_m=65536, counts_l=1_296_000, has=MEASURED | {"temperature"},
)  # fmt: skip
FRICTION = {"stribeck_friction", "load_dependent_friction", "quadratic_drag"}
ANGLE_LOCKED = {"output_once_per_rev", "flexspline_frame_error", "tooth_mesh_error", "load_dependent_kinematic_error"}
KNOWN_LAWS = (*LIBRARY.values(), *(confounder.effect for confounder in CONFOUNDERS.values()))
every_effect = pytest.mark.parametrize("effect", LIBRARY.values(), ids=list(LIBRARY))


def motion(sign: float = 1.0, n: int = 4000) -> Signals:
    """A motor that speeds up and slows down one way, under a torque that swings through zero."""
    t = np.arange(n) * DT
    omega = sign * (6.0 + 4.0 * np.sin(2 * np.pi * 0.4 * t))
    theta = np.concatenate([[0.0], np.cumsum((omega[1:] + omega[:-1]) / 2)]) * DT + 0.3
    alpha = np.gradient(omega, DT)
    torque = sign * 25.0 * np.sin(2 * np.pi * 0.7 * t + 0.2)
    nothing = np.zeros(n)
    return Signals(
        t=t, dt=DT, ratio=N, theta_m=theta, theta_l=theta / N, omega_m=omega, alpha_m=alpha, omega_l=omega / N,
        alpha_l=alpha / N, torque=torque, torque_rate=np.gradient(torque, DT),
        tau_m=0.3 * np.sign(omega) + torque / N, tau_l=torque, tau_ext=nothing,
        way=np.sign(omega), temperature=25.0 + 4.0 * np.sin(0.7 * t), gear=KNOWN,
    )  # fmt: skip


def from_rest(sign: float) -> Signals:
    """The same, from rest on, after a run that warmed the drive."""
    s = motion(sign)
    warming, rubs = (Moved(s.t[0] - 60.0, s.t[0] - 1.0, 20.0, 400.0),), dataclasses.replace(KNOWN, tau_c=0.2)
    return dataclasses.replace(s, omega_m=np.r_[0.0, s.omega_m[1:]], past=warming, gear=rubs)


@every_effect
def test_its_file_its_name_and_its_source_agree(effect: Effect):
    assert type(effect).__module__.rsplit(".", 1)[1] == effect.name
    assert effect.source.split(",")[0] in REFERENCES
    assert effect.in_short
    assert len(effect.shape_names) == len(effect.loose)


def all_shapes(effect: Effect) -> list[tuple[float, ...]]:
    """Those a search tries, and those that are tried beside another term of it."""
    return [*effect.shapes(REACH), *effect.shapes_beside(REACH)]


@pytest.mark.slow
@every_effect
def test_columns_are_finite_and_as_many_at_every_port_for_every_shape(effect: Effect):
    shapes = effect.shapes(REACH)
    assert shapes, "a complete campaign can show it"
    for shape in all_shapes(effect):
        assert len(shape) == len(effect.shape_names)
        ports = effect.columns(motion(), shape)
        assert len({c.shape for c in ports.values()}) == 1, shape
        for columns in ports.values():
            assert columns.shape[0] == motion().t.size
            assert np.isfinite(columns).all(), shape


@every_effect
def test_a_refit_that_moves_the_shape_within_its_bounds_stays_finite(effect: Effect):
    shapes = effect.shapes(REACH)
    if not effect.shape_names:
        return
    bounds = effect.bounds(REACH)
    assert len(bounds) == len(effect.shape_names)
    for end in (0, 1):
        loose = [b[end] if free else s for b, free, s in zip(bounds, effect.loose, shapes[0], strict=True)]
        assert all(np.isfinite(c).all() for c in effect.columns(motion(), tuple(loose)).values())


@every_effect
def test_parameters_have_a_name_a_unit_and_an_interval_around_the_value(effect: Effect):
    shape = effect.shapes(REACH)[0]
    k = next(iter(effect.columns(motion(), shape).values())).shape[1]
    size = k + len(shape)
    fit = Fit(np.linspace(0.01, 0.02, k), shape, np.eye(size) * 1e-6, KNOWN, N)
    for p in effect.parameters(fit):
        assert p.name
        assert p.unit
        assert p.ci95[0] <= p.value <= p.ci95[1]
        assert np.isfinite([p.value, *p.ci95]).all()
    assert isinstance(effect.plausible(fit), bool)


@every_effect
def test_what_an_effect_softens_the_gear_by_has_the_gradient_it_says(effect: Effect):
    for shape in dict.fromkeys((x[0], x) if x else ((), ()) for x in all_shapes(effect)):
        at = shape[1]
        k = next(iter(effect.columns(motion(n=50), at).values())).shape[1]
        scale = np.resize([0.05, 4e-6], k)  # as of an inertia and its 1/ω²
        fit = Fit(scale, at, np.zeros((k + len(at), k + len(at))), KNOWN, N)
        _, gradient = effect.softens(fit)
        for j in range(k):
            steps = [scale + sign * 1e-4 * scale[j] * (np.arange(k) == j) for sign in (1.0, -1.0)]
            up, down = (effect.softens(dataclasses.replace(fit, coefficients=x))[0] for x in steps)
            assert gradient[j] == pytest.approx((up - down) / (2e-4 * scale[j]), rel=1e-4, abs=1e-12)


@every_effect
def test_what_counts_twice_in_the_damping_is_a_law_in_the_spring(effect: Effect):
    for shape in all_shapes(effect):
        share = effect.drags(shape)
        assert 0.0 <= share <= 1.0
        assert not share or (effect.in_the_spring and Port.WIND_UP in effect.columns(motion(n=50), shape))


def named(effect: Effect) -> set[str]:
    """What the parameters of `effect` are called, whatever its shape, and what the detectors of each run's own say."""
    own = {"external_vibration": shaken(), "missed_counts": lost(), "channel_time_skew": late()}
    names = own.get(effect.name, set())
    for shape in all_shapes(effect):
        k = next(iter(effect.columns(motion(n=50), shape).values())).shape[1]
        size = k + len(shape)
        fit = Fit(np.linspace(0.01, 0.02, k), shape, np.eye(size) * 1e-6, KNOWN, N)
        names = names | {p.name for p in effect.parameters(fit)}
    return names


def shaken() -> set[str]:
    line = Line(8.0, {"L": 1.0}, 0.1, 0.1, 1.0)
    return {p.name for p in Vibration((line, line), {}).parameters()}


def lost() -> set[str]:
    sides = {0: (missed_counts.LOAD, missed_counts.MOTOR)}
    return {p.name for p in Steps({0: (5, 9)}, {0: (1e-3, 2e-3)}, sides, {0: (1e-5, 1e-5)}).parameters()}


def late() -> set[str]:
    delays = {run: np.array([1e-4, 2e-4]) for run in range(3)}
    return {p.name for p in OwnDelays({}, delays, wander=True).parameters()}


@every_effect
def test_every_parameter_has_a_gloss_and_every_gloss_a_parameter(effect: Effect):
    names = named(effect)
    assert names
    assert {name for name in names if not effect.gloss(name)} == set()
    assert len({effect.gloss(name) for name in names}) == len(names), "two parameters are not told apart"
    for key in effect.glosses:
        assert any(gloss({key: "said"}, name) for name in names), f"no parameter is called {key}"


def test_a_gloss_says_the_order_and_that_a_parameter_is_of_another_term():
    glosses = {"order_{n}_amplitude": "order {n}", "lag": "a lag"}
    assert gloss(glosses, "order_2.04_amplitude") == "order 2.04"
    assert gloss(glosses, "order_2.04_amplitude_3") == "order 2.04 (another of its kind)"
    assert gloss(glosses, "lag_2") == "a lag (another of its kind)"
    assert gloss(glosses, "lagged") == gloss(glosses, "order_amplitude") == ""


def test_lag_is_told_in_other_words_in_the_baseline_and_in_the_effect_that_has_one():
    own = LIBRARY["load_dependent_kinematic_error"].gloss("lag")
    assert "follows the torque" in own
    assert PARAMETERS["lag"][1] != own


@pytest.mark.parametrize("name", sorted(FRICTION))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_friction_never_gives_energy(name: str, sign: float):
    effect, s = CATALOGUE[name], motion(sign)
    for shape in effect.shapes(REACH):
        ((port, columns),) = effect.columns(s, shape).items()
        omega = {Port.MOTOR_TORQUE: s.omega_m, Port.LOAD_TORQUE: s.omega_l}[port]
        assert (columns * omega[:, None] >= 0).all()


@pytest.mark.parametrize("name", sorted(FRICTION | {"presliding_friction", "thermal_friction_drift"}))
def test_friction_is_the_same_both_ways(name: str):
    effect = CATALOGUE[name]
    forward, backward = from_rest(1.0), from_rest(-1.0)  # friction that builds up is none where the run began in motion
    backward = dataclasses.replace(
        backward, theta_m=-forward.theta_m, theta_l=-forward.theta_l, omega_l=-forward.omega_l
    )
    for shape in effect.shapes(REACH):
        (ahead,), (back,) = (effect.columns(s, shape).values() for s in (forward, backward))
        said = dict(zip(effect.shape_names, shape, strict=True))
        if said.get("by_way") or (name == "presliding_friction" and said["law"] == EACH_WAY):
            ahead, back = ahead.sum(1), back.sum(1)  # a coefficient for either way: alike where those are
        assert np.any(ahead)
        np.testing.assert_allclose(ahead, -back, atol=1e-12)


@pytest.mark.parametrize("name", sorted(ANGLE_LOCKED))
def test_the_lever_is_the_slope_of_the_kinematic_error(name: str):
    s = motion()
    s = dataclasses.replace(s, theta_m=s.theta_m / 50, theta_l=s.theta_l / 50, torque=np.full(4000, 3.0))
    effect = CATALOGUE[name]
    for shape in effect.shapes(REACH):
        ports = effect.columns(s, shape)
        step = np.diff(ports[Port.KINEMATIC_ERROR], axis=0)
        middle = (ports[Port.LEVER][1:] + ports[Port.LEVER][:-1]) / 2 * np.diff(s.theta_m)[:, None]
        most = np.abs(step).max()
        np.testing.assert_allclose(step, middle, atol=1e-3 * most)


@pytest.mark.parametrize("name", ["nonlinear_stiffness", "lost_motion"])
def test_an_elastic_law_is_odd_in_the_torque(name: str):
    effect = CATALOGUE[name]
    s = dataclasses.replace(motion(), gear=dataclasses.replace(KNOWN, B_sp=0.0))  # what the damper takes is no spring's
    turned = dataclasses.replace(s, torque=-s.torque)
    for shape in effect.shapes(REACH):
        np.testing.assert_allclose(effect.columns(s, shape)[Port.WIND_UP], -effect.columns(turned, shape)[Port.WIND_UP])


def test_no_two_effects_have_the_same_footprint():
    runs = (from_rest(1.0), from_rest(-1.0))
    seen: list[tuple[str, dict[Port, np.ndarray]]] = []
    for effect in LIBRARY.values():
        made = [effect.columns(s, effect.shapes(REACH)[0]) for s in runs]
        columns = {port: np.concatenate([m[port][:, 0] for m in made]) for port in made[0]}
        for other, theirs in seen:
            same = set(columns) == set(theirs) and all(
                abs(np.corrcoef(columns[p], theirs[p])[0, 1]) > 0.999 for p in columns if columns[p].std() > 0
            )
            assert not same, f"{effect.name} looks like {other}"
        seen.append((effect.name, columns))


@pytest.mark.parametrize("name", sorted(EACH_RUN))
def test_what_every_run_has_to_itself_is_said_to_be_so(name: str):
    assert EACH_RUN[name].each_run


def test_counts_lost_again_and_again_go_with_the_way_and_not_with_the_ratio():
    effect, forward, backward = CATALOGUE["missed_counts"], motion(1.0), motion(-1.0)
    turns = forward.theta_l[-1] / (2 * np.pi) - forward.theta_l[0] / (2 * np.pi)
    for law, back in ((missed_counts.GONE, -1.0), (missed_counts.FURTHEST, -1.0), (missed_counts.TURNED, 1.0)):
        ends = [effect.columns(s, (law, 0.0))[Port.READS_THETA_L][-1, 0] for s in (forward, backward)]
        np.testing.assert_allclose(ends, [-turns, back * turns], rtol=1e-3)
    assert (missed_counts.TURNED, 0.0) not in effect.shapes(REACH), "another ratio does the same"
    alike = dataclasses.replace(REACH, fastest=1.2 * REACH.slowest)
    assert effect.shapes(alike) == (), "at one speed the way is the time"
    assert effect.shapes(dataclasses.replace(REACH, runs=2)) == (), "in one log it is the time, and an angle"


def test_counts_lost_one_way_are_kept_on_the_way_back():
    effect, forward, backward = CATALOGUE["missed_counts"], motion(1.0), motion(-1.0)
    turns = (forward.theta_l[-1] - forward.theta_l[0]) / (2 * np.pi)
    for law, ends in ((missed_counts.FORTH, [-turns, 0.0]), (missed_counts.BACK, [0.0, -turns])):
        got = [effect.columns(s, (law, 0.0))[Port.READS_THETA_L][-1, 0] for s in (forward, backward)]
        np.testing.assert_allclose(got, ends, rtol=1e-3, atol=1e-9)
        assert (law, 0.0) in effect.shapes(REACH)
        assert (law, 0.0) not in effect.shapes(dataclasses.replace(REACH, backwards=0.0)), "that is whichever way"


def test_counts_lost_above_a_speed_are_lost_nowhere_below_it():
    effect, s = CATALOGUE["missed_counts"], motion()  # from 2 to 10 rad/s
    (lost,) = effect.columns(s, (missed_counts.GONE, 8.0)).values()
    slow = np.abs(s.omega_m[1:]) < 7.9
    assert (np.diff(lost[:, 0])[slow] == 0).all()
    assert (np.diff(lost[:, 0])[np.abs(s.omega_m[1:]) > 8.1] < 0).all()


def test_lost_counts_are_a_step_at_their_instant_and_nothing_else():
    effect, s = EACH_RUN["missed_counts"], motion()
    for side, port in ((0.0, Port.READS_THETA_L), (1.0, Port.READS_THETA_M)):
        (column,) = effect.columns(s, (side, 1.5)).values()
        assert set(effect.columns(s, (side, 1.5))) == {port}
        assert (column[s.t < 1.5 - DT] == 0).all()
        assert (column[s.t > 1.5 + DT] == 1).all()


def test_friction_by_load_of_hundreds_is_none():
    effect = CATALOGUE["load_dependent_friction"]
    shape = (0.0, 1.0, effect.POWER)
    for size, possible in ((-0.1, False), (0.2, True), (600.0, False)):
        assert effect.plausible(Fit(np.array([size]), shape, np.zeros((4, 4)), KNOWN, N)) is possible


@pytest.mark.parametrize(
    ("t_w", "law", "possible"), [(12.0, 1.0, False), (12.0, 0.0, False), (90.0, 1.0, True), (12.0, 3.0, True)]
)
def test_no_drive_warms_and_cools_within_seconds(t_w: float, law: float, possible: bool):
    """What begins anew in every run (exam 101, case 30) is no warmth; of a logged temperature the number is kelvins."""
    fit = Fit(np.array([0.04, 0.0005]), (t_w, law, 1e-3), np.zeros((5, 5)), KNOWN, N)
    assert CATALOGUE["thermal_friction_drift"].plausible(fit) is possible


def test_lines_that_are_seen_are_tried_with_their_neighbours():
    tried = CATALOGUE["encoder_interpolation_error"].shapes(dataclasses.replace(REACH, counts_m=0.0, lines_m=(128,)))
    assert {(0.0, n) for n in (127.0, 128.0, 129.0, 255.0, 257.0)} == {shape for shape in tried if shape[0] == 0.0}


def test_a_load_at_rest_passes_no_line():
    """A wave of its angle would be a straight line through the noise of that reading."""
    lines = CATALOGUE["encoder_interpolation_error"]
    count = 2 * np.pi / (4 * 49152)
    s = motion()
    noise = count * np.random.default_rng(3).standard_normal(s.t.size)
    still = dataclasses.replace(s, theta_l=0.3 + noise)
    moving = dataclasses.replace(s, theta_l=0.3 + noise + 9 * count * np.linspace(0, 1, s.t.size))
    assert np.ptp(lines.columns(still, (1.0, 49152.0))[Port.READS_THETA_L], axis=0) == pytest.approx(0.0, abs=1e-9)
    assert np.ptp(lines.columns(moving, (1.0, 49152.0))[Port.READS_THETA_L], axis=0).min() > 1.0


def test_orders_of_the_flexspline_are_told_in_the_paper_s_stroke_for_any_ratio_up_to_100():
    """Eight turns of the motor about zero, 2.02 beside 2; half of them tell nothing."""
    frame = CATALOGUE["flexspline_frame_error"]
    assert all(frame.shapes(dataclasses.replace(REACH, ratio=n, load_turns=8 / n)) for n in (50.0, 80.0, 100.0))
    assert not frame.shapes(dataclasses.replace(REACH, load_turns=4 / 100.0))


def test_a_vibration_has_its_frequency_whatever_the_motor_does():
    effect = EACH_RUN["external_vibration"]
    for s in (motion(1.0), motion(-1.0)):
        waves = effect.columns(s, (7.0,))[Port.LOAD_TORQUE]
        np.testing.assert_allclose(waves, -np.stack([np.cos(14 * np.pi * s.t), np.sin(14 * np.pi * s.t)], 1))


@pytest.mark.parametrize("effect", KNOWN_LAWS, ids=[effect.name for effect in KNOWN_LAWS])
def test_parts_of_a_piece_remember_what_was_before(effect: Effect):
    whole = motion()
    parts = tuple(whole.part(rows) for rows in (slice(0, 1100), slice(1100, 2700), slice(2700, None)))
    inner = parts[1].part(slice(200, 500))  # a part of a part
    stretches = np.r_[100:900, 1500:1600, 3000:3990]
    for shape in effect.shapes(REACH)[:3]:
        expected = effect.columns(whole, shape)
        pieces = (*parts, inner, whole.part(stretches), parts[1].part(np.r_[0:50, 300:800]))
        acts = acting(SimpleNamespace(pieces=pieces), Term(effect, shape))
        for port, columns in expected.items():
            largest = float(np.abs(columns).max())
            for act, rows in zip(
                acts, (np.r_[:1100], np.r_[1100:2700], np.r_[2700:4000], np.r_[1300:1600], stretches,
                       np.r_[1100:1150, 1400:1900]), strict=True
            ):  # fmt: skip
                inside = np.flatnonzero(np.diff(rows, prepend=-9) + np.diff(rows, append=9999) == 2)
                np.testing.assert_allclose(act[port][inside], columns[rows[inside]], rtol=0, atol=1e-9 * largest)


def test_an_eccentric_disc_reads_less_in_the_higher_orders():
    effect = LIBRARY["motor_encoder_eccentricity"]

    def of(sizes):
        return Fit(np.array([[s, 0.0] for s in sizes]).ravel(), (), np.zeros((6, 6)), KNOWN, N)

    assert effect.plausible(of((3.0, 1.0, 0.5)))
    assert not effect.plausible(of((1.0, 3.0, 0.5)))


def test_friction_builds_up_from_nothing_where_a_run_sets_out_from_rest():
    """The low-passed speed looks ahead: it is that of a run that has slid before."""
    effect, s = CATALOGUE["presliding_friction"], motion()
    x_0 = 0.5
    slid = effect.columns(s, (0.0, x_0, 0.0))[Port.MOTOR_TORQUE][:, 0]
    assert slid[0] == pytest.approx(0.0)
    gone = np.concatenate([[0.0, 1e-5, 1e-4], s.theta_m[3:] - s.theta_m[3] + 1e-3])
    rested = effect.columns(dataclasses.replace(s, theta_m=gone), (0.0, x_0, 0.0))[Port.MOTOR_TORQUE][:, 0]
    assert rested[0] == pytest.approx(-1.0)
    assert rested[500] == pytest.approx(-np.exp(-gone[500] / x_0), rel=1e-3)


def test_no_drag_is_told_at_one_speed_whatever_lock_tests_creep_at():
    drag = CATALOGUE["quadratic_drag"]
    one_speed = dataclasses.replace(REACH, fastest=2.0, slowest=0.06, slowest_free=0.9)
    assert drag.shapes(one_speed) == ()
    assert drag.shapes(dataclasses.replace(one_speed, fastest=12.0))
