"""Rulings come from the whole interval, never from the value alone."""

from __future__ import annotations

import math

import pytest

from rig.analysis.reproduction.claim import Number, Ruling, all_of, at_least, at_most, covers, missing, positive

NAN = math.nan
TICK, CROSS, DASH = Ruling.HOLDS, Ruling.FAILS, Ruling.OPEN


@pytest.mark.parametrize(
    ("value", "half", "ruling"), [(1.0, 0.5, TICK), (1.0, 1.5, DASH), (3.0, 1.5, DASH), (4.0, 1.5, CROSS)]
)
def test_a_limit_is_kept_broken_or_not_told(value: float, half: float, ruling: Ruling) -> None:
    number = Number.of(value, half, "arcsec")
    assert at_most(number, 2.0) is ruling
    assert at_least(Number.of(-value, half, "arcsec"), -2.0) is ruling


@pytest.mark.parametrize(("value", "ruling"), [(1.0, TICK), (0.2, DASH), (-0.2, DASH), (-1.0, CROSS)])
def test_positive_needs_the_whole_interval_above_zero(value: float, ruling: Ruling) -> None:
    assert positive(Number.of(value, 0.5, "rpm")) is ruling


def test_nothing_at_all_is_not_positive() -> None:
    assert positive(Number.of(0.0, 0.0, "rpm")) is CROSS


@pytest.mark.parametrize(
    "judge", [positive, lambda n: at_most(n, 9.0), lambda n: at_least(n, -9.0), lambda n: covers(n, 1.0)]
)
def test_without_an_interval_nothing_is_ruled(judge) -> None:  # type: ignore[no-untyped-def]
    assert judge(Number(1.0, NAN, NAN, "rpm")) is DASH


def test_a_declared_number_is_inside_or_outside() -> None:
    assert covers(Number.of(7200.0, 100.0, "N·m/rad"), 7160.0) is TICK
    assert covers(Number.of(7300.0, 100.0, "N·m/rad"), 7160.0) is CROSS


def test_one_failure_fails_all_and_one_doubt_leaves_it_open() -> None:
    assert all_of(TICK, TICK) is TICK
    assert all_of(TICK, DASH) is DASH
    assert all_of(TICK, DASH, CROSS) is CROSS
    assert all_of() is DASH


def test_what_was_not_measured_gets_a_dash() -> None:
    assert missing("it falls", "no run").ruling is DASH


def test_differences_and_ratios_carry_both_intervals() -> None:
    a, b = Number.of(10.0, 3.0, "arcsec"), Number.of(5.0, 4.0, "arcsec")
    assert (a.minus(b).value, a.minus(b).half) == (5.0, 5.0)
    assert a.over(b).value == 2.0
    assert a.over(b).half == pytest.approx(2.0 * math.hypot(0.3, 0.8))
