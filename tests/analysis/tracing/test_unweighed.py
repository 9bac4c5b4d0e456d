"""A weight that no manifest states is told by the shaft torque, and friction is taken for none."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.runs.unweighed import weighed


@dataclass(frozen=True)
class Piece:
    t: np.ndarray
    way: np.ndarray
    tau_ext: np.ndarray


@dataclass(frozen=True)
class Taken:
    name: str
    mean_torque: float
    pieces: tuple[Piece, ...]
    load_stated: bool = False
    load_known: bool = True
    said: str = "kinematic_error []"
    procedure: str = "kinematic_error"
    locked: bool = False
    has: frozenset[str] = frozenset({"tau_l"})


def taken(name: str, torque: float, one_way: bool = False, stated: bool = False) -> Any:
    way = np.ones(100) if one_way else np.where(np.arange(100) < 50, 1.0, -1.0)
    return Taken(name, torque, (Piece(np.arange(100) / 100, way, np.zeros(100)),), stated)


SLOW, FAST = taken("slow", 0.02), [taken(f"speed_{k}", 0.6 + 0.25 * k, one_way=True) for k in range(4)]


def weights(*runs: Any) -> dict[str, float]:
    told, _ = weighed(list(runs))
    return {r.name: float(r.pieces[0].tau_ext[0]) for r in told if not r.load_known}


def test_weights_are_told_from_friction_and_repeats_have_one() -> None:
    loads = [taken(f"load_{w}_{k}", w + 0.01 * k) for w in (2.5, 10.0, 40.0) for k in (1, 2)]
    found = weights(SLOW, *FAST, *loads)
    assert set(found) == {r.name for r in loads}
    assert found["load_10.0_1"] == found["load_10.0_2"] == pytest.approx(-10.015)
    told, said = weighed([SLOW, *FAST, *loads])
    assert len({r.said for r in told}) == 4, "three weights, and none"
    assert [s.run for s in said if "10" in s.reason]


def test_what_is_stated_stands_whatever_the_torque() -> None:
    assert weights(SLOW, *FAST, taken("load", 40.0, stated=True)) == {}


def test_one_log_alone_that_turns_one_way_has_friction_and_no_weight() -> None:
    assert weights(taken("log", 3.0, one_way=True)) == {}


def test_the_mean_of_a_torque_is_the_runs_own_where_its_load_is_not_known() -> None:
    runs = [SimpleNamespace(locked=False, load_known=known) for known in (True, False)]
    eq = cast(Any, SimpleNamespace(runs=runs, noise=SimpleNamespace(pull=lambda channel, n: 0.3)))
    assert [Equations.share_of_mean(eq, (i, "L"), 100) for i in (0, 1)] == [0.3, 1.0]
    assert Equations.share_of_mean(eq, (1, "M"), 100) == 0.3
