"""Readings that are missing here and there: the run is named, its other rows and the other runs stay."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.holes import without_holes
from rig.analysis.tracing.runs.told_once import Said, left_out, told_once
from rig.core.errors import UsageError
from tests.hostile.test_campaigns import Columns, campaign


def without(name: str) -> Callable[[Columns], Columns]:
    return lambda c: {n: x for n, x in c.items() if n != name}


def set_to(name: str, rows: slice, value: float) -> Callable[[Columns], Columns]:
    def change(c: Columns) -> Columns:
        x = c[name].copy()
        x[rows] = value
        return {**c, name: x}

    return change


def one_odd(root: Path, change: Callable[[Columns], Columns], good: int = 3) -> Path:
    """A campaign of good runs, and `odd` that is not."""
    campaign(root, lambda c: c, good)
    campaign(root / "more", change, 1)
    shutil.move(root / "more" / "run-0", root / "odd")
    return root


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", ["tau_m", "tau_l"])
def test_a_torque_missing_in_a_few_rows_costs_these_rows_and_is_said(tmp_path: Path, name: str, value: float) -> None:
    found = read_campaign(one_odd(tmp_path, set_to(name, slice(100, 104), value)))
    assert {run.name for run in found.runs} == {"odd", "run-0", "run-1", "run-2"}
    assert f"odd: 4 of 5000 rows left out: {name} was missing." in found.notes
    odd = next(run for run in found.runs if run.name == "odd")
    assert all(np.isfinite(getattr(piece, n)).all() for piece in odd.pieces for n in ("tau_m", "tau_l", "torque"))


@pytest.mark.parametrize("name", ["t", "theta_l", "tau_l"])
def test_a_run_that_lacks_what_the_others_have_is_left_out_by_name(tmp_path: Path, name: str) -> None:
    found = read_campaign(one_odd(tmp_path, without(name)))
    assert [run.name for run in found.runs] == ["run-0", "run-1", "run-2"]
    assert any(n.startswith("odd was left out: it has no ") and "3 of 4 runs" in n for n in found.notes)


@pytest.mark.parametrize("name", ["t", "theta_m", "theta_l", "tau_l", "tau_m"])
def test_a_channel_that_no_run_has_leaves_none_out(tmp_path: Path, name: str) -> None:
    assert len(read_campaign(campaign(tmp_path, without(name), 3)).runs) == 3


def test_a_run_without_a_motor_torque_stays(tmp_path: Path) -> None:
    assert len(read_campaign(one_odd(tmp_path, without("tau_m"))).runs) == 4


def test_angles_taken_for_each_other_are_told_of_a_run_whose_motor_hardly_goes(tmp_path: Path) -> None:
    found = read_campaign(one_odd(tmp_path, lambda c: {**c, "theta_m": c["theta_l"], "theta_l": c["theta_m"]}))
    [said] = [note for note in found.notes if note.startswith("odd was left out")]
    assert "of a turn, a kinematic error needs a whole one; θ_l goes " in said
    assert said.endswith("θ_m and θ_l seem to be taken for each other: expected the motor's angle in theta_m.")


def test_a_folder_of_samples_without_a_manifest_is_said(tmp_path: Path) -> None:
    one_odd(tmp_path, lambda c: c)
    (tmp_path / "odd" / "manifest.json").unlink()
    (tmp_path / "pictures").mkdir()
    found = read_campaign(tmp_path)
    [said] = found.notes
    assert said.startswith("odd was left out: it has samples and no manifest.json; hdrig recover makes it anew")


def test_a_reason_that_many_runs_share_is_said_once(tmp_path: Path) -> None:
    with pytest.raises(UsageError) as caught:
        read_campaign(campaign(tmp_path, lambda c: c, 13, gear={"ratio": -50}))
    said = str(caught.value)
    assert "13 runs (run-0, run-1, run-10 …) were left out: manifest.json: gear.ratio is -50" in said
    assert said.count("gear.ratio") == 1


def test_two_of_a_kind_are_named_and_numbers_may_differ() -> None:
    two = [left_out("a", "it has 10 rows"), left_out("b", "it has 12 rows.")]
    assert told_once(two) == ["a was left out: it has 10 rows.", "b was left out: it has 12 rows."]
    many = [Said(name, "", f"{n} rows left out.") for n, name in enumerate("abcd", 1)]
    assert told_once(many) == ["4 runs (a, b, c …): 1 rows left out; the numbers are those of a."]


def test_breaks_are_counted_in_the_rows_that_stay_and_without_time_a_hole_is_one() -> None:
    t, torque = np.arange(10.0), np.arange(10.0)
    torque[[3, 4]] = np.nan
    channels, breaks, words = without_holes({"t": t, "tau_l": torque, "tau_m": None}, (6,))
    assert breaks == (4,)
    assert channels["t"] is not None
    assert channels["t"].tolist() == [0, 1, 2, 5, 6, 7, 8, 9]
    assert words == "2 of 10 rows left out: tau_l was missing."
    assert without_holes({"t": None, "tau_l": torque, "tau_m": None}, ())[1] == (3,)
