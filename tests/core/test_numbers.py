"""One rule for a number in a file, and one for a declared one."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from rig.analysis.motion.declared import declared
from rig.core.numbers import number, stated
from rig.live.view.about import about
from tests.commands.made_run import made_run


@pytest.mark.parametrize("odd", ["9000", None, True, math.inf, math.nan, 10**400, [1.0], {"value": 1.0}])
def test_what_is_no_number_is_not_taken_for_one(odd: Any) -> None:
    assert math.isnan(number(odd))
    assert number(odd, 1.5) == 1.5


def test_whole_and_broken_numbers_are() -> None:
    assert [number(x) for x in (3, -2.5, 0, np.float64(4.0))] == [3.0, -2.5, 0.0, 4.0]


@pytest.mark.parametrize("said", [9000, 9000.0, {"value": 9000, "unit": "N·m/rad"}])
def test_a_declared_number_may_have_its_unit_beside_it_wherever_it_is_read(said: Any, tmp_path: Any) -> None:
    assert stated(said) == 9000.0
    assert declared({"K": said}, "K") == 9000.0
    assert about(made_run(tmp_path / "run", {"declared": {"K": said}})).stiffness == 9000.0


@pytest.mark.parametrize("odd", [{"unit": "N·m/rad"}, {"value": {"value": 9000}}, {"value": "9000"}, "9000", -1])
def test_what_declares_no_number_leaves_it_unknown(odd: Any) -> None:
    assert declared({"K": odd}, "K") is None
