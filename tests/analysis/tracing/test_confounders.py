"""Laws beside the library: searched for, told in a sentence, never named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.equations import Equations, Noise
from rig.analysis.tracing.fit.footprint import footprint
from rig.analysis.tracing.nameless.loops import CouplingPlay, Creep, SensorLoop
from rig.analysis.tracing.nameless.readings import Droop, SensorWaves
from rig.analysis.tracing.nameless.springs import EvenSpring
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.analysis.tracing.selection import confounders
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.trace import trace
from rig.model.effect import MEASURED, Port
from rig.model.effects import LIBRARY
from rig.model.effects.angle_dependent_stiffness import MOTOR, AngleDependentStiffness
from rig.model.effects.cogging_torque import CoggingTorque
from rig.model.references import REFERENCES
from tests.blind.cases import Request
from tests.blind.generate import write_case
from tests.contract.test_effects import KNOWN, REACH, N, motion


def test_a_confounder_bears_no_name_of_the_library_and_mimics_one_that_does() -> None:
    for name, confounder in CONFOUNDERS.items():
        assert name == confounder.effect.name
        assert name not in LIBRARY
        assert confounder.mimics <= set(LIBRARY)
        assert confounder.effect.source in REFERENCES


def test_a_sensor_that_feels_the_wave_generator_leaves_the_motor_an_nth_as_if_it_cogged() -> None:
    s, smooth = motion(), Smoother(36.0, motion().dt, 1)
    shown = footprint(SensorWaves().columns(s, ()), s, smooth, MEASURED)
    cogging = footprint(CoggingTorque().columns(s, (2.0,)), s, smooth, MEASURED)["M"]
    np.testing.assert_allclose(shown["M"][:, 2:4], -cogging / N, atol=0.06 / N)  # but for θ̃_p′ in the lever
    np.testing.assert_allclose(shown["L"][:, 2:4], cogging, atol=1e-12)


def test_what_acts_on_a_load_whose_torque_nobody_read_winds_up_a_spring_with_its_damper() -> None:
    """c/(K + B_sp·d/dt) to the first order, of a torque of 5 Hz."""
    s, omega = motion(), 2 * np.pi * 5.0
    smooth = Smoother(36.0, s.dt, 1)
    shown = footprint({Port.LOAD_TORQUE: np.sin(omega * s.t)[:, None]}, s, smooth, MEASURED - {"tau_l"})["A"]
    behind = np.imag(np.exp(1j * omega * s.t) / (KNOWN.K + 1j * omega * KNOWN.B_sp))[:, None]
    np.testing.assert_allclose(shown, smooth(behind), atol=2e-3 / KNOWN.K)


def test_creep_follows_a_step_of_torque_as_slowly_as_its_lags() -> None:
    still = motion(n=4000)
    step = np.where(np.arange(4000) < 10, 0.0, 20.0)
    (columns,) = Creep().columns(replace(still, torque=step), (Creep.IN_BALANCE,)).values()
    gone = (4000 - 10) * still.dt
    expected = 20.0 * (1 - np.exp(-gone / np.array(Creep.LAGS)))
    np.testing.assert_allclose(columns[-1], expected, rtol=2e-2)
    assert (columns[9] == 0).all()


def test_a_load_that_was_just_hung_up_has_still_to_wind_up_the_gear() -> None:
    """What fades from the start on makes, with what follows, the wind-up of a load that was just hung up."""
    held = replace(motion(n=4000), torque=np.full(4000, 20.0))
    (columns,) = Creep().columns(held, (Creep.JUST_HUNG,)).values()
    follows, fades = np.hsplit(columns, 2)
    gone = held.dt * np.arange(4000)[:, None] / np.array(Creep.LAGS)
    np.testing.assert_allclose(follows - fades, 20.0 * (1 - np.exp(-gone)), atol=1e-9)


def test_creep_closes_its_loop_when_it_is_gone_round_slowly() -> None:
    def gap(seconds: float) -> float:
        n = 20000
        s = replace(motion(n=n), dt=seconds / n, torque=20.0 * np.sin(np.linspace(0, 2 * np.pi, n)))
        column = Creep().columns(s, (Creep.IN_BALANCE,))[Port.WIND_UP][:, 0]
        return float(abs(column[n // 2]))  # back at zero torque

    assert gap(400.0) < 0.05 * gap(4.0)


def test_a_campaign_shorter_than_its_lags_shows_no_creep() -> None:
    assert Creep().shapes(replace(REACH, weights=1)) == ((Creep.IN_BALANCE,),)
    assert (Creep.JUST_HUNG,) in Creep().shapes(replace(REACH, weights=3))
    assert Creep().shapes(replace(REACH, duration=8.0)) == ()


def test_droop_gives_as_it_takes_where_friction_would_take_both_ways() -> None:
    forth, back = (Droop().columns(motion(sign), ())[Port.READS_TAU_M][:, 0] for sign in (1.0, -1.0))
    np.testing.assert_allclose(forth, -back, atol=1e-12)
    assert (np.sign(forth) == np.sign(motion().tau_m)).all()


def test_a_spring_harder_one_way_is_what_a_stiffness_of_an_angle_seems_in_a_lock_test() -> None:
    """The output held, θ_m = N·T/K: T·sin θ_m is N·T²/K as long as that angle is small."""
    torque = np.linspace(-5.0, 5.0, 4000)
    held = replace(motion(n=4000), torque=torque, theta_m=N * torque / KNOWN.K)
    of_angle = AngleDependentStiffness().columns(held, (1.0, 0.0, MOTOR))[Port.WIND_UP][:, 1]
    even = EvenSpring().columns(held, ())[Port.WIND_UP][:, 0]
    np.testing.assert_allclose(of_angle, -N / KNOWN.K * even, atol=1e-3 * np.abs(of_angle).max())


def test_an_encoder_with_play_stays_behind_by_the_same_under_any_torque_and_rests_when_it_is_held() -> None:
    s = motion(n=4000)
    there_and_back = 0.01 * np.sin(np.linspace(0, 2 * np.pi, 4000))
    behind = {
        torque: CouplingPlay().columns(replace(s, theta_l=there_and_back, torque=np.full(4000, torque)), ())
        for torque in (0.0, 40.0)
    }
    forth, back = behind[0.0][Port.READS_THETA_L][[500, 2000], 0]
    np.testing.assert_allclose((forth, back), (-1.0, 1.0))
    np.testing.assert_array_equal(behind[0.0][Port.READS_THETA_L], behind[40.0][Port.READS_THETA_L])
    held = CouplingPlay().columns(replace(s, theta_l=np.zeros(4000)), ())[Port.READS_THETA_L]
    assert (held == 0).all()


@pytest.mark.slow
@pytest.mark.long
def test_creep_is_not_called_hysteresis(tmp_path: Path) -> None:
    write_case(Request("outside", 11, "complete", "gear_creep", over_floor=4.0), tmp_path, "case")
    verdict = trace(tmp_path / "case").verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "memory")


def test_where_a_sensors_loop_was_left_before_a_run_is_not_known_and_makes_no_difference() -> None:
    """A run that lies at 30 N·m swings as far into its loop as one about nothing."""
    s = motion()
    (about_zero,) = SensorLoop().columns(s, ()).values()
    (lifted,) = SensorLoop().columns(replace(s, tau_l=s.tau_l + 30.0, torque=s.torque + 30.0), ()).values()
    np.testing.assert_allclose(lifted, about_zero, atol=1e-12)


@pytest.mark.parametrize(("zero_of", "kept"), [("L", "sensor_loop"), ("", "hysteretic_stiffness")])
def test_a_sensors_loop_is_weighed_with_a_zero_for_every_run(
    monkeypatch: pytest.MonkeyPatch, zero_of: str, kept: str
) -> None:
    """It explains less than the spring's as long as all runs share one zero, and more where each has its own."""
    gains = {("spring", "shared"): 10.0, ("sensor", "shared"): 8.0, ("spring", "own"): 5.0, ("sensor", "own"): 7.0}

    def model(terms: tuple[SimpleNamespace, ...], noise: Noise) -> SimpleNamespace:
        zeros = "shared" if np.isfinite(noise.local["L"]) else "own"
        law = "sensor" if any(t.name == "sensor_loop" for t in terms) else "spring"
        eq = Equations((), {}, noise)
        return SimpleNamespace(
            design=SimpleNamespace(terms=terms, eq=eq, size=2, y={(0, "L"): np.zeros(9)}),
            gain=gains[law, zeros],
            keys=((0, "L"),),
        )

    shared = Noise({}, {"L": 1.0}, {"L": 0.002})
    spring = model((SimpleNamespace(name="hysteretic_stiffness"),), shared)
    only = {"sensor_loop": replace(CONFOUNDERS["sensor_loop"], zero_of=zero_of)}
    monkeypatch.setattr(confounders, "CONFOUNDERS", only)
    monkeypatch.setattr(confounders, "reduced", lambda d, gone: SimpleNamespace(terms=(), eq=d.eq))
    monkeypatch.setattr(confounders, "extended", lambda d, term, runs: SimpleNamespace(terms=(*d.terms, term), eq=d.eq))
    monkeypatch.setattr(confounders, "design", lambda eq, terms, runs: SimpleNamespace(terms=terms, eq=eq))
    monkeypatch.setattr(confounders, "fit", lambda d: model(d.terms, d.eq.noise))
    chosen = confounders.with_confounders(spring, (0,), REACH)
    assert [t.name for t in chosen.design.terms] == [kept]


