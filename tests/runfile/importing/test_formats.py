"""The same little run, written in every format, imports to the same columns."""

from __future__ import annotations

import hashlib
import json
import re
import stat
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from rig.runfile.importing import READERS
from rig.runfile.run import Run

from .conftest import Foreign
from .formats import MAPPING, WRITERS, columns, mapping_for, truth, write_csv


def column(run: Run, name: str) -> np.ndarray:
    return run.need(name)


def test_every_suffix_of_the_catalogue_is_written_in_some_test() -> None:
    written = {Path(name).suffix for name in WRITERS}
    same_reader = {suffix: where for suffix, (_, where) in READERS.items()}
    assert {same_reader[suffix] for suffix in written} == set(same_reader.values())


@pytest.mark.parametrize("name", WRITERS)
def test_the_same_run_comes_out_of_every_format(foreign: Foreign, name: str) -> None:
    run = foreign.imported(foreign.file(name=name), mapping_for(name))
    wanted = truth()
    assert set(run.channels) == set(wanted)
    assert np.array_equal(column(run, "counts_m"), wanted["counts_m"])
    for channel in wanted:
        assert np.allclose(column(run, channel), wanted[channel], rtol=0, atol=1e-12), channel
    assert [run.unit(c) for c in ("t", "theta_m", "theta_l", "tau_l", "temperature")] == [
        "s",
        "rad",
        "rad",
        "N·m",
        "°C",
    ]
    assert run.meaning("temperature") == "housing"


@pytest.mark.parametrize("name", [n for n in WRITERS if n not in ("run.csv", "run.mat", "run-v7.3.mat")])
def test_the_unit_may_be_left_to_a_file_that_states_it(foreign: Foreign, name: str) -> None:
    lean = re.sub('unit = "(mN·m|deg|counts|m?s)"\n', "", MAPPING)
    run = foreign.imported(foreign.file(name=name), lean)
    assert np.allclose(column(run, "theta_l"), truth()["theta_l"], rtol=0, atol=1e-12)
    assert np.allclose(column(run, "tau_l"), truth()["tau_l"], rtol=0, atol=1e-12)


def test_the_run_folder_keeps_the_promises_of_the_format(foreign: Foreign) -> None:
    source = foreign.file()
    run = foreign.imported(source)
    about = run.manifest
    assert (about["schema"], about["backend"], about["status"]) == ("hdrig.run/1", "imported", "completed")
    assert about["import"]["source"] == "run.csv"
    assert about["import"]["sha256"] == hashlib.sha256(source.read_bytes()).hexdigest()
    assert (run.path / "import.toml").read_text(encoding="utf-8") == MAPPING
    assert about["gear"] == {"ratio": 50.0, "serial": "SN7"}
    assert about["encoders"] == {"motor_counts_per_rev": 4096}
    assert about["files"]["samples.parquet"]["rows"] == 400 == about["rows"]
    for name, said in about["files"].items():
        path = run.path / name
        assert hashlib.sha256(path.read_bytes()).hexdigest() == said["sha256"]
        assert not path.stat().st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH)
    assert "process" not in about
    assert "started_utc" not in about, "a stamp since switching on says nothing of the date"


def test_the_manifest_notes_the_measured_ratio_the_jitter_and_the_stiffness(foreign: Foreign) -> None:
    notes = " | ".join(foreign.imported(foreign.file()).manifest["notes"])
    assert "sample period 2 ms median, 1.804 ms least, 2.18 ms most" in notes
    assert "theta_m turns 49.9965 times as far as theta_l (over 144 deg of load); gear.ratio = 50" in notes
    assert "stiffness of 2e+04 N·m/rad" in notes
    assert "gap" not in notes
    assert "t was moved to start at 0: the file's first stamp is 5 s" in notes


def test_a_gap_is_imported_and_noted_with_its_length(foreign: Foreign) -> None:
    data = {name: np.delete(values, slice(100, 150)) for name, values in columns().items()}
    run = foreign.imported(foreign.file(data))
    assert run.rows == 350
    told = [note for note in run.manifest["notes"] if "gap" in note]
    assert told == ["1 gap in time longer than 3 periods, the largest 0.102 s, before row 101"]


