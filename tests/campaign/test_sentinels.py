"""The sentinels of a campaign set side by side in its summary."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rig.campaign import summary
from rig.campaign.journal import Journal

BOOK = {
    "name": "made up", "backend": "sim", "status": "completed", "sentence": "", "started_utc": "2026-11-20T10:00:00",
    "sessions": [""], "seed": 1, "changes": [], "pending": None, "notes": [],
}  # fmt: skip


def entry(folder: Path, number: int, torque: float, given: float = 0.42, **conditions: Any) -> dict[str, Any]:
    """A sentinel that was made, with its figures in `folder`."""
    run = folder / f"{number}"
    run.mkdir()
    figure = {"label": "Mean motor torque", "value": torque, "unit": "N·m", "ci95": [torque - 0.002, torque + 0.002]}
    (run / "result.json").write_text(json.dumps({"estimates": {"mean_motor_torque": figure}}))
    parameters = {"speed_rpm": 310, "torque": given} if given else {"speed_rpm": 310}
    return {
        "kind": "sentinel", "procedure": "sentinel", "parameters": parameters, "repeat": 1, "of": 1,
        "conditions": {"tau_ext": 0.0, "output_locked": False, "depth_mm": 0.0, "assembly": 1, **conditions},
        "status": "done", "sentence": "", "run": str(number), "attempts": [],
    }  # fmt: skip


def said(folder: Path, *entries: dict[str, Any]) -> list[str]:
    """What the summary says of sentinels."""
    lines = summary.lines(Journal(folder, {**BOOK, "rig_time_s": 0.0, "runs": list(entries)}))
    return [line for line in lines if line.startswith("sentinel")]


def test_the_summary_says_by_how_much_the_torque_changed(tmp_path: Path) -> None:
    assert said(tmp_path, entry(tmp_path, 1, 0.40), entry(tmp_path, 2, 0.44)) == [
        "sentinels: Mean motor torque changed: 0.4 N·m first, 0.44 N·m last, change +0.04 ± 0.0036 N·m "
        "over 2 sentinels (interval: 95 % for all that is compared together)."
    ]


def test_sentinels_under_another_weight_and_a_single_one_are_not_compared(tmp_path: Path) -> None:
    assert said(tmp_path, entry(tmp_path, 1, 0.40), entry(tmp_path, 2, 0.44, tau_ext=5.0)) == []


def test_a_fitting_between_them_is_named(tmp_path: Path) -> None:
    (line,) = said(tmp_path, entry(tmp_path, 1, 0.40), entry(tmp_path, 2, 0.44, assembly=2))
    assert line.startswith("sentinels, the wave generator fitted anew between them: Mean motor torque changed")


def test_one_that_was_not_analysed_or_not_made_leaves_the_summary_whole(tmp_path: Path) -> None:
    first, second = entry(tmp_path, 1, 0.40), entry(tmp_path, 2, 0.44)
    (tmp_path / "2" / "result.json").write_text("{")
    (line,) = said(tmp_path, first, second)
    assert line.startswith("sentinel left out: ")
    assert said(tmp_path, first, {**second, "status": "failed"}) == []


def test_what_follows_from_a_torque_found_anew_is_no_change_of_the_rig(tmp_path: Path) -> None:
    """As on an untouched twin: 0.7 % apart, which 5 s of a friction that wanders leave open."""
    entries = [entry(tmp_path, n, torque, given=0.0) for n, torque in ((1, 0.426), (2, 0.429))]
    for one, rpm in zip(entries, (301.0, 315.0), strict=True):
        path = tmp_path / one["run"] / "result.json"
        speed = {"label": "Mean motor speed", "value": rpm, "unit": "rpm", "ci95": [rpm - 2, rpm + 2]}
        path.write_text(json.dumps({"estimates": {**json.loads(path.read_text())["estimates"], "mean_speed": speed}}))
    torque, rest = said(tmp_path, *entries)
    assert "Mean motor torque did not change" in torque
    assert "each found its own torque" in rest
    given = [{**one, "parameters": {"speed_rpm": 310, "torque": 0.42}} for one in entries]
    assert any("Mean motor speed changed" in line for line in said(tmp_path, *given))


def test_a_torque_found_anew_that_is_clearly_another_is_told(tmp_path: Path) -> None:
    lines = said(tmp_path, entry(tmp_path, 1, 0.40, given=0.0), entry(tmp_path, 2, 0.44, given=0.0))
    assert lines[0].startswith("sentinels: Mean motor torque changed")
