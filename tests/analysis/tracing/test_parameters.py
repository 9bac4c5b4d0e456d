"""Coefficients in words: the spring's damping beyond the terms that are fitted; an exponent the runs do not tell."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import parameters
from rig.analysis.tracing.fit.channels import BASELINE, INDEX
from rig.analysis.tracing.fit.equations import Bare, Equations, Noise, Term
from rig.analysis.tracing.fit.model import Design, Part, fit, normal
from rig.analysis.tracing.fit.parameters import Told, joined
from rig.analysis.tracing.runs.look import Look
from rig.model.effect import Fit
from rig.model.effects import CATALOGUE
from rig.model.effects.support_compliance import ON_GROUND, SupportCompliance
from rig.model.fourier import FourierSeries

K, B_SP = 7160.0, 7.0
HZ = (13.3, 6.7)
RUN: Any = SimpleNamespace(locked=False, look=Look(), pieces=())


def waves(derivative: int) -> np.ndarray:
    """T and its derivatives of two orders at two speeds, (n,)."""
    t = np.arange(0.0, 3.0, 4e-3)
    made = [2 * np.pi * f for f in HZ]
    return np.asarray(sum(w**derivative * np.cos(w * t + 0.7 + derivative * np.pi / 2) for w in made))


def wind_up() -> np.ndarray:
    """T/(K + B_sp·d/dt), exactly, (n,)."""
    t = np.arange(0.0, 3.0, 4e-3)
    return np.asarray(sum((np.exp(1j * (2 * np.pi * f * t + 0.7)) / (K + 2j * np.pi * f * B_SP)).real for f in HZ))


def test_damping_is_right_though_the_model_ends_with_the_second_derivative(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("compliance", "damping", "damping_2")
    at, key, size = np.array([INDEX[n] for n in names]), (0, "A"), len(BASELINE)
    rows: Any = {key: SimpleNamespace(keep=np.ones(waves(0).size, bool), own=np.zeros((waves(0).size, 0)))}
    eq = Equations((RUN,), rows, Noise({"A": 1e-8}, {"A": 1.0}, {"A": np.inf}))
    parts = {key: (Part(Bare(np.stack([waves(d) for d in range(3)], 1)), at, None),)}
    empty = Design(eq, (), (), {key: wind_up()}, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(empty, {key: parts[key][0]})
    monkeypatch.setattr(parameters, "third_rate", lambda run: waves(3))
    s = fit(Design(eq, (), (), empty.y, {}, parts, gram, right))
    fitted = -s.value("damping") / s.value("compliance") ** 2
    assert fitted < 0.996 * B_SP  # what the coefficient alone says
    found = {p.name: p.value for p in parameters.baseline(s)}
    assert found["B_sp"] == pytest.approx(B_SP, rel=5e-4)


class Swung(SupportCompliance):
    """(H − 1)·T of a housing of 28 Hz without a damper, for a torque of waves."""

    WITHIN = sum(
        (h / (1 - h)) * np.cos(2 * np.pi * f * np.arange(0.0, 3.0, 4e-3) + 0.7)
        for f, h in ((f, (f / 28.0) ** 2) for f in HZ)
    )


def test_a_housing_that_gives_way_is_not_in_the_stiffness_of_the_gear(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    names, support = ("compliance", "damping"), 1.2e-5  # rad/(N·m)
    at, key, size = np.array([*(INDEX[n] for n in names), len(BASELINE)]), (0, "A"), len(BASELINE) + 1
    rows: Any = {key: SimpleNamespace(keep=np.ones(waves(0).size, bool), own=np.zeros((waves(0).size, 0)))}
    gear = SimpleNamespace(J_l=0.8, K=K)
    run: Any = SimpleNamespace(**{**vars(RUN), "gear": gear, "ratio": 50.0})
    eq = Equations((run,), rows, Noise({"A": 1e-8}, {"A": 1.0}, {"A": np.inf}))
    y = waves(0) / K - waves(1) * B_SP / K**2 + support * (waves(0) + Swung.WITHIN)
    y = y + 1e-8 * rng.standard_normal(y.size)
    parts = {key: (Part(Bare(np.stack([waves(0), waves(1), Swung.WITHIN], 1)), at, None),)}
    terms = (Term(Swung(), (ON_GROUND, 28.0, 0.01)),)
    empty = Design(eq, terms, (1,), {key: y}, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(empty, {key: parts[key][0]})
    monkeypatch.setattr(parameters, "third_rate", lambda run: 0.0 * waves(3))
    s = fit(Design(eq, terms, (1,), empty.y, {}, parts, gram, right))
    assert 1 / s.value("compliance") < 0.93 * K  # both
    found = {p.name: p for p in parameters.baseline(s)}
    half = (found["K"].ci95[1] - found["K"].ci95[0]) / 2
    assert abs(found["K"].value - K) < 2 * half < 1e-3 * K
    assert found["B_sp"].value == pytest.approx(B_SP, rel=1e-3)


def test_a_sensor_that_would_be_early_has_no_delay_and_an_interval_as_wide_as_the_rows_leave_it(
    rng: np.random.Generator,
) -> None:
    at, key, size = np.array([INDEX[n] for n in ("J_l", "lag")]), (0, "L"), len(BASELINE)
    z = np.stack([waves(2) / 1e3, -waves(1)], 1)
    y = z @ np.array([0.8, -2e-5]) + 0.05 * rng.standard_normal(len(z))  # 20 µs early
    eq = Equations((RUN,), {}, Noise({"L": 0.05}, {"L": 1.0}, {"L": np.inf}))
    parts = {key: (Part(Bare(z), at, None),)}
    empty = Design(eq, (), (), {key: y}, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(empty, {key: parts[key][0]})
    (lag,) = (
        p for p in parameters.baseline(fit(Design(eq, (), (), empty.y, {}, parts, gram, right))) if p.name == "lag"
    )
    assert (lag.value, lag.ci95[0]) == (0.0, 0.0)
    alone = 1.96 * 0.05 / np.sqrt(np.sum(waves(1) ** 2))  # of rows of that noise
    assert 0.3 * alone < lag.ci95[1] < 3 * alone


@pytest.mark.parametrize(
    ("late", "drag", "wider"), [(9e-6, 4e-3, 9e-6 * K), (9e-5, 1e-3, 50.0 * 1e-3), (0.0, 4e-3, 0.0)]
)
def test_a_delay_that_may_be_the_drag_of_the_mesh_leaves_the_damping_open_below(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, late: float, drag: float, wider: float
) -> None:
    """By as much as K makes of the delay, and no more than N times all the motor's drag."""
    run: Any = SimpleNamespace(**{**vars(RUN), "ratio": 50.0})
    inertia, torque = waves(2) / 1e3, waves(0)
    named = {
        "A": (("compliance", "damping", "damping_2"), np.stack([waves(d) for d in range(3)], 1), wind_up()),
        "L": (("J_l", "lag"), np.stack([inertia, -waves(1)], 1), 0.8 * inertia - late * waves(1)),
        "M": (("B_m",), torque[:, None], drag * torque),
    }
    noise = {"A": 1e-8, "L": 1e-3, "M": 1e-6}
    rows: Any = {(0, "A"): SimpleNamespace(keep=np.ones(torque.size, bool), own=np.zeros((torque.size, 0)))}
    eq = Equations((run,), rows, Noise(noise, dict.fromkeys("ALM", 1.0), dict.fromkeys("ALM", np.inf)))
    y = {(0, c): of[2] + noise[c] * rng.standard_normal(torque.size) for c, of in named.items()}
    parts = {(0, c): (Part(Bare(z), np.array([INDEX[n] for n in names]), None),) for c, (names, z, _) in named.items()}
    size = len(BASELINE)
    empty = Design(eq, (), (), y, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(empty, {key: part[0] for key, part in parts.items()})
    monkeypatch.setattr(parameters, "third_rate", lambda run: waves(3))
    (told,) = (p for p in parameters.baseline(fit(Design(eq, (), (), y, {}, parts, gram, right))) if p.name == "B_sp")
    below, above = told.value - told.ci95[0], told.ci95[1] - told.value
    assert below - above == pytest.approx(wider, rel=0.05, abs=0.1 * above)


@pytest.mark.parametrize("both_ways", [True, False])
def test_constant_friction_of_runs_that_go_one_way_is_told_with_the_zero_and_open(
    both_ways: bool, rng: np.random.Generator
) -> None:
    at, key, size, omega = np.array([INDEX[n] for n in ("B_m", "tau_c", "tau_0")]), (0, "M"), len(BASELINE), waves(0)
    way = np.sign(omega) if both_ways else -np.ones(omega.size)  # backward, if one way only
    z = np.stack([way * np.abs(omega), way, np.ones(omega.size)], 1)
    y = z @ np.array([3e-3, 0.17, 0.02]) + 1e-3 * rng.standard_normal(omega.size)
    eq = Equations((RUN,), {}, Noise({"M": 1e-3}, {"M": 1.0}, {"M": np.inf}))
    parts = {key: (Part(Bare(z), at, None),)}
    empty = Design(eq, (), (), {key: y}, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(empty, {key: parts[key][0]})
    found = parameters.baseline(fit(Design(eq, (), (), empty.y, {}, parts, gram, right)))
    tau_c = next(p for p in found if p.name == "tau_c")
    assert tau_c.ci95[0] < 0.17 < tau_c.ci95[1]
    assert tau_c.value == pytest.approx(0.17 if both_ways else 0.15, abs=2e-3)
    assert (tau_c.ci95[0] == 0.0) is not both_ways
    assert (tau_c.ci95[1] > 0.29) is not both_ways


@pytest.mark.parametrize("far", [20.0, 900.0])
def test_a_spring_that_gets_stiffer_is_told_near_zero_torque_and_under_load(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, far: float
) -> None:
    """A soft zone that ends at `far` N·m or so, also far beyond all torques: then 1/K and what is soft are known
    together and not apart."""
    torque, rate, soft = 20.0 * waves(0), 20.0 * waves(1), 4e-5 if far > 100 else 9e-6
    spring = CATALOGUE["nonlinear_stiffness"]
    column = np.sign(torque) * far * -np.expm1(-np.abs(torque) / far)
    local = 1 / K + soft * np.exp(-np.abs(torque) / far)  # of the spring at every torque
    y = torque / K + soft * column - B_SP * local**2 * rate
    y = y + 1e-8 * rng.standard_normal(y.size)
    at, key, size = np.array([INDEX["compliance"], INDEX["damping"], len(BASELINE)]), (0, "A"), len(BASELINE) + 1
    piece = SimpleNamespace(
        torque=torque, torque_rate=rate, t=np.arange(torque.size), dt=4e-3, gear=SimpleNamespace(K=K)
    )
    gear = SimpleNamespace(J_l=0.8, K=K)
    run: Any = SimpleNamespace(**{**vars(RUN), "gear": gear, "ratio": 50.0, "pieces": (piece,)})
    rows: Any = {key: SimpleNamespace(keep=np.ones(torque.size, bool), own=np.zeros((torque.size, 0)))}
    eq = Equations((run,), rows, Noise({"A": 1e-8}, {"A": 1.0}, {"A": np.inf}))
    parts = {key: (Part(Bare(np.stack([torque, rate, column], 1)), at, None),)}
    empty = Design(eq, (Term(spring, (0.0, far)),), (1,), {key: y}, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(empty, {key: parts[key][0]})
    monkeypatch.setattr(parameters, "third_rate", lambda run: 0.0 * torque)
    found = {
        p.name: p for p in parameters.baseline(fit(Design(eq, empty.terms, (1,), {key: y}, {}, parts, gram, right)))
    }
    largest = 1 / K + soft * np.exp(-np.abs(torque).max() / far)
    for name, true in (("K", 1 / (1 / K + soft)), ("K_under_load", 1 / largest)):
        half = (found[name].ci95[1] - found[name].ci95[0]) / 2
        assert abs(found[name].value - true) < 2 * half < 0.02 * true
    assert found["B_sp"].value == pytest.approx(B_SP, rel=0.03)


def test_two_loops_make_one_loss_with_the_interval_of_their_sum() -> None:
    loop, shape = CATALOGUE["hysteretic_stiffness"], (4.0, 1.0)  # friction beside the spring: one coefficient
    each, known = 1e-5, SimpleNamespace(K=K)
    c = each**2 * np.array([[1.0, -0.99], [-0.99, 1.0]])  # either is known badly, their sum well
    terms = []
    for i, size in enumerate((-4e-5, -6e-5)):
        by = np.zeros((3, 2))
        by[0, i] = 1.0
        terms.append(Told(loop, Fit(np.array([size]), shape, by @ c @ by.T, known, 50.0), by))  # type: ignore[arg-type]
    alone, both = ({p.name: p for p in joined(some, c)}["hysteresis_loss"] for some in (terms[:1], terms))
    assert both.value == pytest.approx(2 * (4e-5 + 6e-5))
    half = 1.96 * 2 * each
    assert alone.ci95[1] - alone.value == pytest.approx(half, rel=1e-3)
    assert both.ci95[1] - both.value == pytest.approx(half * np.sqrt(0.02), rel=1e-3)


def test_two_frictions_that_build_up_are_one_with_the_interval_of_their_sum() -> None:
    builds_up, each = CATALOGUE["presliding_friction"], 0.03
    c = each**2 * np.array([[1.0, -0.9], [-0.9, 1.0]])
    terms = []
    for i, (size, way) in enumerate(((0.01, 0.05), (0.08, 0.06))):
        by = np.zeros((4, 2))
        by[0, i] = 1.0
        fit = Fit(np.array([size]), (0.0, way, 0.0), by @ c @ by.T, SimpleNamespace(K=K), 50.0)  # type: ignore[arg-type]
        terms.append(Told(builds_up, fit, by))
    told = {p.name: p for p in joined(terms, c)}
    assert told.keys() == {"tau_presliding", "x_0", "x_0_2"}
    assert told["tau_presliding"].value == pytest.approx(0.09)
    assert told["tau_presliding"].ci95[1] - 0.09 == pytest.approx(1.96 * each * np.sqrt(0.2), rel=1e-3)


def test_two_laws_of_a_shrinking_error_leave_one_share_with_the_interval_of_both() -> None:
    law, each = CATALOGUE["load_dependent_kinematic_error"], 0.02
    series = FourierSeries((0.0, 3e-4), (0.0, 1e-4))
    known = SimpleNamespace(kinematic_error=series)
    c = each**2 * np.array([[1.0, -0.9], [-0.9, 1.0]])  # of what goes away either is known worse than their sum
    terms = []
    for i, (size, t_c) in enumerate(((0.4, 2.0), (0.3, 12.0))):
        by = np.zeros((5, 2))
        by[0, i] = 1.0
        fit = Fit(np.array([size]), (0.0, t_c, 3e-3, 1.0), by @ c @ by.T, known, 50.0)  # type: ignore[arg-type]
        terms.append(Told(law, fit, by))
    told = {p.name: p for p in joined(terms, c)}
    assert told["A_inf"].value == pytest.approx(1 / 1.7)
    half = 1.96 * each * np.sqrt(2 * (1 - 0.9)) / 1.7**2
    assert told["A_inf"].ci95[1] - told["A_inf"].value == pytest.approx(half, rel=1e-3)
    assert "A_inf_2" not in told
    assert told["T_c_2"].value == pytest.approx(12.0)


def test_a_loss_under_load_holds_that_of_a_loop_as_wide_everywhere() -> None:
    loop, known = CATALOGUE["hysteretic_stiffness"], SimpleNamespace(K=K)
    plain = Told(loop, Fit(np.array([-4e-5]), (4.0, 1.0), np.zeros((3, 3)), known, 50.0), np.zeros((3, 2)))  # type: ignore[arg-type]
    wedge = Told(loop, Fit(np.array([-1e-6]), (4.0, 2.0), np.zeros((3, 3)), known, 50.0), np.zeros((3, 2)))  # type: ignore[arg-type]
    told = {p.name: p.value for p in joined((plain, wedge), np.zeros((2, 2)))}
    assert told["hysteresis_loss"] == pytest.approx(8e-5)
    assert told["loss_at_20_Nm"] == pytest.approx(8e-5 + 2 * 20 * 1e-6)
