"""What verify holds against a run, and the list of runs."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.catalogue import runs as list_runs
from rig.cli import main
from rig.core.channels import Flag
from rig.core.errors import HdrigError, UsageError
from rig.runfile import manifest
from rig.runfile.events import read_events
from rig.runfile.export import export
from rig.runfile.finalise import describe, finalise
from rig.runfile.process import this_process
from rig.runfile.recover import recover
from rig.runfile.run import Run
from rig.runfile.verify import verify
from tests.runfile.rows import new_folder, write_journal


def closed(root: Path, rows: int = 300, **about: Any) -> Path:
    """A run as it should be."""
    folder = new_folder(root, **about)
    write_journal(folder, 0, rows, close=True)
    finalise(folder, "completed", "end", timing={"missed": 0})
    return folder


def found(folder: Path, level: str = "error") -> list[tuple[str, str]]:
    """Findings of one level, as (check, sentence)."""
    return [(f.check, f.sentence) for f in verify(folder) if f.level == level]


def tampered(folder: Path, name: str, change: Callable[[bytes], bytes]) -> None:
    """Change a file behind hdrig's back."""
    data = change((folder / name).read_bytes())
    (folder / name).unlink()
    (folder / name).write_bytes(data)
    (folder / name).chmod(0o444)


def with_column(folder: Path, name: str, change: Callable[[np.ndarray[Any, Any]], None], journal: bool = False) -> None:
    """Rewrite one column of the archive, hash and all; the journal goes, unless it is wanted."""
    path = folder / "samples.parquet"
    table = pq.read_table(path)
    at = table.schema.get_field_index(name)
    values = table.column(name).to_numpy().copy()
    change(values)
    table = table.set_column(at, table.schema.field(at), pa.array(values, from_pandas=True))
    path.unlink()
    pq.write_table(table, path)
    path.chmod(0o444)
    files = manifest.read(folder)["files"]
    files["samples.parquet"] |= describe(path)
    if not journal:
        (folder / "journal-0001.arrows").unlink()
        del files["journal-0001.arrows"]
    manifest.update(folder, files=files)


