"""Runs listed by date, gear, procedure, verdict; a damaged manifest is a line that says what is wrong with it."""

from __future__ import annotations

import errno
import json
import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from rig.catalogue import remembered, runs
from rig.catalogue.filter import asked
from rig.catalogue.scan import passing
from rig.cli import main
from rig.core import in_order
from rig.core.errors import UsageError
from rig.report import words
from tests.catalogue.folders import MANIFEST, run

ANYTHING: st.SearchStrategy[Any] = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.just("\ud800"),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"gear": {"serial": "SN1"}}, "gear.ratio is missing, expected a number above 0"),
        ({"gear": {"ratio": "50"}}, 'gear.ratio is "50", expected a number above 0'),
        ({"procedure": 7}, "procedure is 7, expected its name"),
    ],
)
def test_a_run_that_cannot_be_analysed_is_listed_with_what_its_manifest_lacks(
    change: dict[str, Any], said: str, tmp_path: Path
) -> None:
    run(tmp_path, "2026-11-18", **change)
    (row,) = runs(tmp_path)
    assert row.problem == f"manifest.json: {said}."


def test_filters_take_gear_procedure_verdict_status_and_days(tmp_path: Path) -> None:
    a = run(tmp_path, "2026-11-18", gear={"serial": "SN2"}, verdict="FAIL")
    b = run(tmp_path, "2026-11-19", 1, procedure="friction", status="stopped")
    c = run(tmp_path, "2026-11-20", 2)

    def found(**words: Any) -> list[Path]:
        return [row.path for row in runs(tmp_path, asked(**words))]

    assert found() == [a, b, c]
    assert found(gear="SN2") == [a]
    assert found(gear="SN*") == [a, b, c]
    assert found(verdict="fail") == [a]
    assert found(procedure="friction") == found(status="stopped") == [b]
    assert found(procedure="kinematic-error") == [a, c]
    assert found(since="2026-11-19") == [b, c]
    assert found(until="2026-11-19") == [a, b], "the day that is named is in"
    assert found(until="2026-11-19T06:00") == [a]
    assert found(sort="gear", reverse=True) == [a, c, b]


