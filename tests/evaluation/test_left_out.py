"""One run that cannot be opened ends no identification: it is named, and the others say what they say."""

from __future__ import annotations

import shutil
from pathlib import Path

import pyarrow as pa
import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from rig.core.errors import DataError, UsageError
from rig.evaluation.to_identify import open_runs, opened
from rig.runfile.run import Run
from tests.commands.made_run import made_run, rows

pytestmark = pytest.mark.usefixtures("no_pictures")


def test_a_run_that_cannot_be_opened_is_left_out_in_words(tmp_path: Path) -> None:
    good, bad = made_run(tmp_path / "good"), made_run(tmp_path / "bad", {"gear": {"ratio": "fifty"}})
    said: list[str] = []
    assert [run.name for run in opened([bad, good], said.append)] == ["good"]
    assert said == ['bad is left out: manifest.json: gear.ratio is "fifty", expected a number above 0']


def test_none_that_can_be_opened_is_refused_as_the_first_one_is(tmp_path: Path) -> None:
    bad = made_run(tmp_path / "bad", {"gear": {"ratio": "fifty"}})
    with pytest.raises(UsageError, match=r"gear\.ratio is \"fifty\""):
        opened([bad], lambda text: None)


def test_a_run_that_nothing_is_identified_from_is_named(tmp_path: Path) -> None:
    folders = [
        made_run(tmp_path / "good"),
        made_run(tmp_path / "cut", {"status": "stopped"}),
        made_run(tmp_path / "jog", {"procedure": "other", "label": "jog"}),
        made_run(tmp_path / "still", table=rows().drop_columns(["theta_l"])),
    ]
    told: list[str] = []
    _, recordings, said = open_runs(folders, told.append)
    assert [r.name for r in recordings] == ["good"]
    assert said == tuple(told)
    assert told == [
        "cut is left out: its status is stopped, and a run that came to its end is asked for",
        "jog is left out: its procedure is no experiment (other)",
        "still is no part of the fit: it takes time and both angles, 200 rows of them",
    ]


def test_a_run_of_another_program_counts_whatever_its_kind(tmp_path: Path) -> None:
    opened = open_runs([made_run(tmp_path / "theirs", {"procedure": "other"})], lambda text: None)
    assert ([r.name for r in opened.recordings], opened.said) == (["theirs"], ())


def test_what_is_left_out_for_the_same_reason_is_one_sentence(tmp_path: Path) -> None:
    names = ("weigh", "lock-check", "sign-and-scale", "weigh-again")
    checks = [made_run(tmp_path / name, {"procedure": "other", "label": name}) for name in names]
    good = made_run(tmp_path / "good")
    for several, who in ((checks, "weigh, lock-check and 2 more"), (checks[:2], "weigh and lock-check")):
        assert open_runs([*several, good], lambda text: None).said == (
            f"{who} are left out: their procedure is no experiment (other)",
        )


def test_without_any_experiment_it_is_said_what_one_is(tmp_path: Path) -> None:
    with pytest.raises(
        DataError, match=r"a procedure such as constant_torque or .*\(jog: its procedure is no experiment"
    ):
        open_runs([made_run(tmp_path / "jog", {"procedure": "other", "label": "jog"})], lambda text: None)


def test_runs_of_two_loads_are_told_of(tmp_path: Path) -> None:
    folders = [made_run(tmp_path / name, {"declared": {"J_l": J}}) for name, J in (("bare", 0.8), ("laden", 1.2))]
    _, _, said = open_runs(folders, lambda text: None)
    assert [one for one in said if "declare J_l from 0.8 (bare) to 1.2 (laden)" in one]


def test_a_lock_test_whose_output_turns_is_left_out_in_words(tmp_path: Path) -> None:
    good = made_run(tmp_path / "good")
    turns = made_run(tmp_path / "turns", {"procedure": "stiffness_lock", "conditions": {"output_locked": True}})
    said: list[str] = []
    runs, recordings, _ = open_runs([good, turns], said.append)
    assert [run.name for run in runs] == [r.name for r in recordings] == ["good"]
    assert len(said) == 1
    assert said[0].startswith("turns is left out: it says its output is locked, and its load angle goes")


def test_a_torque_in_another_unit_than_that_of_the_other_runs_is_left_out_as_by_a_trace(tmp_path: Path) -> None:
    why = odd_one(tmp_path, "tau_l", 1e3)
    assert why.startswith("odd is left out: its τ_l is 1000 times that of its repeats, as if in another unit")


def test_a_time_in_another_unit_is_left_out_as_by_a_trace(tmp_path: Path) -> None:
    why = odd_one(tmp_path, "t", 1e3)
    assert why == "odd is left out: it has one row every 5 s, expected one every 1e-06 to 0.2 s"


def test_a_copy_of_a_run_and_a_link_to_it_are_no_runs_of_their_own(tmp_path: Path) -> None:
    folders = [made_run(tmp_path / name) for name in ("one", "two")]
    (tmp_path / "a-link").symlink_to("one")
    shutil.copytree(tmp_path / "two", tmp_path / "zwei")
    uid = [Run.open(folder).uid for folder in folders]
    runs, recordings, said = open_runs(sorted(tmp_path.iterdir()), lambda text: None)
    assert [run.name for run in runs] == [r.name for r in recordings] == ["one", "two"]
    assert said == (
        f"zwei is left out: it is the same run as two (uid {uid[1]})",
        f"a-link is left out: it is the same run as one (uid {uid[0]})",
    )
    campaign = read_campaign(tmp_path)
    assert [run.name for run in campaign.runs] == ["one", "two"]
    assert campaign.left_out == ("a-link", "zwei")
    assert f"a-link was left out: it is the same run as one (uid {uid[0]})." in campaign.notes


def odd_one(folder: Path, channel: str, factor: float) -> str:
    """Why, of three runs in `folder`, the one with a `channel` so many times as large is left out of both."""
    folders = [made_run(folder / name) for name in ("one", "two")]
    table = rows()
    place = table.column_names.index(channel)
    other = table.set_column(place, table.schema.field(place), pa.array(factor * table[channel].to_numpy()))
    folders.append(made_run(folder / "odd", table=other))
    told: list[str] = []
    runs, recordings, said = open_runs(folders, told.append)
    assert [run.name for run in runs] == [r.name for r in recordings] == ["one", "two"]
    assert said == tuple(told)
    assert read_campaign(folder).left_out == ("odd",)
    return told[0]
