"""Values of parameters as somebody writes them."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from rig.core.errors import UsageError
from rig.parameters.read import make


@dataclass(frozen=True)
class Asked:
    speeds_rpm: str = "5,10"
    rates: tuple[float, ...] = (1.0, 0.3)


@dataclass(frozen=True)
class Slow:
    frequency: float = 0.01  # Hz, of the triangle
    cycles: int = 2  # of it


@pytest.mark.parametrize(("raw", "kept"), [(900, "900"), (9.6, "9.6"), (-5, "-5"), ("5,10", "5,10")])
def test_one_number_where_a_list_is_written_as_text_is_a_list_of_one(raw: object, kept: str) -> None:
    made = make(Asked, {"speeds_rpm": raw}, "friction").speeds_rpm
    assert made == kept
    assert isinstance(raw, str) or float(made) == raw


@pytest.mark.parametrize("written", [0.5, "0.5", "(0.5,)"])
def test_one_number_where_a_list_is_wanted_is_a_list_of_one(written: object) -> None:
    assert make(Asked, {"rates": written}, "friction").rates == (0.5,)


@pytest.mark.parametrize("raw", [True, float("nan"), float("inf"), 1e300, None, ["fast"]])
def test_what_is_no_number_and_no_text_is_refused_by_name(raw: object) -> None:
    with pytest.raises(UsageError, match="speeds_rpm = "):
        make(Asked, {"speeds_rpm": raw}, "friction")


@pytest.mark.parametrize("written", ["(1.0, 0.3, 3.0)", "[1.0, 0.3, 3.0]", "1.0,0.3,3", [1, 0.3, 3]])
def test_a_list_is_understood_as_help_prints_it_and_as_people_write_it(written: object) -> None:
    assert make(Asked, {"rates": written}, "try").rates == (1.0, 0.3, 3.0)


@pytest.mark.parametrize("written", ["50,60", [50, 60.0]])
def test_a_list_kept_as_text_may_be_written_as_one(written: object) -> None:
    assert make(Asked, {"speeds_rpm": written}, "try").speeds_rpm == "50,60"


@pytest.mark.parametrize("written", ["1.0,fast", "", "(1.0, -0.3)", "1.0,,3.0"])
def test_what_is_no_list_of_numbers_above_zero_is_refused(written: str) -> None:
    with pytest.raises(UsageError, match="rates = "):
        make(Asked, {"rates": written}, "try")


def test_what_is_refused_is_told_with_its_unit() -> None:
    for given, sentence in (
        ({"frequency": -5.0}, "frequency = -5.0: expected more than 0 Hz, for example 0.01 Hz"),
        ({"cycles": 0}, "cycles = 0: expected more than 0, for example 2"),
    ):
        with pytest.raises(UsageError) as refused:
            make(Slow, given, "try")
        assert str(refused.value) == sentence
