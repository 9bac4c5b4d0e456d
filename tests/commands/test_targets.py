"""A place that cannot be written is one sentence and exit code 2 in every verb, before anything moves."""

from __future__ import annotations

import argparse
import importlib
import json
from pathlib import Path

import pytest

from rig.bench import read
from rig.cli import main
from rig.commands import CATALOGUE
from rig.commands.targets import refuse_other_than_json, refuse_unwritable
from rig.core.errors import DataError, Exit, UsageError
from rig.doctor.disk import check_disk
from rig.doctor.finding import Health
from rig.runfile.writing import writing
from tests.commands.made_run import made_run


@pytest.fixture
def run(tmp_path: Path) -> str:
    return str(made_run(tmp_path / "good"))


VERBS = {
    "run": ["run", "kinematic-error", "--out"],
    "sweep": ["run", "load-sweep", "--out"],
    "campaign": ["campaign", "quick", "--out"],
    "demo": ["demo", "--out"],
    "close-loop": ["close-loop", "--out"],
    "import": ["import", "x.csv", "--map", "lara8", "--out"],
    "analyse": ["analyse", "RUN", "--out"],
    "export": ["export", "RUN", "--out"],
    "reproduce": ["reproduce", "RUN", "--out"],
    "trace": ["trace", "RUN", "--out"],
    "identify": ["identify", "RUN", "-o"],
    "tuning": ["tune", "--out"],
}


