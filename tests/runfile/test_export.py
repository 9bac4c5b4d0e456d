"""Runs for other programs, read back with the libraries those programs are made of."""

from __future__ import annotations

import builtins
import csv
import importlib
import json
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from rig.core.channels import CHANNEL
from rig.core.errors import UsageError
from rig.runfile.export import FORMATS, export
from rig.runfile.extra import how_to_install
from rig.runfile.finalise import finalise
from rig.runfile.run import Run
from tests.runfile.rows import expected, manifest_of, new_folder, write_journal
from tests.runfile.test_run import T, foreign

ROWS = 400
STARTED = "2026-11-20T01:47:00+00:00"


@pytest.fixture(params=["sim", "can"])
def run(request: pytest.FixtureRequest, tmp_path: Path) -> Run:
    """A closed run, simulated or measured."""
    folder = new_folder(tmp_path, backend=request.param, started_utc=STARTED, operator="N. N.")
    write_journal(folder, 0, ROWS, close=True)
    finalise(folder, "completed", "end")
    return Run.open(folder)


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a long run: many blocks."""
    monkeypatch.setattr("rig.runfile.samples.BATCH", 90)


@pytest.mark.usefixtures("small_blocks")
def test_csv_has_a_row_of_names_a_row_of_units_and_every_digit(run: Run) -> None:
    with open(export(run, "csv"), newline="", encoding="utf-8") as file:
        names, units, *rows = csv.reader(file)
    assert names[: len(CHANNEL)] == list(CHANNEL)
    assert units[: len(CHANNEL)] == [c.unit for c in CHANNEL.values()]
    assert len(rows) == ROWS
    for i, name in enumerate(CHANNEL):
        values = [float(row[i]) if row[i] else np.nan for row in rows]
        np.testing.assert_array_equal(values, expected(ROWS)[name], err_msg=name)


def test_a_simulated_csv_says_so_in_its_first_line(run: Run) -> None:
    first = export(run, "csv").read_text().splitlines()[0]
    assert first.endswith(",SIMULATED") is run.simulated


@pytest.mark.usefixtures("small_blocks")
def test_mdf4_has_every_channel_with_unit_and_meaning_and_marks_what_was_not_measured(run: Run) -> None:
    from asammdf import MDF

    with MDF(export(run, "mdf4")) as mdf:
        for name, values in expected(ROWS).items():
            if name == "t":
                continue
            signal = mdf.get(name)  # without its invalid samples
            there = ~np.isnan(values)
            np.testing.assert_array_equal(signal.samples, values[there], err_msg=name)
            np.testing.assert_array_equal(signal.timestamps, expected(ROWS)["t"][there])
            assert (signal.unit, signal.comment) == (CHANNEL[name].unit, CHANNEL[name].meaning)
        assert mdf.groups[0].channels[mdf.masters_db[0]].name == "t"  # as in every other export
        assert mdf.header.description.startswith("SIMULATED") is run.simulated
        assert (mdf.header.author, mdf.header.subject) == ("N. N.", "SN0042")
        assert mdf.header.start_time.isoformat() == STARTED


@pytest.mark.usefixtures("small_blocks")
def test_mcap_has_one_json_message_a_sample_at_its_time(run: Run) -> None:
    from mcap.reader import make_reader

    with open(export(run, "mcap"), "rb") as file:
        reader = make_reader(file)
        messages = list(reader.iter_messages(topics=["/rig/sample"]))
        (about,) = [m for m in reader.iter_metadata() if m.name == "hdrig"]
    schema, channel, _ = messages[0]
    assert schema is not None
    assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
    described = json.loads(schema.data)
    assert described["properties"]["tau_l"]["unit"] == "N·m"
    assert described["title"].startswith("SIMULATED") is run.simulated
    assert about.metadata["simulated"] == channel.metadata["simulated"] == ("true" if run.simulated else "false")
    assert json.loads(about.metadata["manifest"])["uid"] == run.manifest["uid"]
    rows = [json.loads(message.data) for _, _, message in messages]
    for name, values in expected(ROWS).items():
        np.testing.assert_array_equal([row.get(name, np.nan) for row in rows], values, err_msg=name)
    assert [m.log_time for _, _, m in messages[:2]] == [1795139220_000000000, 1795139220_001000000]


@pytest.mark.usefixtures("small_blocks")
def test_hdf5_has_one_dataset_a_channel_with_its_unit(run: Run) -> None:
    with h5py.File(export(run, "hdf5")) as file:
        assert bool(file.attrs["simulated"]) is run.simulated
        assert json.loads(file["manifest"][()])["uid"] == run.manifest["uid"]
        for name, values in expected(ROWS).items():
            got = file[name]
            assert got.attrs["unit"] == CHANNEL[name].unit
            numbers = got[()].astype(np.float64)
            if "_FillValue" in got.attrs:
                numbers[got[()] == got.attrs["_FillValue"]] = np.nan
            np.testing.assert_array_equal(numbers, values, err_msg=name)


@pytest.mark.parametrize("kind", FORMATS)
def test_nothing_is_ever_overwritten(run: Run, kind: str) -> None:
    path = export(run, kind)
    assert path == run.path / f"{run.name}{FORMATS[kind].suffix}"
    before = path.read_bytes()
    with pytest.raises(UsageError, match="exists already; nothing is overwritten"):
        export(run, kind)
    assert path.read_bytes() == before
    assert not list(run.path.glob(".*"))


@pytest.mark.slow
@pytest.mark.parametrize("kind", FORMATS)
def test_it_goes_where_it_is_told(run: Run, kind: str, tmp_path: Path) -> None:
    assert export(run, kind, tmp_path / f"x{FORMATS[kind].suffix}").stat().st_size > 1000
    (tmp_path / "out").mkdir()
    assert export(run, kind, tmp_path / "out").parent == tmp_path / "out"


@pytest.mark.parametrize("kind", FORMATS)
def test_a_place_that_cannot_be_written_is_a_sentence_and_leaves_nothing(run: Run, kind: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(UsageError, match=r"cannot write .*file/x: Not a directory; name another place with --out"):
        export(run, kind, tmp_path / "file" / "x")
    with pytest.raises(UsageError, match=r"cannot write .*: No such file or directory"):
        export(run, kind, tmp_path / "gone" / f"x{FORMATS[kind].suffix}")


@pytest.mark.parametrize("kind", FORMATS)
def test_a_name_without_a_suffix_is_a_folder_and_a_wrong_suffix_is_refused(run: Run, kind: str, tmp_path: Path) -> None:
    assert (
        export(run, kind, tmp_path / "new" / "place")
        == tmp_path / "new" / "place" / f"{run.name}{FORMATS[kind].suffix}"
    )
    with pytest.raises(UsageError, match=r"x\.xls ends in \.xls, this format in"):
        export(run, kind, tmp_path / "x.xls")


@pytest.mark.parametrize("kind", FORMATS)
def test_a_writer_that_fails_leaves_nothing_behind(
    run: Run, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(run: Run, path: Path) -> None:
        path.write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(importlib.import_module(FORMATS[kind].module), "write", full)
    with pytest.raises(UsageError, match=r"cannot write .*: No space left on device"):
        export(run, kind, tmp_path / f"x{FORMATS[kind].suffix}")
    assert not [p for p in tmp_path.iterdir() if p.is_file()]


@pytest.mark.parametrize(("kind", "package"), [("mdf4", "asammdf"), ("mcap", "mcap"), ("hdf5", "h5py")])
def test_a_missing_package_is_a_sentence_that_says_how_to_get_it(
    run: Run, kind: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.split(".")[0] == package:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return real(name, *rest, **more)

    monkeypatch.delitem(sys.modules, FORMATS[kind].module, raising=False)
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(UsageError, match=rf"{kind} needs the package {package}.*install -e '\.\[exchange\]'"):
        export(run, kind)


def test_a_format_that_does_not_exist_is_refused_with_those_that_do(run: Run) -> None:
    with pytest.raises(UsageError, match="there is no format 'xlsx', expected one of csv, mdf4, mcap, hdf5"):
        export(run, "xlsx")


@pytest.mark.parametrize("kind", ["mdf4", "mcap"])
def test_a_run_without_time_is_refused_where_time_is_needed(tmp_path: Path, kind: str) -> None:
    run = Run.open(foreign(tmp_path / "x", theta_m=T))
    with pytest.raises(UsageError, match=r"x has no t: .*; csv and hdf5 do not"):
        export(run, kind)
    assert sorted(p.name for p in run.path.iterdir()) == ["manifest.json", "samples.parquet"]


@pytest.mark.parametrize("kind", FORMATS)
def test_a_run_of_somebody_else_is_exported_too(tmp_path: Path, kind: str) -> None:
    run = Run.open(foreign(tmp_path / "x"))
    assert export(run, kind).stat().st_size > 0
    assert "started_utc" not in manifest_of(run.path)


@pytest.mark.parametrize("kind", ["csv", "hdf5"])
def test_a_run_without_a_row_is_exported_without_a_row(tmp_path: Path, kind: str) -> None:
    folder = new_folder(tmp_path)
    finalise(folder, "stopped", "before the first tick")
    assert export(Run.open(folder), kind).exists()


def test_what_is_missing_is_fetched_for_the_clone_and_never_by_a_name_of_ours(tmp_path: Path) -> None:
    """`hdrig` is on no registry: a stranger's package may have the name one day."""
    assert "hdrig[" not in how_to_install()
    assert how_to_install(tmp_path).startswith("install hdrig again from where it came from")
    (tmp_path / "pyproject.toml").touch()
    assert how_to_install(tmp_path).startswith(f"in {tmp_path}: ")
    assert how_to_install(tmp_path).endswith(" install -e '.[exchange]'")