@pytest.mark.parametrize(("creeps", "kept"), [(11.0, "sensor_loop"), (13.0, "creep"), (9.0, "sensor_loop")])
def test_of_laws_that_are_taken_for_the_same_the_one_that_explains_most_stays(
    monkeypatch: pytest.MonkeyPatch, creeps: float, kept: str
) -> None:
    """Whichever is tried first: a creep that had taken a loop's place left a sensor's loop untried (exam 80, 23)."""
    gains = {"hysteretic_stiffness": 10.0, "creep": creeps, "sensor_loop": 12.0}

    def model(terms: tuple[SimpleNamespace, ...]) -> SimpleNamespace:
        noise = Noise({}, {"L": 1.0}, {"L": 0.002})
        design = SimpleNamespace(terms=terms, eq=Equations((), {}, noise), size=2, y={(0, "L"): np.zeros(9)})
        return SimpleNamespace(design=design, gain=max((gains[t.name] for t in terms), default=0.0), keys=((0, "L"),))

    only = {name: replace(CONFOUNDERS[name], zero_of="", short=0.0) for name in ("creep", "sensor_loop")}
    monkeypatch.setattr(confounders, "CONFOUNDERS", only)
    monkeypatch.setattr(confounders, "reduced", lambda d, gone: SimpleNamespace(terms=(), eq=d.eq))
    monkeypatch.setattr(confounders, "extended", lambda d, term, runs: SimpleNamespace(terms=(*d.terms, term), eq=d.eq))
    monkeypatch.setattr(confounders, "fit", lambda d: model(d.terms))
    chosen = confounders.with_confounders(model((SimpleNamespace(name="hysteretic_stiffness"),)), (0,), REACH)
    assert [t.name for t in chosen.design.terms] == [kept]