def test_a_run_folder_lists_itself_as_for_every_other_verb(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = run(tmp_path, "2026-11-18")
    assert [row.path for row in runs(folder)] == [folder]
    assert main(["list", str(folder)]) == 0
    assert str(folder) in capsys.readouterr().out


@pytest.mark.parametrize(
    ("written", "shown"), [('{"verdict": "INCONCLUSIVE"}', "INCONCLUSIVE"), ("{", ""), ("[]", "")], ids=str
)
def test_a_run_of_somebody_else_has_the_verdict_of_the_result_beside_it(
    tmp_path: Path, written: str, shown: str
) -> None:
    folder = run(tmp_path, "2026-11-18", verdict=None)
    about = json.loads((folder / "manifest.json").read_text())
    about.pop("files", None)
    (folder / "manifest.json").write_text(json.dumps(about))
    (folder / "result.json").unlink()
    assert [row.ruling for row in runs(tmp_path, asked(verdict="none"))] == [""]
    (folder / "result.json").write_text(written)
    assert main(["list", str(tmp_path), "--verdict", shown or "none"]) == 0
    assert [row.ruling for row in passing([tmp_path])] == [shown]


def test_several_folders_are_one_list_in_order(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    days = [run(tmp_path / name, day) for name, day in (("a", "2026-11-21"), ("b", "2026-11-20"))]
    assert main(["list", str(tmp_path / "a"), str(tmp_path / "b"), "--json"]) == 0
    assert [json.loads(line)["path"] for line in capsys.readouterr().out.splitlines()] == [str(d) for d in days[::-1]]
    assert main(["list", str(tmp_path / "a"), str(tmp_path / "c")]) == 2
    assert capsys.readouterr() == (
        "",
        f"hdrig: there is no folder {tmp_path / 'c'}; give the folder that holds the runs\n",
    )


def test_a_procedure_there_is_not_is_refused_with_what_there_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(tmp_path, "2026-11-18", procedure="spin_up")
    for known in ("spin-up", "spin_up", "friction", "load-sweep"):
        assert main(["list", str(tmp_path), "--procedure", known]) == 0
    assert capsys.readouterr().err == ""
    assert main(["list", str(tmp_path), "--procedure", "foo"]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("hdrig: there is no procedure 'foo'; expected one of ")
    assert ("spin-up" in said.err, "friction" in said.err, said.out) == (True, True, "")


@pytest.mark.parametrize("words", [{"verdict": "pas"}, {"status": "done"}, {"sort": "age"}, {"since": "yesterday"}])
def test_a_word_there_is_not_is_refused_with_what_there_is(tmp_path: Path, words: dict[str, str]) -> None:
    with pytest.raises(UsageError, match=r"expected|did you mean"):
        asked(**words)  # type: ignore[arg-type]


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=60) | ANYTHING.map(lambda x: json.dumps(x).encode()))
def test_no_manifest_ends_the_listing(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    root = tmp_path_factory.mktemp("runs")
    good = run(root, "2026-11-20")
    (root / "odd").mkdir()
    (root / "odd" / "manifest.json").write_bytes(data)
    rows = {row.path.name: row for row in runs(root)}
    assert set(rows) == {good.name, "odd"}
    assert rows["odd"].status == "unreadable"
    assert "odd/manifest.json" in rows["odd"].problem


def test_links_in_a_ring_are_passed_by(tmp_path: Path) -> None:
    run(tmp_path, "2026-11-20")
    (tmp_path / "ring").symlink_to("ring")
    (tmp_path / "to").symlink_to("fro")
    (tmp_path / "fro").symlink_to("to")
    assert len(runs(tmp_path)) == 1


def _shut(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody may look into `folder`: said by the system, whoever runs the test (root may look everywhere)."""
    real = os.stat

    def stat(path: Any, *args: Any, **more: Any) -> os.stat_result:
        if os.fspath(path).startswith(f"{folder}/"):
            raise PermissionError(errno.EACCES, "Permission denied", os.fspath(path))
        return real(path, *args, **more)

    monkeypatch.setattr(os, "stat", stat)


def test_a_run_nobody_may_read_is_told_of_on_stderr_and_the_others_are_listed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    kept, shut = run(tmp_path, "2026-11-20"), run(tmp_path, "2026-11-21")
    _shut(shut, monkeypatch)
    assert main(["list", str(tmp_path)]) == 0
    said = capsys.readouterr()
    assert str(kept) in said.out
    assert said.err == f"left out: {shut}/manifest.json cannot be read: Permission denied\n"


@pytest.mark.parametrize("verb", ["list", "analyse", "verify", "export", "identify", "recover"])
def test_a_folder_nobody_may_read_is_refused_in_a_sentence(
    verb: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    _shut(tmp_path, monkeypatch)
    assert main([verb, str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"hdrig: {tmp_path}/manifest.json cannot be used: Permission denied\n"


def test_a_manifest_that_never_ends_keeps_no_listing_waiting(tmp_path: Path) -> None:
    for name in ("pipe", "device", "huge"):
        (tmp_path / name).mkdir()
    os.mkfifo(tmp_path / "pipe/manifest.json")
    (tmp_path / "device/manifest.json").symlink_to("/dev/zero")
    with open(tmp_path / "huge/manifest.json", "wb") as sparse:
        sparse.truncate(2**30)
    rows = {row.path.name: row.problem for row in runs(tmp_path)}
    assert "it is a named pipe, expected a regular file" in rows["pipe"]
    assert "it is a device, expected a regular file" in rows["device"]
    assert "1073741824 bytes long" in rows["huge"]


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@example("conditions", {"depth_mm": [float("nan")]})
@given(st.sampled_from([*MANIFEST, "started_utc", "label", "campaign", "rows", "process", "exit_reason"]), ANYTHING)
def test_any_value_of_any_key_gives_a_row_that_can_be_written(
    tmp_path_factory: pytest.TempPathFactory, key: str, value: Any
) -> None:
    root = tmp_path_factory.mktemp("runs")
    run(root, "2026-11-20", **{key: value})
    for order in ("started", "gear", "duration"):
        (row,) = runs(root, asked(sort=order))
    json.dumps(row.as_json(), allow_nan=False).encode()
    asked(since="2026-11-01").passes(row)


def test_a_manifest_that_was_replaced_is_read_again_and_one_that_was_not_is_remembered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = run(tmp_path, "2026-11-20")
    monkeypatch.setattr(remembered, "FRESH", -1)  # as if it had been written long ago
    assert [row.verdict for row in runs(tmp_path)] == ["PASS"]
    opened: list[Path] = []
    from rig.runfile import manifest

    read = manifest.read
    monkeypatch.setattr(manifest, "read", lambda path: opened.append(path) or read(path))
    assert [row.verdict for row in runs(tmp_path)] == ["PASS"]
    assert not opened
    manifest.update(folder, verdict="FAIL")
    assert [row.verdict for row in runs(tmp_path)] == ["FAIL"]


def test_a_manifest_just_written_is_not_remembered_its_time_may_not_change_again(tmp_path: Path) -> None:
    folder = run(tmp_path, "2026-11-20")
    path = folder / "manifest.json"
    about = path.stat()
    assert [row.verdict for row in runs(tmp_path)] == ["PASS"]
    path.write_text(path.read_text().replace("PASS", "FAIL"))  # same inode, same size …
    os.utime(path, ns=(about.st_atime_ns, about.st_mtime_ns))  # … and its time set back
    assert [row.verdict for row in runs(tmp_path)] == ["FAIL"]


def test_a_run_whose_program_has_died_is_interrupted_each_time_it_is_asked(tmp_path: Path) -> None:
    run(tmp_path, "2026-11-20", status="running", process={"pid": 2**22 + 1, "started": 1, "host": "elsewhere"})
    (row,) = runs(tmp_path)
    assert (row.status, row.reason) == ("interrupted", "found dead; there is no journal to recover it from")
    (row.path / "journal-0001.arrows").touch()
    assert runs(tmp_path)[0].reason == "found dead; hdrig recover makes it readable"


def test_the_command_lists_damage_in_words_and_json_line_by_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(tmp_path, "2026-11-20", backend="sim")
    (tmp_path / "odd").mkdir()
    (tmp_path / "odd" / "manifest.json").write_text("{")
    assert main(["list", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "is not JSON" in said
    assert "SIMULATED" in said
    assert main(["list", str(tmp_path), "--json", "--status", "completed"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert json.loads(line)["gear"] == "SN1"


@pytest.mark.parametrize(
    ("backend", "origin"),
    [("sim", "SIMULATED"), ("can", "MEASURED"), ("serial", "MEASURED"), ("imported", "IMPORTED"), ("odd", "–")],
)
def test_measured_in_the_list_is_where_a_run_came_from_and_never_its_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], backend: str, origin: str
) -> None:
    run(tmp_path, "2026-11-20", backend=backend, verdict="MEASURED")
    assert main(["list", str(tmp_path)]) == 0
    head, line = capsys.readouterr().out.splitlines()
    assert line[head.index("verdict") :].split()[:2] == ["no-limit", origin]
    (row,) = runs(tmp_path, asked(verdict="no-limit"))
    assert [row] == runs(tmp_path, asked(verdict="MEASURED")), "the word of manifests finds them too"
    assert row.as_json()["verdict"] == "MEASURED"
    assert (row.origin or "ORIGIN UNKNOWN") == words.origin(backend).word, "list and page say the same"


def test_five_thousand_manifests_are_opened_once_each(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """How long that takes is measured by tests/studies/catalogue.py: 0.3 s of CPU."""
    from rig.runfile import manifest

    for k in range(50):
        run(tmp_path, "2026-11-20", k)
    opened: list[Path] = []
    read = manifest.read
    monkeypatch.setattr(manifest, "read", lambda path: opened.append(path) or read(path))
    assert len(runs(tmp_path)) == len(opened) == 50


def test_a_long_list_is_printed_in_order_each_manifest_opened_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from rig.runfile import manifest

    for k in range(30):
        run(tmp_path, f"2026-11-{k % 7 + 1:02d}", k, gear={"serial": f"SN{k % 3}"})
    monkeypatch.setattr(in_order, "PIECE", 8)  # several pieces, as of thousands
    opened: list[Path] = []
    read = manifest.read
    monkeypatch.setattr(manifest, "read", lambda path: opened.append(path) or read(path))
    for options in ([], ["--sort", "gear"], ["--sort", "gear", "--reverse"]):
        opened.clear()
        assert main(["list", str(tmp_path), "--json", *options]) == 0
        listed = [json.loads(line)["path"] for line in capsys.readouterr().out.splitlines()]
        assert len(opened) == 30
        words = {"sort": "gear" if options else "started", "reverse": "--reverse" in options}
        assert listed == [str(row.path) for row in runs(tmp_path, asked(**words))]


def test_no_word_of_a_manifest_steers_a_terminal_or_a_figure(tmp_path: Path) -> None:
    run(tmp_path, "2026-11-20", status="\x1b[31mred\u202e", operator="\x00")
    found = runs(tmp_path)[0]
    assert (found.status, found.operator) == ("\ufffd[31mred\ufffd", "\ufffd")
