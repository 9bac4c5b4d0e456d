"""Latch skew: found as it was made, told apart from wind-up by friction, refused where nothing can tell it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Estimate, Result, Verdict
from rig.analysis.motion.source import Motion
from rig.analysis.sensors.latch_skew import Leg, Wound, legs, line, load_encoder_late, pairs, torque_late
from rig.analysis.sensors.latch_skew_words import add_latch_skew, add_skew_error, bench_lines
from rig.bench import read
from rig.core.errors import UsageError
from rig.procedures.skew import Skew
from tests.drivers.running import run

RATIO, TURN = 50.0, 2 * np.pi
GEAR = Wound(RATIO, 7160.0, 0.5, 2.5e-3, 1)
C_2 = 96e-6  # rad at the output, 20 arcsec


def made(
    speed_rpm: float, way: int, late: float = 0.0, tau_late: float = 0.0, B_l: float = 0.5, J_l: float = 0.3
) -> Leg:
    """Six turns at one speed of a stiff gear whose load is shaken by order 2, and dragged by B_l; latched late [s]."""
    omega = way * speed_rpm * np.pi / 30
    t = np.arange(0.0, 6 * TURN / abs(omega), 1e-3)
    mean = B_l * omega / RATIO + way * 1.0  # N·m
    theta_m = omega * t + (6 * TURN if way < 0 else 0.0)

    def load(at: np.ndarray) -> np.ndarray:
        return (theta_m + omega * (at - t)) / RATIO - C_2 * np.cos(2 * omega * at) - mean / GEAR.K

    def torque(at: np.ndarray) -> np.ndarray:
        inertia = 4 * omega**2 * J_l * C_2 * np.cos(2 * omega * at)
        return mean + inertia + B_l * 2 * omega * C_2 * np.sin(2 * omega * at)

    return Leg(t, theta_m, load(t + late), torque(t + late + tau_late))


def ways(**more: float) -> list[Leg]:
    return [made(speed, way, **more) for speed in (60.0, 120.0, 300.0, 60.0, 120.0, 300.0) for way in (1, -1)]


DRAGLESS = Wound(RATIO, GEAR.K, 0.5, 0.0, 1)


@pytest.mark.parametrize("late", [-4e-4, 0.0, 7e-4])
def test_a_load_encoder_latched_late_is_found_whatever_friction_winds_up(late: float) -> None:
    found = load_encoder_late(pairs(ways(late=late, B_l=1.0), RATIO), DRAGLESS)
    assert found.value == pytest.approx(late, abs=2e-6)
    assert abs(found.value - late) <= found.half
    assert found.half < 2.5e-5  # a tenth of B_l/K = 140 µs


def test_without_a_torque_sensor_as_much_as_friction_may_make_stands_in_the_interval() -> None:
    bare = [Leg(w.t, w.theta_m, w.theta_l, None) for w in ways(late=3e-4)]
    found = load_encoder_late(pairs(bare, RATIO), DRAGLESS)
    assert found.value == pytest.approx(3e-4, abs=2e-6)
    assert found.half == pytest.approx(0.5 / 7160.0, rel=0.05)


def test_what_drags_beside_the_spring_is_taken_off_and_stands_in_the_interval_with_a_third() -> None:
    both = pairs(ways(), RATIO)
    plain, dragged = load_encoder_late(both, DRAGLESS), load_encoder_late(both, GEAR)
    shift = 2.5e-3 * (1 + 1 / RATIO) * RATIO / 7160.0
    assert dragged.value - plain.value == pytest.approx(shift, rel=1e-6)
    assert dragged.half**2 - plain.half**2 == pytest.approx((shift / 3) ** 2, rel=1e-3)
    assert load_encoder_late(both, Wound(RATIO, 7160.0, 0.5, 2.5e-3, 0)).value == pytest.approx(plain.value)


@pytest.mark.parametrize("late", [-6e-3, -2e-4, 5e-4])
def test_a_torque_that_comes_late_is_found_by_the_phase_of_the_load_s_own_law(late: float) -> None:
    legs_ = ways(tau_late=late)
    found = torque_late(legs_, pairs(legs_, RATIO), RATIO)
    assert found is not None
    assert found.value == pytest.approx(late, abs=3e-5)


def test_a_torque_that_nothing_shakes_has_no_time() -> None:
    still = [Leg(w.t, w.theta_m, w.theta_m / RATIO, np.ones_like(w.t)) for w in ways()]
    assert torque_late(still, pairs(still, RATIO), RATIO) is None


def test_a_straight_line_tells_how_sure_its_slope_is() -> None:
    x = np.array([1.0, 2.0, 3.0, 4.0])
    assert line(x, 2 * x + 1).u_slope == pytest.approx(0.0, abs=1e-12)
    assert line(x, 2 * x + np.array([0.1, -0.1, -0.1, 0.1])).u_slope > 0.04


def test_only_stretches_of_constant_reference_speed_are_legs() -> None:
    t = np.arange(0.0, 8.0, 1e-3)
    omega = np.interp(t, [0, 1, 2, 4, 5, 6, 8], [0, 0, 30, 30, 0, -30, -30])
    ref = np.cumsum(omega) * 1e-3
    found = legs(t, ref, ref / RATIO, ref, None)
    assert [round(leg.omega) for leg in found] == [30, -30]
    assert found[0].t[0] >= 2.5 - 2e-3  # half a second to settle is left out


def slow_run(manifest: dict[str, object]) -> Findings:
    found = Findings(sentence="Kinematic error 90 arcsec.")
    add_skew_error(found, SimpleNamespace(manifest=manifest, ratio=RATIO), 9.6)  # type: ignore[arg-type]
    return found


def test_what_a_known_skew_does_is_printed_beside_the_figure_with_its_interval() -> None:
    found = slow_run({"latch_skew": {"theta_l": {"value": -1e-3, "half_width": 1e-4}}})
    (shift,) = found.estimates
    assert shift.value == pytest.approx(1e-3 * 9.6 * np.pi / 30 / 50 * 206264.8, rel=1e-6)  # 4.1 arcsec
    assert shift.ci95[1] - shift.ci95[0] == pytest.approx(0.2 * shift.value)
    assert "moves θ̃ by 4.1 ± 0.41 arcsec" in found.sentence


def test_a_skew_that_nobody_measured_is_said_so_with_what_a_period_would_do() -> None:
    found = slow_run({"loop": {"rate": 1000.0}})
    assert found.estimates == []
    assert "Latch skew was not measured" in found.sentence
    assert "one period of 1 ms would move θ̃ by 4.1 arcsec" in found.sentence


@pytest.mark.parametrize(
    "told", [{"value": "x", "half_width": 1}, {"value": 1e-3}, 3, {"value": 1e-3, "half_width": -1}]
)
def test_a_manifest_of_somebody_else_is_never_taken_for_a_measurement(told: object) -> None:
    assert slow_run({"latch_skew": {"theta_l": told}}).estimates == []


def test_a_run_without_a_reference_settles_nothing() -> None:
    found, still = Findings(), Motion(RATIO, np.zeros(9), np.zeros(9), np.arange(9.0), None)
    bare = SimpleNamespace(manifest={}, ratio=RATIO, declared={}, column=lambda name: None, has=lambda name: False)
    add_latch_skew(found, bare, still)  # type: ignore[arg-type]
    assert "was not measured" in found.inconclusive


def test_the_lines_for_the_bench_file_are_read_by_it() -> None:
    one = Estimate("latch_skew_load", "", -12.5, "µs", (-20.0, -5.0), "")
    text = "\n".join(bench_lines(Result("other", Verdict.MEASURED, "", (one,), (), (), {}, {})))
    bench = read("twin")
    changed = bench.text.replace("[load_encoder]", text)
    from rig.config.bench_file import read_bench

    section = read_bench(changed, "changed").load_encoder
    assert section is not None
    assert (section.skew, section.skew_half_width) == (-1.25e-5, 7.5e-6)


def test_a_skew_without_its_interval_is_refused_in_a_bench_file() -> None:
    from rig.config.bench_file import read_bench

    with pytest.raises(UsageError, match="a skew without its interval is no measurement"):
        read_bench(read("twin").text.replace("[load_encoder]", "[load_encoder]\nskew = 1e-5"), "half")


def test_one_speed_is_refused() -> None:
    with pytest.raises(UsageError, match="at least 2 different speeds"):
        Skew(speeds_rpm="60,60")


@pytest.mark.slow
@pytest.mark.parametrize(("load", "torque"), [(0.0, 0.0), (5e-4, -1e-3)])
def test_on_the_twin_it_is_the_skew_the_twin_was_given(load: float, torque: float) -> None:
    bench = read("twin", [f"twin.effects.sensors.load_skew={load}", f"twin.effects.sensors.torque_skew={torque}"])
    rig = SimpleNamespace(bench=bench, instruments=bench.open("virtual"))
    rig.instruments.connect()
    _, sink = run(rig, Skew())
    t, theta_m, theta_l, tau_l = (
        np.array([getattr(row[0], name) for row in sink.rows]) for name in ("t", "theta_m", "theta_l", "tau_l")
    )
    found = legs(t, theta_m, theta_l, np.array([row[-1] for row in sink.rows]), tau_l)
    both = pairs(found, RATIO)
    late, drawn = load_encoder_late(both, GEAR), torque_late(found, both, RATIO)
    assert len(both) == 6
    assert late.value == pytest.approx(load + 2e-6, abs=late.half)  # latch_l of the twin is 2 µs
    assert late.half < 2e-5
    assert drawn is not None
    lag = 1 / (2 * np.pi * 1000.0)  # s, of the twin's sensor filter
    assert drawn.value == pytest.approx(torque + 5e-5 - lag - load - 2e-6, abs=drawn.half)
