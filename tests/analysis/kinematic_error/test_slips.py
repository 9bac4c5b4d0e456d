"""A step of θ̃ that stays is told with its size and instant; what comes and goes, wanders or repeats is none."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import Verdict, analyse
from rig.core.units import ARCSEC, TURN
from tests.analysis.synthetic import MadeRun, slow_run


def made(shift: np.ndarray | float = 0.0) -> MadeRun:
    """A slow run of two cycles whose load angle is `shift` arcsec off."""
    run = slow_run(1)
    names = [n for n in ("t", "theta_m", "theta_l", "theta_ref", "tau_m", "tau_l", "flags") if run.has(n)]
    columns = {n: np.array(run.column(n)) for n in names}
    columns["theta_l"] += shift * ARCSEC
    return MadeRun(columns, dict(run.manifest) | {"limits": {"kinematic_error_peak_to_peak": 1e4}})


def clock() -> np.ndarray:
    t = slow_run(1).column("t")
    assert t is not None
    return np.asarray(t)


@pytest.mark.parametrize(("at", "size"), [(33.3, 40.0), (61.0, -12.0), (40.0, 400.0)])
def test_lost_counts_are_told_and_settle_no_limit(at: float, size: float) -> None:
    found = analyse(made(np.where(clock() > at, -size, 0.0)))
    (check,) = [c for c in found.checks if c.name == "slips"]
    words = check.sentence.replace("−", "-").split()
    assert float(words[3]) == pytest.approx(size, rel=0.05, abs=1.5)
    assert float(words[words.index("=") + 1]) == pytest.approx(at, abs=0.3)
    assert found.verdict is Verdict.INCONCLUSIVE
    assert "θ̃ steps by" in found.sentence


@pytest.mark.parametrize(
    "shift",
    [
        0.0,
        40.0 * np.exp(-(((clock() - 33.3) / 0.3) ** 2)),  # comes and goes
        40.0 * clock() / 100.0,  # drifts
        20.0 * np.sin(clock() / 3.0),  # wanders
    ],
)
def test_what_comes_and_goes_drifts_or_wanders_is_no_slip(shift: np.ndarray | float) -> None:
    assert not [c for c in analyse(made(shift)).checks if c.name == "slips"]


def ramped(windup: float, step: float) -> MadeRun:
    """Twenty turns forward at 120 rpm with a run-up and a run-down of a second, while which the gear is wound up by
    `windup` arcsec, and a `step` of θ̃ in the middle."""
    t = np.arange(0.0, 12.0, 1e-3)
    ramp = np.clip(np.minimum(t - 0.5, 11.5 - t), 0.0, 1.0)
    theta_m = np.cumsum(2 * TURN * ramp) * 1e-3
    wound = windup * np.sign(np.gradient(ramp)) + step * (t > 6.0)
    theta_l = theta_m / 50 - ARCSEC * (40.0 * np.cos(2 * theta_m) + wound)
    zero = np.zeros(t.size)
    columns = {"t": t, "theta_m": theta_m, "theta_l": theta_l, "theta_ref": theta_m, "tau_m": zero, "tau_l": zero}
    return MadeRun(columns | {"flags": zero}, dict(slow_run(1).manifest))


def test_a_gear_that_is_wound_up_while_its_load_gains_speed_has_not_slipped() -> None:
    assert not [c for c in analyse(ramped(8.0, 0.0)).checks if c.name == "slips"]
    (check,) = [c for c in analyse(ramped(8.0, 12.0)).checks if c.name == "slips"]
    assert "t = 6.0" in check.sentence
    assert check.sentence.count("arcsec at") == 1


def eccentric(rpm: float, at_once: float) -> MadeRun:
    """A minute at one speed: 300 µrad once a turn of the output, steep beside a slip, and 3 µrad of noise."""
    t = np.arange(0.0, 60.0, 1e-3)
    theta_m = rpm / 60 * TURN * t
    theta_l = (
        theta_m / 50 - 1e-4 * np.cos(2 * theta_m) + 3e-4 * np.cos(theta_m / 50 + 0.4) - ARCSEC * at_once * (t > 31)
    )
    theta_l = theta_l + 3e-6 * np.random.default_rng(1).standard_normal(t.size)
    manifest = {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": 50}}
    return MadeRun({"t": t, "theta_m": theta_m, "theta_l": theta_l}, manifest)


@pytest.mark.parametrize("rpm", [400.0, *(pytest.param(rpm, marks=pytest.mark.slow) for rpm in (450.0, 600.0))])
def test_an_eccentric_encoder_slips_nowhere(rpm: float) -> None:
    assert not [c for c in analyse(eccentric(rpm, 0.0)).checks if c.name == "slips"]


def test_a_slip_beside_an_eccentric_encoder_is_told() -> None:
    (check,) = [c for c in analyse(eccentric(600.0, 30.0)).checks if c.name == "slips"]
    assert "t = 31.0" in check.sentence


@pytest.mark.parametrize("turns", [4, 6, 9])
def test_of_few_turns_one_slip_is_no_three_though_the_mean_turn_has_a_part_of_it(turns: int) -> None:
    t = np.arange(0.0, turns + 1.0, 1e-3)
    theta_m = TURN * t
    rng = np.random.default_rng(1)
    error = 30.0 * np.cos(2 * theta_m) + 400.0 * (t > turns / 2 + 0.3) + 0.2 * rng.standard_normal(t.size)
    columns = {"t": t, "theta_m": theta_m, "theta_l": theta_m / 50 - ARCSEC * error, "theta_ref": theta_m}
    zeros = {name: np.zeros(t.size) for name in ("tau_m", "tau_l", "flags")}
    found = analyse(MadeRun(columns | zeros, dict(slow_run(1).manifest)))
    (check,) = [c for c in found.checks if c.name == "slips"]
    assert check.sentence.count("arcsec at") == 1
    assert f"t = {turns / 2 + 0.3:.1f}" in check.sentence