def test_a_file_without_time_gives_a_run_without_t(foreign: Foreign) -> None:
    mapping = MAPPING.replace('[channels.t]\ncolumn = "time"\nunit = "ms"\n', "")
    run = foreign.imported(foreign.file(), mapping)
    assert "t" not in run.channels
    assert np.allclose(column(run, "theta_m"), truth()["theta_m"])


@pytest.mark.parametrize(("unit", "per_second"), [("s", 1), ("ms", 1_000), ("us", 1_000_000), ("ns", 1_000_000_000)])
def test_epoch_time_starts_at_zero_and_leaves_its_date_in_the_manifest(
    foreign: Foreign, unit: str, per_second: int
) -> None:
    data = columns()
    start = 1_793_000_000 * per_second
    ticks = truth()["t"] * per_second
    data["time"] = start + (ticks if unit == "s" else np.round(ticks).astype(np.int64))
    run = foreign.imported(
        foreign.file(data, "run.parquet"),
        MAPPING.replace('unit = "ms"', f'unit = "{unit}"').replace(
            "[channels.t]", '[accept]\nfile_unit = "the logger writes ms whatever it means"\n[channels.t]'
        ),
    )
    assert datetime.fromisoformat(run.manifest["started_utc"]).timestamp() == pytest.approx(1_793_000_000, abs=1e-3)
    assert run.manifest["clock"]["utc_at_start"] == run.manifest["started_utc"]
    t = column(run, "t")
    assert t[0] == 0.0
    assert np.allclose(t, truth()["t"], rtol=0, atol=max(0.51 / per_second if per_second > 1 else 0, 3e-7))
    assert run.path.parent.name == "2026-10-26"


def test_dates_in_the_file_are_a_time_column(foreign: Foreign) -> None:
    data = columns()
    data["time"] = np.datetime64("2026-11-20T10:00:00", "ns") + np.round(truth()["t"] * 1e9).astype("timedelta64[ns]")
    run = foreign.imported(foreign.file(data, "run.parquet"), MAPPING.replace('unit = "ms"', 'unit = "datetime"'))
    assert run.manifest["started_utc"] == "2026-11-20T10:00:00.000000+00:00"
    assert np.allclose(column(run, "t"), truth()["t"], rtol=0, atol=1e-9)


def test_a_csv_of_another_country(foreign: Foreign) -> None:
    path = foreign.folder / "run.csv"
    write_csv(path, columns(), delimiter=";", decimal=",", encoding="cp1252")
    text = path.read_text(encoding="cp1252").replace("temperature", "Temperatur_°C", 1)
    head, _, rest = text.partition("\n")
    path.write_text(f"Prüfstand 3\n\n{head}\nms;;°;mNm;°C\n{rest}", encoding="cp1252")
    mapping = MAPPING.replace('column = "temperature"', 'column = "Temperatur_°C"').replace('unit = "mN·m"\n', "") + (
        '[csv]\ndelimiter = ";"\ndecimal = ","\nencoding = "cp1252"\nskip_rows = 2\nunits_row = true\n'
    )
    run = foreign.imported(path, mapping)
    for channel in ("theta_m", "theta_l", "tau_l", "temperature"):
        assert np.allclose(column(run, channel), truth()[channel], rtol=0, atol=1e-12)


def test_a_csv_without_header_is_named_by_the_mapping(foreign: Foreign) -> None:
    path = foreign.file()
    path.write_text(path.read_text().partition("\n")[2])
    run = foreign.imported(path, MAPPING + '[csv]\nnames = ["time", "motor", "load", "torque", "temperature"]\n')
    assert run.rows == 400


def test_nulls_in_an_optional_channel_stay_null(foreign: Foreign) -> None:
    data = columns()
    data["torque"][[3, 5]] = np.nan
    run = foreign.imported(foreign.file(data))
    assert np.flatnonzero(np.isnan(column(run, "tau_l"))).tolist() == [3, 5]
    assert "tau_l: 2 of 400 values are null in the file and stay null" in run.manifest["notes"]