@pytest.mark.parametrize("verb", VERBS)
def test_a_place_that_cannot_be_written_is_refused_alike_by_every_verb(
    verb: str, run: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way")
    words = [run if word == "RUN" else word for word in VERBS[verb]]
    assert main([*words, str(tmp_path / "file" / "x")]) == Exit.USAGE
    said = capsys.readouterr()
    assert "cannot write" in said.err
    assert "Not a directory; name another place with -" in said.err
    assert "about to turn" not in said.err
    assert said.out == ""


@pytest.mark.parametrize(
    "words",
    [
        ["run", "kinematic-error", "--out"],
        ["serve", "--out"],
        ["analyse"],
        ["identify", "x", "-o"],
        ["compensate", "--gear"],
        ["compensate", "--campaign"],
    ],
)
def test_an_empty_path_is_refused_and_never_the_folder_one_is_in(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main([*words, ""])
    assert end.value.code == Exit.USAGE
    assert "an empty path, as of a shell variable that is not set; expected a name" in capsys.readouterr().err


def test_a_gear_file_for_a_folder_that_is_not_there_is_not_worked_for(
    run: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["identify", run, "-o", str(tmp_path / "nope" / "gear.toml")]) == Exit.USAGE
    said = capsys.readouterr()
    assert f"there is no folder {tmp_path / 'nope'}; name another place with -o" in said.err
    assert said.out == ""
    assert "identify:" not in said.err  # nothing was thought about


TAKEN = {
    "identify": ["identify", "RUN", "-o"],
    "view": ["view", "RUN", "-o"],
    "simulate": ["simulate", "twin", "--speed", "300", "-o"],
    "tune": ["tune", "--write"],
    "devices": ["devices", "--channel", "can0", "--out"],
}


@pytest.mark.parametrize("verb", TAKEN)
def test_what_is_there_already_is_left_as_it_is(
    verb: str, run: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    there = tmp_path / "only copy.svg"
    there.write_text("the only copy of something")
    assert main([*(run if word == "RUN" else word for word in TAKEN[verb]), str(there)]) == Exit.USAGE
    assert f"{there} exists already; nothing is overwritten: give the name of a new file" in capsys.readouterr().err
    assert there.read_text() == "the only copy of something"


def test_a_recording_for_the_viewer_never_takes_the_place_of_samples(
    run: str, capsys: pytest.CaptureFixture[str]
) -> None:
    samples = Path(run) / "samples.parquet"
    before = samples.read_bytes()
    assert main(["view", run, "-o", str(samples)]) == Exit.USAGE
    assert samples.read_bytes() == before
    assert "nothing is overwritten" in capsys.readouterr().err


def test_a_trace_for_programs_takes_the_place_of_an_earlier_one_only(
    run: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    samples = Path(run) / "samples.parquet"
    before = samples.read_bytes()
    assert main(["trace", str(Path(run).parent), "--json", str(samples), "--out", str(tmp_path / "o")]) == Exit.USAGE
    assert samples.read_bytes() == before
    assert f"--json {samples} exists already and is no JSON" in capsys.readouterr().err
    for text in ("", '{"schema": "hdrig.trace/1"}'):
        (tmp_path / "t.json").write_text(text)
        refuse_other_than_json(tmp_path / "t.json", "--json")


@pytest.mark.parametrize("verb", [["tune", "--write"], ["devices", "--channel", "can0", "--out"]])
def test_a_bench_file_that_could_not_be_written_is_not_worked_for(
    verb: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*verb, "/proc/gains.toml"]) == Exit.USAGE
    said = capsys.readouterr()
    assert "cannot write /proc" in said.err
    assert said.err.endswith(f"name another place with {verb[-1]}\n")
    assert said.out == ""


@pytest.mark.parametrize("verb", CATALOGUE)
def test_where_to_write_is_called_alike_by_every_verb(verb: str) -> None:
    parser = argparse.ArgumentParser()
    importlib.import_module(CATALOGUE[verb][0]).arguments(parser)
    options = next((a.option_strings for a in parser._actions if "--out" in a.option_strings), None)
    assert options is None or "-o" in options
    assert options is not None or not {"export", "devices"} & {verb}


@pytest.mark.parametrize(("verb", "former"), [("export", "--to"), ("devices", "--write")])
def test_former_names_still_mean_the_same(verb: str, former: str) -> None:
    parser = argparse.ArgumentParser()
    importlib.import_module(CATALOGUE[verb][0]).arguments(parser)
    words = ["x"] if verb == "export" else []
    assert parser.parse_args([*words, former, "there"]).out == Path("there")


def test_what_is_tried_leaves_nothing(tmp_path: Path) -> None:
    refuse_unwritable(tmp_path / "a" / "b")
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_told_by_its_own_words(tmp_path: Path) -> None:
    told = r"cannot write a: No space left on device; name another place with --to"
    with pytest.raises(UsageError, match=told), writing(Path("a"), "--to"):
        raise OSError(28, "No space left on device")


@pytest.mark.slow
def test_a_run_whose_report_finds_no_room_is_complete_and_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("rig.report.page.write", full)
    assert main(["run", "standstill", "--with", "duration=0.5", "--out", str(tmp_path)]) == Exit.INCOMPLETE
    assert "the run is complete in" in capsys.readouterr().err
    manifest = next(p for p in tmp_path.rglob("manifest.json") if "standstill" in p.parent.name)
    assert json.loads(manifest.read_text())["status"] == "completed"
    assert DataError.exit == Exit.INCOMPLETE


def test_a_folder_that_cannot_be_made_is_refused_before_anything_moves(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for beyond in (tmp_path / "l" / ("x" * 480), Path(tmp_path, *(["a" * 200] * 20))):
        assert main(["run", "jog", "--out", str(beyond)]) == Exit.USAGE
        said = capsys.readouterr().err
        assert "File name too long; name another place with --out" in said
        assert "about to turn" not in said
    assert list(tmp_path.iterdir()) == []


def test_a_target_by_way_of_a_folder_that_is_not_there_leaves_nothing(tmp_path: Path) -> None:
    refuse_unwritable(tmp_path / "a" / ".." / ".." / "b")
    refuse_unwritable(tmp_path / "a" / "b")
    assert list(tmp_path.iterdir()) == []
    assert not (tmp_path.parent / "b").exists()


@pytest.mark.parametrize("option", ["serial", "slcan", "odrive", "bus", "control"])
def test_a_door_of_the_twin_that_cannot_be_made_is_refused(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = ["--bus", str(tmp_path / "can"), "--control", str(tmp_path / "control")]
    assert main(["twin", *own, f"--{option}", "/proc/x/y", "--for", "0"]) == Exit.USAGE
    assert f"name another place with --{option}" in capsys.readouterr().err


def test_the_doctor_in_a_folder_that_is_gone_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    found = check_disk(read("twin"))
    assert [finding.health for finding in found] == [Health.BAD]
    assert "the working folder, where runs would go, is not there" in found[0].sentence


def test_a_path_that_is_no_text_is_refused_before_anything_connects(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The library that writes samples takes none: a run was made, and could not be closed."""
    odd = tmp_path / "bad\udcffname"
    assert main(["run", "kinematic-error", "--with", "cycles=0.5", "--out", str(odd)]) == Exit.USAGE
    assert f"--out {tmp_path}/bad\\udcffname: expected a path in UTF-8" in capsys.readouterr().err
    assert not odd.exists()
    run = made_run(tmp_path / "good").rename(odd)
    assert main(["analyse", str(run)]) == Exit.USAGE
    assert "expected a path in UTF-8" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words", [("trace", "x", "--json"), ("identify", "x", "-o"), ("trend", "--html"), ("export", "csv", "x", "--to")]
)
def test_standard_output_is_no_place_to_write_to(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    """A file called - was left behind."""
    with pytest.raises(SystemExit, match="2"):
        main([*words, "-"])
    assert words[-1] in (said := capsys.readouterr().err)
    assert "- is standard input or output to other programs, not here; expected a name" in said
