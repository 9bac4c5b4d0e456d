"""Values of parameters as somebody writes them."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from rig.core.errors import UsageError
from rig.parameters import make


@dataclass(frozen=True)
class Asked:
    speeds_rpm: str = "5,10"
    rates: tuple[float, ...] = (1.0, 0.3)


@pytest.mark.parametrize(("raw", "kept"), [(900, "900"), (9.6, "9.6"), (-5, "-5"), ("5,10", "5,10")])
def test_one_number_where_a_list_is_written_as_text_is_a_list_of_one(raw: object, kept: str) -> None:
    made = make(Asked, {"speeds_rpm": raw}, "friction").speeds_rpm
    assert made == kept
    assert isinstance(raw, str) or float(made) == raw


def test_one_number_where_a_list_is_wanted_is_a_list_of_one() -> None:
    assert make(Asked, {"rates": 0.5}, "friction").rates == (0.5,)


@pytest.mark.parametrize("raw", [True, float("nan"), float("inf"), 1e300, None, [900]])
def test_what_is_no_number_and_no_text_is_refused_by_name(raw: object) -> None:
    with pytest.raises(UsageError, match="speeds_rpm = "):
        make(Asked, {"speeds_rpm": raw}, "friction")