def test_a_channel_may_be_a_sum_of_columns_with_sign_and_offset(foreign: Foreign) -> None:
    terms = '[{column = "torque", scale = 0.001}, {column = "temperature", scale = -0.5}]'
    mapping = MAPPING.replace(
        'column = "torque"\nunit = "mN·m"', f'sum = {terms}\nunit = "N·m"\nsign = -1\noffset = 12.5'
    )
    run = foreign.imported(foreign.file(), mapping + '[accept]\nstiffness = "the sign is wrong on purpose"\n')
    assert np.allclose(column(run, "tau_l"), 12.5 - (truth()["tau_l"] - 0.5 * truth()["temperature"]), atol=1e-12)
    assert any(note.startswith("accepted (the sign is wrong on purpose): ") for note in run.manifest["notes"])


def test_zero_is_taken_off_before_sign_and_scale(foreign: Foreign) -> None:
    mapping = MAPPING.replace("sign = -1", "sign = -1\nzero = 10.0\noffset = 3.0")
    run = foreign.imported(foreign.file(), mapping)
    assert np.allclose(column(run, "theta_l"), truth()["theta_l"] + np.radians(10.0 + 3.0), rtol=0, atol=1e-12)
    assert json.loads((run.path / "manifest.json").read_text())["conditions"] == {}


def test_mdf_keeps_the_date_it_states(foreign: Foreign) -> None:
    from asammdf import MDF, Signal

    path = foreign.folder / "run.mf4"
    with MDF(version="4.10") as file:
        file.start_time = datetime(2026, 11, 20, 10, 0, tzinfo=UTC)
        seconds = columns()["time"] * 1e-3
        file.append([Signal(v, seconds, name=n) for n, v in columns().items() if n != "time"])
        file.save(path)
    run = foreign.imported(path, mapping_for("run.mf4"))
    assert run.manifest["started_utc"] == "2026-11-20T10:00:05.000000+00:00", "the first row is 5 s after the start"


def test_raw_counts_may_have_a_column_of_their_own(foreign: Foreign) -> None:
    data = columns()
    data["raw"] = np.round(truth()["theta_l"] * 1e5).astype(np.int64) % 2**12
    run = foreign.imported(foreign.file(data), MAPPING + '[channels.counts_l]\ncolumn = "raw"\nbits = 12\n')
    assert run.unit("counts_l") == "counts"
    assert np.array_equal(run.need("counts_l"), np.round(truth()["theta_l"] * 1e5))


def test_verify_and_list_take_an_imported_run(foreign: Foreign) -> None:
    from rig.catalogue import runs as list_runs
    from rig.runfile.verify import verify

    run = foreign.imported(foreign.file())
    assert [f for f in verify(run.path) if f.level != "note"] == []
    (row,) = list_runs(foreign.out)
    assert (row.procedure, row.gear, row.status, row.rows, row.started_utc) == (
        "kinematic_error",
        "SN7",
        "completed",
        400,
        "",
    )


@pytest.mark.parametrize("header", ["time [ms]", "time (ms)"])
def test_a_unit_in_a_column_s_name_need_not_be_given_again(foreign: Foreign, header: str) -> None:
    path = foreign.file()
    path.write_text(path.read_text().replace("time", header, 1))
    stated = MAPPING.replace('column = "time"\nunit = "ms"', f'column = "{header}"')
    assert stated != MAPPING
    run = foreign.imported(path, stated)
    np.testing.assert_allclose(run.column("t"), truth()["t"], atol=1e-6)


def test_a_unit_in_a_column_s_name_that_is_another_is_refused(foreign: Foreign) -> None:
    path = foreign.file()
    path.write_text(path.read_text().replace("time", "time [s]", 1))
    said = foreign.refused(path, MAPPING.replace('column = "time"', 'column = "time [s]"'))
    assert "channels.t.unit = 'ms', but run.csv states 's' for column 'time [s]'" in said
