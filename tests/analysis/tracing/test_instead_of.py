"""A name in the place of what every gear has, of its spring or of an inertia, does not stand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.channels import BASELINE, INDEX
from rig.analysis.tracing.selection import instead_of as module
from rig.analysis.tracing.selection.instead_of import (
    FRICTIONS,
    at_a_vibration,
    below_zero,
    hidden_by_the_gear,
    instead_of_an_inertia,
    of_a_spring_unseen,
)
from rig.model.effect import Port, parameter


def solution(*names: str, J_m: float = 1e-3, has: frozenset[str] = frozenset({"theta_l", "tau_m"})) -> Any:
    values = dict.fromkeys(BASELINE, 1e-6) | {"J_m": J_m, "J_l": 0.8}
    terms = tuple(SimpleNamespace(name=name) for name in names)
    eq = SimpleNamespace(runs=(SimpleNamespace(has=has),))
    return SimpleNamespace(design=SimpleNamespace(terms=terms, eq=eq), value=values.__getitem__)


@pytest.fixture(autouse=True)
def _known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every inertia is known to 1e-4 kg·m², a compliance not at all."""
    known = np.zeros((len(BASELINE), len(BASELINE)))
    for name, sigma in (("J_m", 1e-4), ("J_l", 1e-4), ("compliance", 1.0)):
        known[INDEX[name], INDEX[name]] = sigma**2
    monkeypatch.setattr(module, "covariance", lambda s: known)


@pytest.mark.parametrize(("J_m", "without", "gone"), [(-5e-4, 1e-3, True), (-5e-4, -6e-4, False), (-1e-4, 1e-3, False)])
def test_a_name_that_makes_an_inertia_surely_negative_is_the_inertia(
    monkeypatch: pytest.MonkeyPatch, J_m: float, without: float, gone: bool
) -> None:
    monkeypatch.setattr(module, "_without", lambda s, places: solution(J_m=without))
    assert instead_of_an_inertia(solution("load_dependent_kinematic_error", J_m=J_m)) == (
        ["load_dependent_kinematic_error"] if gone else []
    )


def test_a_law_of_the_spring_does_not_stand_where_neither_wind_up_nor_spring_was_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ports = {"nonlinear_stiffness": Port.WIND_UP, "gravity_unbalance": Port.LOAD_TORQUE}
    monkeypatch.setattr(module, "acting", lambda run, term: [{ports[term.name]: None}])
    assert of_a_spring_unseen(solution(*ports)) == ["nonlinear_stiffness"]
    assert of_a_spring_unseen(solution(*ports, has=frozenset({"theta_m", "theta_l"}))) == []


def test_a_resonance_where_the_rig_is_shaken_is_the_vibration() -> None:
    """Two lines at 18 and 36 Hz; a mode at 35.98 Hz, a support at 25."""
    shaken = (parameter("frequency", 18.1, 1e-3, "Hz"), parameter("frequency_2", 36.2, 1e-3, "Hz"))
    words = {
        "torsional_mode": (parameter("J_2", 2e-5, 1e-6, "kg·m²"), parameter("frequency", 35.98, 0.03, "Hz")),
        "support_compliance": (parameter("frequency", 25.0, 0.1, "Hz"),),
        "cogging_torque": (parameter("order_18_amplitude", 18.1, 0.1, "N·m"),),
    }
    own: Any = SimpleNamespace(parameters={"external_vibration": shaken})
    assert at_a_vibration(own, words) == ["torsional_mode"]
    assert at_a_vibration(SimpleNamespace(parameters={}), words) == []  # type: ignore[arg-type]


def test_a_friction_below_zero_is_told_only_where_it_is_surely_so(monkeypatch: pytest.MonkeyPatch) -> None:
    known = np.zeros((len(BASELINE), len(BASELINE)))
    for name in FRICTIONS:
        known[INDEX[name], INDEX[name]] = 1e-3**2
    monkeypatch.setattr(module, "covariance", lambda s: known)
    values = dict.fromkeys(BASELINE, 1e-6) | {"tau_c": -0.35, "B_m": -1e-3}
    s: Any = SimpleNamespace(value=values.__getitem__)
    assert below_zero(s, FRICTIONS) == {"tau_c"}


@pytest.mark.parametrize(
    ("beside", "without", "gone"),
    [(40.0, 5.0, True), (9.0, 12.0, False), (50.0, 45.0, False)],  # of 36: hidden by it; small; once a turn in any case
)
def test_an_encoder_whose_error_only_the_gear_could_hide_is_a_torque(
    monkeypatch: pytest.MonkeyPatch, beside: float, without: float, gone: bool
) -> None:
    def told(first: float) -> Any:
        s = solution("motor_encoder_eccentricity")
        values = dict.fromkeys(BASELINE, 1e-6) | {"a1": first, "b2": 36.0}
        return SimpleNamespace(design=s.design, value=values.__getitem__, gram=np.eye(len(BASELINE)))

    monkeypatch.setattr(module, "_without", lambda s, places: told(without))
    assert hidden_by_the_gear(told(beside)) == (["motor_encoder_eccentricity"] if gone else [])
