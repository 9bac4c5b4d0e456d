"""The other methods of the blind test: they get the tracer's split, tune on fitted runs, and may be absent."""

from __future__ import annotations

import builtins
import json
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from tests.blind.peers import compare
from tests.blind.peers.compare import Outcome, over_floor, table
from tests.blind.peers.data import Rows, Split, held_out
from tests.blind.peers.peer import halves
from tests.blind.peers.rich_friction import RichFriction

NAMES = (
    "w",
    "dw",
    "T",
    "side",
    "place",
    "cos1",
    "sin1",
    "cos2",
    "sin2",
    "cos4",
    "sin4",
    "cos_l",
    "sin_l",
    "T_0.5",
    "T_0.1",
)


def rows(seed: int, runs: tuple[str, ...]) -> Rows:
    """Rows whose residual is Stribeck friction alone."""
    rng = np.random.default_rng(seed)
    x = rng.normal(0, 1, (300 * len(runs), len(NAMES)))
    x[:, 0] = rng.uniform(-8, 8, len(x))
    x[:, 3] = np.sign(x[:, 0])
    y = 0.05 * x[:, 3] * np.exp(-np.abs(x[:, 0])) + rng.normal(0, 1e-3, len(x))
    return Rows(NAMES, x, y, np.repeat(runs, 300))


SPLIT = Split(rows(1, ("a", "b", "c", "d")), rows(2, ("e", "f")))


def left(guess: np.ndarray) -> float:
    return over_floor(SPLIT.held.y - guess, SPLIT, {"e": 1e-3, "f": 1e-3})


def test_the_split_is_the_tracers_where_it_has_traced(tmp_path: Path) -> None:
    trace = tmp_path / "case-001.json"
    assert held_out(["slow_ke_1", "slow_ke_2", "load_10nm_1"], trace) == {"slow_ke_2", "load_10nm_1"}
    trace.write_text(json.dumps({"runs": {"fitted": [], "held_out": ["slow_ke_1"]}}), encoding="utf-8")
    assert held_out(["slow_ke_1", "slow_ke_2"], trace) == {"slow_ke_1"}


def test_tuning_takes_whole_runs_of_the_fitted_ones() -> None:
    fit, tune = halves(SPLIT.train)
    assert set(SPLIT.train.run[tune]) == {"b"}
    assert not np.any(fit & tune)


def test_rich_friction_finds_friction_and_says_nothing_of_angles() -> None:
    assert left(RichFriction().guess(SPLIT, "tau_m").y) < 1.5 < left(np.zeros_like(SPLIT.held.y))
    assert not np.any(RichFriction().guess(SPLIT, "theta_l").y)


def test_sparse_regression_on_physics_finds_the_planted_family() -> None:
    pytest.importorskip("pysindy", reason="the extra 'peers' is not installed")
    from tests.blind.peers.sparse import SparsePhysical

    guess = SparsePhysical().guess(SPLIT, "tau_m")
    assert "stribeck" in guess.families
    assert left(guess.y) < 1.5


def test_without_the_extra_the_comparison_ends_in_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    real = builtins.__import__

    def without(name: str, *rest: object, **more: object) -> ModuleType:
        if name.startswith(("sklearn", "pysindy", "sysidentpy")):
            raise ImportError(f"No module named '{name}'", name=name)
        return real(name, *rest, **more)  # type: ignore[arg-type]

    for module in ("black_box", "frols", "sparse"):
        monkeypatch.delitem(compare.sys.modules, f"tests.blind.peers.{module}", raising=False)
    monkeypatch.setattr(builtins, "__import__", without)
    assert compare.main([str(tmp_path)]) == 0
    assert "peers left out: sklearn" in capsys.readouterr().err


def test_the_table_counts_cases_made_worse() -> None:
    outcomes = [Outcome(2.0, 1.0, 3, 1.0), Outcome(2.0, 3.0, 5, 1.0)]
    assert "| some method | 2.00 | 2.80 | 1 of 2 | 1 | 4 | 1 s |" in table({"some method": outcomes})