def test_a_run_as_it_should_be_has_nothing_held_against_it(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    assert found(folder) == []
    assert found(folder, "warning") == []
    assert found(folder, "note") == [("flags", "43 of 300 rows are flagged STALE_TAU")]


@pytest.mark.parametrize("name", ["samples.parquet", "journal-0001.arrows", "bench.toml", "timing.json"])
def test_one_changed_byte_of_any_file_is_found(tmp_path: Path, name: str) -> None:
    folder = closed(tmp_path)
    tampered(folder, name, lambda data: data[:2] + bytes([data[2] ^ 1]) + data[3:])
    assert ("hashes", f"{name} is not what it was: its SHA-256 differs from the manifest's") in found(folder)


def test_a_ratio_no_gear_has_is_found(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    manifest.update(folder, gear={"ratio": 1e300})
    assert found(folder) == [("manifest", "manifest.json: gear.ratio is 1e+300, expected 0.001 to 100000")]


def test_a_missing_file_is_found(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    (folder / "timing.json").unlink()
    assert found(folder) == [("hashes", "timing.json is in the manifest and not in the folder")]


def test_a_raw_file_that_can_be_written_to_is_pointed_out(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    (folder / "samples.parquet").chmod(0o644)
    assert [check for check, _ in found(folder, "warning")] == ["read-only"]
    assert found(folder) == []


def test_rows_that_are_not_as_many_as_said_are_found(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    files = manifest.read(folder)["files"]
    files["samples.parquet"]["rows"] = 301
    manifest.update(folder, files=files)
    assert found(folder) == [("rows", "300 rows, the manifest says 301")]


def test_time_that_runs_backwards_is_found(tmp_path: Path) -> None:
    folder = closed(tmp_path)

    def back(t: np.ndarray[Any, Any]) -> None:
        t[100] = 0.05

    with_column(folder, "t", back)
    ((check, sentence),) = found(folder)
    assert check == "samples"
    assert "time runs backwards after row 99" in sentence


def late(t: np.ndarray[Any, Any]) -> None:
    """Three cycles that are not there, after row 149."""
    t[150:] += 3e-3


def test_a_gap_nobody_told_of_is_an_error(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    with_column(folder, "t", late)
    assert found(folder) == [
        ("gaps", "1 gap longer than 1.5 periods of 1 ms, unexplained; the longest is 4 ms at t = 0.149 s")
    ]


def test_a_gap_of_a_run_whose_loop_died_is_a_warning(tmp_path: Path) -> None:
    """Its ticks were never counted: a row that is gone and a late tick look alike."""
    folder = closed(tmp_path)
    with_column(folder, "t", late)
    manifest.update(folder, status="interrupted")
    assert found(folder) == []
    ((check, sentence),) = found(folder, "warning")
    assert check == "gaps"
    assert "a late tick or a lost row: the loop died before it could say how many" in sentence


@pytest.mark.parametrize(("row", "flag"), [(150, Flag.MISSED), (149, Flag.STALE_M)])
def test_a_gap_the_loop_flagged_is_a_warning(tmp_path: Path, row: int, flag: Flag) -> None:
    folder = closed(tmp_path)

    def set_flag(flags: np.ndarray[Any, Any]) -> None:
        flags[row] |= int(flag)

    with_column(folder, "t", late, journal=True)
    with_column(folder, "flags", set_flag)
    assert found(folder) == []
    ((check, sentence),) = found(folder, "warning")
    assert check == "gaps"
    assert "flagged by the loop" in sentence
    assert ("flags", f"1 of 300 rows are flagged {flag.name}") in found(folder, "note")


@pytest.mark.parametrize("row", [150, 298, 299])
def test_a_late_tick_that_was_made_up_for_is_no_lost_row(tmp_path: Path, row: int) -> None:
    folder = closed(tmp_path)

    def late_once(t: np.ndarray[Any, Any]) -> None:
        t[row] += 0.7e-3

    with_column(folder, "t", late_once)
    assert found(folder) == []
    ((_, sentence),) = found(folder, "warning")
    assert "1 gap longer than 1.5 periods of 1 ms, a tick came late, no row is gone; the longest is 1.7 ms" in sentence


def stale_before_the_gap(age: np.ndarray[Any, Any]) -> None:
    """Row 149 was made 3 ms after what it holds was latched, the next one at once."""
    age[149] += 3e-3


def test_a_gap_between_a_stale_reading_and_a_fresh_one_is_a_warning(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    with_column(folder, "t", late, journal=True)
    with_column(folder, "age", stale_before_the_gap)
    assert found(folder) == []
    ((_, sentence),) = found(folder, "warning")
    assert "a stale reading and then a fresh one (their `age`), no row is gone; the longest is 4 ms" in sentence


def test_a_stale_reading_explains_no_gap_longer_than_its_age(tmp_path: Path) -> None:
    folder = closed(tmp_path)

    def later(t: np.ndarray[Any, Any]) -> None:
        t[150:] += 4e-3

    with_column(folder, "t", later, journal=True)
    with_column(folder, "age", stale_before_the_gap)
    ((check, sentence),) = found(folder)
    assert (check, "unexplained" in sentence) == ("gaps", True)


@pytest.mark.parametrize("row", [1, 150, 298])
def test_a_row_cut_out_is_found(tmp_path: Path, row: int) -> None:
    folder = closed(tmp_path)

    def cut(t: np.ndarray[Any, Any]) -> None:
        t[row:] += 1e-3

    with_column(folder, "t", cut)
    assert [check for check, _ in found(folder)] == ["gaps"]


def test_an_archive_that_differs_from_its_journal_is_found(tmp_path: Path) -> None:
    folder = closed(tmp_path)

    def spoil(theta: np.ndarray[Any, Any]) -> None:
        theta[7] += 1e-9

    with_column(folder, "theta_m", spoil, journal=True)
    assert found(folder) == [("journal", "journal and samples.parquet differ from row 0 on")]


def test_simulated_rows_never_pass_for_measured_ones(tmp_path: Path) -> None:
    folder = closed(tmp_path, backend="can")
    assert found(folder) == [("backend", "300 of 300 rows are simulated, the backend is 'can'")]


def test_a_measured_row_in_a_simulated_run_is_found(tmp_path: Path) -> None:
    folder = closed(tmp_path)

    def measured(flags: np.ndarray[Any, Any]) -> None:
        flags[5] = 0

    with_column(folder, "flags", measured)
    assert found(folder) == [("backend", "299 of 300 rows are simulated, the backend is 'sim'")]


def test_a_run_never_closed_is_found_and_the_way_out_is_named(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    write_journal(folder, 0, 100)
    assert found(folder) == [("status", "the run was never closed; hdrig recover makes it readable")]
    for journal in folder.glob("journal-*"):
        journal.unlink()
    assert ("status", "the run was never closed; there is no journal to recover it from") in found(folder)
    manifest.update(folder, process=this_process())
    assert found(folder, "warning") == [("status", f"process {os.getpid()} is still making this run")]


def test_a_folder_of_somebody_else_is_checked_as_far_as_it_goes(tmp_path: Path) -> None:
    about = {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": 50}}
    (tmp_path / "manifest.json").write_text(json.dumps(about))
    pq.write_table(pa.table({"theta_m": np.arange(9.0)}), tmp_path / "samples.parquet")
    said = [(f.level, f.check) for f in verify(tmp_path)]
    assert said == [("note", "hashes"), ("warning", "rows"), ("note", "time")]


def test_no_run_folder_at_all_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="is not a run folder"):
        verify(tmp_path)


def test_the_list_shows_every_run_oldest_first_from_its_manifest_alone(tmp_path: Path) -> None:
    later = closed(tmp_path, started_utc="2026-11-21T09:00:00+00:00")
    first = closed(tmp_path, started_utc="2026-11-20T01:47:00+00:00")
    manifest.update(first, verdict="PASS")
    for folder in (later, first):
        (folder / "samples.parquet").unlink()
    row, other = list_runs(tmp_path)
    assert (row.path, other.path) == (first, later)
    assert (row.procedure, row.gear, row.status) == ("kinematic_error", "SN0042", "completed")
    assert (row.duration, row.rows, row.simulated, row.verdict) == (0.299, 300, True, "PASS")


def test_a_run_found_dead_is_listed_as_interrupted_and_a_living_one_as_running(tmp_path: Path) -> None:
    new_folder(tmp_path / "dead")
    new_folder(tmp_path / "alive", process=this_process())
    assert [row.status for row in list_runs(tmp_path / "dead")] == ["interrupted"]
    assert [row.status for row in list_runs(tmp_path / "alive")] == ["running"]


def test_a_damaged_manifest_spoils_no_list(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    (folder.parent / "x").mkdir()
    (folder.parent / "x" / "manifest.json").write_text("{")
    (folder.parent / "no run").mkdir()
    assert [row.status for row in list_runs(tmp_path)] == ["unreadable", "completed"]


def test_runs_side_by_side_are_a_root_too(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    assert [row.path for row in list_runs(folder.parent)] == [folder]
    with pytest.raises(UsageError, match="there is no folder"):
        list_runs(tmp_path / "gone")


ODD: list[bytes] = [
    b'{"schema": "hdrig.run/1", "gear": "SN1", "duration": "long", "rows": "all", "verdict": {}, "label": []}',
    b'{"schema": "hdrig.run/1", "gear": null, "duration": 1e999, "process": "me", "status": "running"}',
    b'{"schema": "hdrig.run/1", "process": {"pid": "1", "started": []}, "status": "running", "started_utc": null}',
    b'{"schema": "hdrig.run/1", "duration": 1' + b"0" * 400 + b"}",
    b'{"schema": "hdrig.run/1", "procedure": "\\ud800", "gear": {"serial": "a\\nb"}}',
    b'{"schema": "hdrig.run/1", "gear": ' + b"[" * 10_000 + b"]" * 10_000 + b"}",
    b'{"schema": "hdrig.run/1", "gear": {"ratio": 1' + b"0" * 400 + b'}, "procedure": "other"}',
    b'{"schema": "hdrig.run/1", "gear": {"ratio": 50}, "procedure": "other", "files": "none"}',
    b'{"schema": "hdrig.run/1", "gear": {"ratio": 50}, "procedure": "other", "files": {"samples.parquet": null}}',
    b'{"schema": "hdrig.run/1", "gear": {"ratio": 50}, "procedure": ["other"], "files": {"bench.toml": {}}}',
    b"[]",
    b"7",
]


@pytest.mark.parametrize("about", ODD)
def test_an_odd_manifest_spoils_no_list(tmp_path: Path, about: bytes, capsys: pytest.CaptureFixture[str]) -> None:
    closed(tmp_path)
    (tmp_path / "odd").mkdir()
    (tmp_path / "odd" / "manifest.json").write_bytes(about)
    assert {row.path.name for row in list_runs(tmp_path)} > {"odd"}
    assert main(["list", str(tmp_path)]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 3


@pytest.mark.parametrize("about", ODD)
def test_an_odd_manifest_is_a_sentence(tmp_path: Path, about: bytes) -> None:
    (tmp_path / "manifest.json").write_bytes(about)
    pq.write_table(pa.table({"theta_m": np.arange(9.0)}), tmp_path / "samples.parquet")
    for act in (verify, Run.open, recover):
        try:
            act(tmp_path)
        except HdrigError as error:
            assert str(tmp_path) in str(error)


@pytest.mark.parametrize("timing", [b"[]", b"7", b'[["a"]]', b"[" * 10_000, b'{"ticks": "many"}'])
def test_odd_statistics_of_the_loop_are_as_good_as_none(tmp_path: Path, timing: bytes) -> None:
    folder = closed(tmp_path)
    tampered(folder, "timing.json", lambda data: timing)
    assert [check for check, _ in found(folder)] == ["hashes"]
    assert Run.open(folder).timing in ({}, {"ticks": "many"})


def test_lines_that_are_no_events_are_left_out(tmp_path: Path) -> None:
    lines = [b"7", b"[]", b"null", b"[" * 10_000, b'{"kind": "note"}']
    (tmp_path / "events.jsonl").write_bytes(b"\n".join(lines))
    assert read_events(tmp_path) == [{"kind": "note"}]


def test_a_column_that_is_there_twice_is_a_finding(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_bytes(b'{"schema": "hdrig.run/1", "gear": {"ratio": 50}, "procedure": "other"}')
    twice = pa.table([pa.array([1.0]), pa.array([2.0])], names=["theta_m", "theta_m"])
    pq.write_table(twice, tmp_path / "samples.parquet")
    ((check, sentence),) = found(tmp_path)
    assert check == "samples"
    assert "has 2 columns named theta_m, expected one" in sentence


@pytest.mark.parametrize("kind", ["mcap", "mdf4"])
def test_a_start_that_is_no_time_is_a_finding_and_counts_as_not_said(tmp_path: Path, kind: str) -> None:
    folder = closed(tmp_path)
    manifest.update(folder, started_utc="yesterday")
    assert ("manifest", 'manifest.json: started_utc is "yesterday", expected ISO 8601') in found(folder)
    assert Run.open(folder).started is None
    assert export(Run.open(folder), kind).exists()


def test_time_in_another_unit_is_found(tmp_path: Path) -> None:
    folder = closed(tmp_path, loop={"rate": 1000.0})
    assert not found(folder)

    def in_ms(t: np.ndarray[Any, Any]) -> None:
        t *= 1e3

    with_column(folder, "t", in_ms)
    said = "t is not in s: its rows are 1 s apart, the manifest says 1000 Hz (0.001 s): it looks like ms, expected s"
    assert ("time", said) in found(folder)


def test_values_that_are_no_numbers_are_pointed_out(tmp_path: Path) -> None:
    folder = foreign(
        tmp_path, t=np.arange(100) / 1e3, theta_m=np.arange(100.0), tau_l=np.ones(100), at={"tau_l": np.inf}
    )
    said = found(folder, "warning")
    assert [check for check, _ in said] == ["values"]
    assert said[0][1].startswith("tau_l: of 100 values 1 infinite")


def test_null_is_no_finding_and_not_a_number_is(tmp_path: Path) -> None:
    null = foreign(tmp_path / "null", t=np.arange(100) / 1e3, theta_m=np.arange(100.0), at={"theta_m": None})
    assert found(null, "warning") == []
    nan = foreign(tmp_path / "nan", t=np.arange(100) / 1e3, theta_m=np.arange(100.0), at={"theta_m": np.nan})
    assert "theta_m: of 100 values 1 NaN" in found(nan, "warning")[0][1]


def test_time_that_stands_still_and_time_that_is_absent_are_told(tmp_path: Path) -> None:
    stands = foreign(tmp_path / "stands", t=np.arange(100) // 2 / 1e3, theta_m=np.arange(100.0))
    assert ("time", "50 of 100 rows have the t of the row before them") in found(stands, "warning")
    assert [check for check, _ in found(foreign(tmp_path / "none", theta_m=np.arange(100.0)), "note")] == [
        "hashes",
        "time",
    ]


def test_a_run_of_no_rows_is_no_sound_one_without_a_word(tmp_path: Path) -> None:
    folder = foreign(tmp_path, t=np.empty(0), theta_m=np.empty(0))
    assert [check for check, _ in found(folder, "warning")] == ["rows"]


def foreign(folder: Path, at: dict[str, float | None] | None = None, **columns: np.ndarray[Any, Any]) -> Path:
    """A folder of another logger; value 7 of the columns in `at` is as said there."""
    folder.mkdir(exist_ok=True)
    about = {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": 50}}
    (folder / "manifest.json").write_text(json.dumps(about))
    lists: dict[str, list[float | None]] = {name: list(values) for name, values in columns.items()}
    for name, value in (at or {}).items():
        lists[name][7] = value
    table = pa.table({name: pa.array(values, pa.float64()) for name, values in lists.items()})
    pq.write_table(table, folder / "samples.parquet")
    return folder
