"""Numbers as shown to people."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.report.numbers import ABSENT, MINUS, SPACE, THIN, companion, duration, estimate, fixed, places, plain, quantity

ordinary = st.floats(-1e5, 1e5)
half_widths = st.floats(1e-3, 1e4)


def read(text: str) -> float:
    return float(text.replace(MINUS, "-").replace(THIN, ""))


@pytest.mark.parametrize(
    ("value", "half", "unit", "shown"),
    [
        (93.4127, 1.3711, "arcsec", "93.4 ± 1.4 arcsec"),
        (93.4127, 0.2711, "arcsec", "93.41 ± 0.27 arcsec"),
        (7163.2, 118.0, "N·m/rad", "7160 ± 120 N·m/rad"),
        (12345.0, 1180.0, "counts", f"12{THIN}300 ± 1200 counts"),
        (-0.004, 0.31, "arcsec", "0.00 ± 0.31 arcsec"),
        (-29.198, 0.0321, "arcsec", f"{MINUS}29.198 ± 0.032 arcsec"),
        (9.99, 0.0996, "", "9.99 ± 0.10"),
        (1.0, 9.97, "rpm", "1 ± 10 rpm"),
        (3.1e-6, 1.2e-7, "rad", "(3.10 ± 0.12)·10⁻⁶ rad"),
        (2.5e7, 1.2e6, "Hz", "(25.0 ± 1.2)·10⁶ Hz"),
        (35.0, 3.4, "°", "35.0 ± 3.4°"),
        (28.0, 0.0, "1", "28"),
        (0.957, math.nan, "%", "0.957 %"),
        (math.nan, 1.0, "rpm", ABSENT),
    ],
)
def test_a_quantity_has_the_digits_its_uncertainty_carries(value: float, half: float, unit: str, shown: str) -> None:
    assert quantity(value, half, unit).replace(SPACE, " ") == shown


@given(ordinary, half_widths)
def test_value_and_half_width_end_at_the_same_place(value: float, half: float) -> None:
    shown, _, spread = quantity(value, half).partition(" ± ")
    assert len(shown.partition(".")[2]) == len(spread.partition(".")[2])


@given(ordinary, half_widths)
def test_what_is_shown_is_within_a_twentieth_of_the_half_width_of_the_value(value: float, half: float) -> None:
    shown, _, spread = quantity(value, half).partition(" ± ")
    assert abs(read(shown) - value) <= 0.051 * half
    assert abs(read(spread) - half) <= 0.051 * half


@given(half_widths)
def test_the_half_width_has_two_significant_digits(half: float) -> None:
    digits = quantity(0.0, half).partition(" ± ")[2].replace(".", "").replace(THIN, "").lstrip("0")
    assert len(digits.rstrip("0")) <= 2 <= max(len(digits), 2)
    assert places(half) == places(read(fixed(half, places(half))))


@given(ordinary, st.integers(-3, 8))
def test_zero_never_carries_a_sign(value: float, decimals: int) -> None:
    text = fixed(value, decimals)
    assert not text.startswith(MINUS) or any(c in "123456789" for c in text)
    assert "-" not in text


@given(st.floats(allow_nan=True, allow_infinity=True), st.floats(allow_nan=True, allow_infinity=True))
def test_no_number_is_too_strange_to_show(value: float, half: float) -> None:
    assert quantity(value, half, "N·m")
    assert estimate(value, (value - half, value + half), "N·m")
    assert plain(value)
    assert duration(value)


@given(st.floats(-1e12, 1e12, allow_subnormal=False), st.integers(2, 6))
def test_a_plain_number_keeps_its_significant_digits(value: float, digits: int) -> None:
    text, _, power = plain(value, digits).partition("·10")
    exponent = int(power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))) if power else 0
    assert math.isclose(read(text) * 10.0**exponent, value, rel_tol=0.51 * 10 ** (1 - digits), abs_tol=1e-300)


def test_an_interval_that_lies_to_one_side_is_shown_by_its_ends() -> None:
    assert estimate(9.6, (8.1, 14.2), "rpm") == f"9.6 (8.1 to 14.2){SPACE}rpm"
    assert estimate(0.1, (0.0, 0.28), "arcsec") == f"0.10 (0.00 to 0.28){SPACE}arcsec"


def test_arcsec_has_arcmin_beside_it_and_rpm_has_nothing() -> None:
    assert companion(93.6, (92.4, 94.8), "arcsec") == f"1.560 ± 0.020{SPACE}arcmin"
    assert companion(7160.0, (7040.0, 7280.0), "N·m/rad") == f"2.083 ± 0.035{SPACE}N·m/arcmin"
    assert companion(9.6, (9.5, 9.7), "rpm") == ""


@pytest.mark.parametrize(
    ("seconds", "shown"), [(0.83, "0.83 s"), (100.0, "100 s"), (201.0, "3 min 21 s"), (7500.0, "2 h 05 min")]
)
def test_a_duration_is_said_as_people_say_it(seconds: float, shown: str) -> None:
    assert duration(seconds).replace(SPACE, " ") == shown
