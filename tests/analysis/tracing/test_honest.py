"""Parameters are given as far as the runs tell them, and a candidate that does most is dismissed with a reason."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import Candidate, Status, Verdict
from rig.analysis.tracing.outcome.dismissed import dismissed
from rig.analysis.tracing.outcome.honest import honest, not_told
from rig.analysis.tracing.outcome.result import Errors
from rig.analysis.tracing.runs.cannot import highest_order, together
from rig.analysis.tracing.runs.meanings import computed_torque
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Parameter, parameter
from rig.report.numbers import SPACE
from rig.report.trace.sizes import said as sized

RPM = np.pi / 30


class Turning(SimpleNamespace):
    keeps_speed = Recording.keeps_speed


def run(rpm: float, rate: float = 250.0, locked: bool = False) -> Any:
    piece = SimpleNamespace(theta_m=np.array([0.0, 1.0, 0.0]), omega_m=np.full(3, rpm * RPM))
    return Turning(
        turning=rpm * RPM,
        locked=locked,
        procedure="other",
        rate=rate,
        ratio=100.0,
        smoother=SimpleNamespace(sigma_hz=36.0),
        pieces=(piece,),
        has=frozenset({"tau_l"}),
    )


BASELINE = (
    parameter("K", 7000.0, 10.0, "N·m/rad"),
    parameter("B_m", 4e-3, 1e-4, "N·m·s/rad"),
    parameter("tau_c", 0.1, 1e-3, "N·m"),
    parameter("B_l", 1.0, 0.1, "N·m·s/rad"),
    parameter("tau_cl", 0.2, 0.05, "N·m"),
    *(parameter(f"theta_p_order_{n}", 10.0, 1.0, "arcsec") for n in range(1, 16)),
)


def named(found: tuple[Parameter, ...]) -> dict[str, Parameter]:
    return {p.name: p for p in found}


def test_at_two_speeds_every_parameter_is_given_as_fitted() -> None:
    assert honest(BASELINE, [run(9.6), run(300.0)]) == BASELINE
    assert not_told(BASELINE, [run(9.6), run(300.0)]) == []


def test_what_is_left_open_is_said_with_its_interval_or_without_a_number_where_that_is_noise() -> None:
    wide, wild = parameter("K", 8890.0, 17640.0, "N·m/rad"), parameter("B_sp", 9.61, 230.0, "N·m·s/rad")
    (said,) = not_told((wide, wild), [run(9.6), run(300.0)])
    assert "K (8890 N·m/rad, 95 % -8750 to 26500)" in said
    assert "B_sp (not even its order of magnitude)" in said


@pytest.mark.parametrize(("half", "words"), [(54e15, "not determined"), (3.0, "0.1 ± 3.0 N·m/rad")])
def test_the_page_shows_no_interval_beyond_reason(half: float, words: str) -> None:
    assert sized(parameter("K", 0.1, half, "N·m/rad")).replace(SPACE, " ") == words


def test_at_one_speed_constant_friction_and_drag_may_each_be_all_of_it() -> None:
    found = named(honest(BASELINE, [run(300.0), run(310.0), run(0.0, locked=True)]))
    omega = 305.0 * RPM
    assert found["tau_c"].value == 0.1
    assert found["tau_c"].ci95 == pytest.approx((0.0, 0.1 + 4e-3 * omega))
    assert found["B_m"].ci95 == pytest.approx((0.0, 0.1 / omega + 4e-3))
    assert found["tau_cl"].ci95[1] == pytest.approx(0.2 + omega / 100)
    assert found["B_l"].ci95[1] == pytest.approx(0.2 * 100 / omega + 1.0)
    assert found["K"] == BASELINE[0]


def test_a_run_whose_own_speed_changes_tells_drag_from_constant_friction() -> None:
    swings = run(300.0)
    swings.pieces[0].omega_m = 300.0 * RPM * np.sin(np.linspace(0.0, 6.28, 100))
    assert named(honest(BASELINE, [swings, swings]))["tau_c"] == BASELINE[2]


def test_orders_beyond_the_rows_of_the_slowest_run_are_not_given() -> None:
    fast = [run(682.0, rate=250.0), run(600.0), run(0.1, locked=True)]
    assert highest_order(fast) == 7
    found = honest(BASELINE, fast)
    assert [p.name for p in found if "order" in p.name][-1] == "theta_p_order_7"
    assert "orders above 7 of the kinematic error" in not_told(BASELINE, fast)[0]
    assert highest_order([run(600.0, rate=60.0)]) == 2  # rows, not the low-pass
    assert highest_order([run(0.0, locked=True)]) > 15


def test_what_may_be_zero_or_below_is_said_not_to_be_determined() -> None:
    odd = (*BASELINE[:1], parameter("B_sp", -5933.0, 5278.0, "N·m·s/rad"), parameter("J_l", 0.7, 7.0, "kg·m²"))
    (said,) = not_told(odd, [run(9.6)])
    assert "B_sp (-5930 N·m·s/rad, 95 % -11200 to -655), J_l (0.7 kg·m², 95 % -6.3 to 7.7)" in said
    assert "K (" not in said


def test_without_a_shaft_torque_the_friction_of_both_sides_is_one_unless_angles_tell_what_winds_the_spring_up() -> None:
    bare = run(9.6)
    bare.has = frozenset({"theta_m"})
    assert {("B_m", "B_l"), ("tau_c", "tau_cl")} <= set(together([bare, run_without_torque(300.0)]))
    assert ("B_m", "B_l") not in together([bare, run(300.0)])
    bare.has = frozenset({"theta_m", "theta_l"})
    assert ("tau_c", "tau_cl") not in together([bare, run_without_torque(300.0)])


def run_without_torque(rpm: float) -> Any:
    found = run(rpm)
    found.has = frozenset({"theta_m"})
    return found


NOTHING = Verdict(Status.NOTHING, (), (), None, None, None, "")
FLOORS = Errors(70.0, None, 60.0, 20.626, None, 1.5)
GRAVITY = Candidate(
    "gravity_unbalance",
    1.0,
    "alone it removes 100 % of the excess in the held-out shaft torque",
    {"theta_l": 4.2e-4, "tau_l": 4.05},
)


def test_a_candidate_that_removes_all_of_one_channel_is_dismissed_with_what_it_leaves() -> None:
    unknown = Verdict(Status.UNKNOWN, (), (), "load_angle", None, None, "")
    (found,) = dismissed([GRAVITY], unknown, FLOORS)
    assert found.why == (
        f"{GRAVITY.why}, but leaves the kinematic error at 4.2 and the shaft torque at 2.7 times its floor, so that "
        "it is not named"
    )


def test_one_beside_a_name_or_that_has_a_reason_keeps_it_and_no_other_is_without() -> None:
    explained = Verdict(Status.EXPLAINED, ("lost_motion",), (), None, None, None, "")
    unknown = Verdict(Status.UNKNOWN, (), (), "load", None, None, "")
    quiet = Candidate("a", 1.0, GRAVITY.why, {"tau_l": 1.6})
    weak = Candidate("b", 1.0, "alone it removes 48 % of it, 60 % would be asked for", {"tau_l": 30.0})
    assert dismissed([GRAVITY], explained, FLOORS) == (GRAVITY,)
    better, none = (dismissed([quiet, weak], verdict, FLOORS) for verdict in (unknown, NOTHING))
    assert better[0].why.endswith(
        "; it does not explain all, or not as well as what the verdict tells, so that it is not named"
    )
    assert none[0].why.endswith("too little to name anything by")
    assert better[1] == none[1] == weak


def test_a_torque_that_was_computed_is_said_to_be() -> None:
    def source(meaning: str, *channels: str) -> Any:
        return SimpleNamespace(channels=channels, meaning=lambda name: meaning)

    (said,) = computed_torque(source("joint torque, computed: feed-forward of the arm; no shaft sensor", "tau_l"))
    assert "tau_l is no reading of a shaft sensor but “joint torque, computed" in said
    assert computed_torque(source("torque sensor between gear and load", "tau_l")) == []
    assert computed_torque(source("computed", "tau_m")) == []


def test_what_is_below_zero_for_certain_is_said_to_be_so_and_not_left_open() -> None:
    odd = (*BASELINE[:1], parameter("J_m", -3.5e-4, 0.5e-4, "kg·m²"), parameter("J_l", 0.7, 7.0, "kg·m²"))
    below, left = not_told(odd, [run(9.6)])
    assert below.startswith("J_m (-0.00035 kg·m², 95 % -0.0004 to -0.0003) came out below zero")
    assert "J_l" in left
    assert "J_m" not in left
