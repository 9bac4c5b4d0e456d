"""Numbers that cannot be a gear's are refused with what was measured, what was expected, and what to change."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from .conftest import Foreign, with_column
from .formats import MAPPING, ROWS, columns, truth


def test_another_ratio_than_declared_is_told_with_both_numbers(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace("ratio = 50", "ratio = 51"))
    assert "theta_m turns 49.9965 times as far as theta_l (over 144 deg of load)" in said
    assert "gear.ratio = 51 does not fit" in said


def test_a_ratio_within_what_wind_up_explains_is_taken(foreign: Foreign) -> None:
    assert foreign.imported(foreign.file(), MAPPING.replace("ratio = 50", "ratio = 50.1")).ratio == 50.1


def test_an_angle_the_wrong_way_round_is_told_with_the_sign_to_flip(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace("sign = -1", "sign = 1"))
    assert "theta_m turns -49.9965 times as far as theta_l" in said
    assert "set channels.theta_l.sign = -1" in said
    assert "does not fit" not in said


def test_the_sign_is_no_cure_for_another_gear(foreign: Foreign) -> None:
    mapping = MAPPING.replace("sign = -1", "sign = 1").replace("ratio = 50", "ratio = 80")
    said = foreign.refused(foreign.file(), mapping)
    assert "theta_m turns -49.9965 times as far as theta_l" in said
    assert "gear.ratio = 80 does not fit" in said
    assert "sign" not in said


def test_one_reading_far_off_is_named_and_no_sign(foreign: Foreign) -> None:
    def struck(load: Any) -> Any:
        out = np.array(load)
        out[300] += 1e5
        return out

    said = foreign.refused(foreign.file(with_column("load", struck)))
    assert "expected 50 (gear.ratio): row 301 of theta_l lies " in said
    assert "sign" not in said


def test_degrees_read_as_radians_show_in_the_ratio(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('unit = "deg"', 'unit = "rad"'))
    assert "gear.ratio = 50 does not fit" in said
    assert "180/π" in said


def test_counts_before_quadrature_show_in_the_ratio(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace("counts_per_turn = 4096", "counts_per_turn = 1024"))
    assert "theta_m turns 199.986 times as far" in said
    assert "about 4: counts of one are taken before quadrature" in said


def test_two_angles_that_have_nothing_to_do_with_each_other(foreign: Foreign) -> None:
    data = with_column("load", lambda load: np.random.default_rng(3).normal(0, 40, load.size))
    said = foreign.refused(foreign.file(data))
    assert "gear.ratio = 50 does not fit" in said


def test_milliseconds_read_as_seconds(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('unit = "ms"', 'unit = "s"'))
    assert "median sample period is 2 s with channels.t.unit = 's'" in said
    assert "expected 9e-06 to 0.5 s" in said


def test_a_kilohertz_in_milliseconds_read_as_seconds(foreign: Foreign) -> None:
    data = with_column("time", lambda t: 5000.0 + np.arange(t.size))
    assert "median sample period is 1 s" in foreign.refused(foreign.file(data), MAPPING.replace('"ms"', '"s"', 1))


def test_a_kilohertz_in_seconds_read_as_milliseconds(foreign: Foreign) -> None:
    data = with_column("time", lambda t: np.arange(t.size) * 1e-3)
    assert "median sample period is 1e-06 s with channels.t.unit = 'ms'" in foreign.refused(foreign.file(data))


def test_epoch_milliseconds_read_as_seconds(foreign: Foreign) -> None:
    data = with_column("time", lambda t: 1_793_000_000_000 + np.arange(t.size) * 0.25)
    said = foreign.refused(foreign.file(data), MAPPING.replace('unit = "ms"', 'unit = "s"'))
    assert "time starts at 1.793e+12 s, 5.682e+04 years after zero" in said


def test_a_stamp_far_after_the_others_is_no_gap(foreign: Foreign) -> None:
    data = columns()
    data["time"][-1] = 1e14
    assert "t spans 1e+11 s; expected less than a year" in foreign.refused(foreign.file(data))


def notes(foreign: Foreign, stated: float) -> str:
    """Of a run for which a motor speed [rpm] was stated."""
    run = foreign.imported(foreign.file(), MAPPING + f"[conditions]\nspeed_rpm = {stated}\n")
    return " | ".join(run.manifest["notes"])


def test_a_speed_that_was_stated_and_is_another_is_told(foreign: Foreign) -> None:
    t, theta_m = truth()["t"], truth()["theta_m"]
    rpm = float(np.ptp(theta_m) / np.ptp(t)) * 60 / (2 * np.pi)
    assert "was stated" not in notes(foreign, rpm)
    said = notes(foreign, rpm / 50)
    assert "rpm was stated, and the motor turns at " in said
    assert "is it the output's speed" in said


def test_a_motor_faster_than_any(foreign: Foreign) -> None:
    data = with_column("time", lambda t: t / 30)
    said = foreign.refused(foreign.file(data))
    assert "theta_m and t make a motor speed of 4.5" in said
    assert "expected below 20000 rpm" in said


@pytest.mark.parametrize(
    ("unit", "factor", "sign", "hint"),
    [
        ("rad/s", 30 / np.pi, 1, "about 30/π: one is in rpm, the other in rad/s"),
        ("rpm", 6.0, 1, "about 6: one is in rpm, the other in deg/s"),
        ("rad/s", 0.5 / np.pi, 1, "about 2π: one is in turns/s"),
        ("rad/s", 60.0, 1, "about 60: one is a minute's"),
        ("rad/s", 1 / 50, 1, "gear.ratio: it is the other shaft's"),
        ("rad/s", 1.0, -1, "set channels.omega_m.sign = -1"),
    ],
)
def test_a_speed_that_is_not_what_the_angle_does_is_told_with_its_factor(
    foreign: Foreign, unit: str, factor: float, sign: int, hint: str
) -> None:
    run = truth()
    in_unit = np.gradient(run["theta_m"], run["t"]) * (30 / np.pi if unit == "rpm" else 1.0)
    data = columns() | {"speed": sign * factor * in_unit}
    said = foreign.refused(foreign.file(data), MAPPING + f'[channels.omega_m]\ncolumn = "speed"\nunit = "{unit}"\n')
    assert "omega_m is " in said
    assert "times what theta_m does in time; expected 1" in said
    assert hint in said


def test_a_speed_that_agrees_with_the_angle_is_taken(foreign: Foreign) -> None:
    run = truth()
    data = columns() | {"speed": np.gradient(run["theta_m"], run["t"]) * 30 / np.pi}
    mapping = MAPPING + '[channels.omega_m]\ncolumn = "speed"\nunit = "rpm"\n'
    assert foreign.imported(foreign.file(data), mapping).has("omega_m")


def test_an_angle_beyond_what_a_float_resolves(foreign: Foreign) -> None:
    data = with_column("load", lambda load: load * 1e12)
    assert "theta_l reaches 2.535e+12 rad; expected below 1e+09 rad" in foreign.refused(foreign.file(data))


def test_a_torque_a_thousand_times_too_large_for_the_wind_up(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('unit = "mN·m"', 'unit = "N·m"'))
    assert "is a stiffness of 2e+07 N·m/rad; expected 50 to 5e+06 N·m/rad (channels.tau_l.unit = 'N·m')" in said


def test_a_torque_too_large_for_any_gear(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('unit = "mN·m"', 'unit = "kN·m"'))
    assert "tau_l reaches 3e+06 N·m; expected below 20000 N·m (channels.tau_l.unit = 'kN·m')" in said


def test_a_torque_a_thousand_times_too_small(foreign: Foreign) -> None:
    data = with_column("torque", lambda torque: torque * 1e-3)
    said = foreign.refused(foreign.file(data))
    assert "is a stiffness of 20 N·m/rad; expected 50 to 5e+06 N·m/rad (channels.tau_l.unit = 'mN·m')" in said


def test_a_sensor_that_shows_far_more_than_the_motor_gives(foreign: Foreign) -> None:
    rng = np.random.default_rng(5)
    data = columns() | {"torque": rng.normal(0, 3000.0, ROWS), "temperature": rng.normal(0, 0.06, ROWS)}
    mapping = MAPPING.split("[channels.temperature]")[0].replace('"mN·m"', '"N·m"')
    said = foreign.refused(foreign.file(data), mapping + '[channels.tau_m]\ncolumn = "temperature"\nunit = "N·m"\n')
    assert "N·m rms, but gear.ratio·tau_m only " in said
    assert "expected less than 100 times as much" in said


def test_a_torque_that_falls_with_wind_up_is_told_with_the_sign_to_flip(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(with_column("torque", lambda torque: -torque)))
    assert "is a stiffness of -2e+04 N·m/rad; expected a positive one: set channels.tau_l.sign = -1" in said


@pytest.mark.parametrize(
    ("column", "channel", "mend"),
    [("motor", "theta_m", "procedure = 'standstill'"), ("load", "theta_l", "conditions.output_locked = true")],
)
def test_an_angle_that_stands_still(foreign: Foreign, column: str, channel: str, mend: str) -> None:
    data = with_column(column, lambda values: values * 0 + 77)
    said = foreign.refused(foreign.file(data))
    assert f"{channel} stands at " in said
    assert "in all 400 rows, though procedure = 'kinematic_error' moves it" in said
    assert mend in said


def test_a_locked_output_may_stand_still(foreign: Foreign) -> None:
    data = with_column("load", lambda values: values * 0 + 77)
    mapping = MAPPING.replace('procedure = "kinematic_error"', 'procedure = "stiffness_lock"').replace("mN·m", "N·m")
    data["motor"] = np.round(700 + 100 * np.sin(9 * truth()["t"])).astype(np.int64)
    data["torque"] = data["motor"] * (2 * np.pi / 4096) / 50 * 20_000.0  # N·m at 20 kN·m/rad
    assert foreign.imported(foreign.file(data), mapping + "[conditions]\noutput_locked = true\n").rows == ROWS


def test_what_was_accepted_with_a_reason_is_imported_and_noted(foreign: Foreign) -> None:
    mapping = MAPPING.replace("ratio = 50", "ratio = 51") + '[accept]\nratio = "plate says 51"\n'
    notes = foreign.imported(foreign.file(), mapping).manifest["notes"]
    assert any(n.startswith("accepted (plate says 51): theta_m turns 49.9965 times") for n in notes)
