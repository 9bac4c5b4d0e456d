"""A sweep from the page: its prompts, notes while one is open, and what follows its last run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from rig.console.check import check
from rig.console.described import plans
from rig.runfile.events import read_events
from rig.runfile.manifest import read
from tests.console.hand import Hand

SWEEP = {"weights": [0.0, 3.0], "amplitude_deg": 540.0, "frequency": 0.1}  # 36 rpm, 10 s of rig time each


@pytest.mark.long
def test_a_sweep_from_the_page_keeps_its_note_in_every_run_and_ends_with_its_page(tmp_path: Path) -> None:
    with Hand(tmp_path) as hand:
        hand.connect()
        hand.do("campaign", plan="load-sweep", parameters=SWEEP, note="new grease")
        hand.made("hang 3 N·m")
        hand.prompt("take the weight off")
        assert hand.state()["allowed"]["note"] is True
        hand.do("note", text="weight swings a little")
        folder = Path(hand.state()["campaign"]["folder"])
        hand.made("take the weight off")
        state = hand.until(lambda s: not s["job"])
        last = state["last_run"]
        assert (last["title"], last["status"]) == ("campaign load-sweep", "completed")
        page = hand.client.get(last["report"], params={"token": hand.token})
        assert (page.status_code, "Peak to peak against load" in page.text) == (200, True)
    assert json.loads((folder / "result.json").read_text(encoding="utf-8"))["procedure"] == "load_sweep"
    assert "peak to peak of the kinematic error by load" in (folder / "summary.txt").read_text(encoding="utf-8")
    noted = {path.parent.name: str(read(path.parent)["conditions"]["note"]) for path in folder.rglob("manifest.json")}
    assert len(noted) >= 4 + 4  # runs; proof and weighings
    assert all(note.startswith("new grease") for note in noted.values()), noted
    assert sorted(n for n in noted.values() if ";" in n) == sorted(
        2 * [f"new grease; load sweep, {w}" for w in ("up", "down")]
    )
    book = json.loads((folder / "campaign.json").read_text(encoding="utf-8"))
    assert book["note"] == "new grease"
    assert "note: weight swings a little" in [note["text"] for note in book["notes"]]
    told = [event["text"] for path in folder.rglob("events.jsonl") for event in read_events(path.parent)]
    assert told.count("weight swings a little") == 1


def test_sweeps_are_offered_beside_the_plans_with_their_parameters() -> None:
    offered = {plan["name"]: plan for plan in plans()}
    assert {"quick", "identify", "load-sweep", "assembly-sweep"} <= set(offered)
    assert [p["name"] for p in offered["load-sweep"]["parameters"]] == [
        "weights",
        "amplitude_deg",
        "frequency",
        "cycles",
    ]
    assert offered["load-sweep"]["summary"].startswith("The slow triangle under each weight")


@pytest.mark.parametrize(
    "parameters",
    [[], "x", {"weights": None}, {"weights": "many"}, {"weights": [1e400]}, {"nonsense": 1}, {"cycles": -1}],
)
def test_a_sweep_with_parameters_that_make_no_sense_is_refused_in_a_sentence(parameters: Any) -> None:
    found = check({"plan": "load-sweep", "parameters": parameters}, "twin", [])
    assert not found["ok"]
    assert found["problems"]["*"].count(". ") == 0
