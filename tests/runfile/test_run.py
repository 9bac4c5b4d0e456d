"""Opening a run, ours or another logger's."""

from __future__ import annotations

import errno
import json
import pickle
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.cli import main
from rig.core.errors import DataError, Exit, UsageError
from rig.runfile import samples
from rig.runfile.finalise import finalise
from rig.runfile.run import Run
from tests.runfile.rows import assert_prefix, expected, new_folder, write_journal

LEAST = {"schema": "hdrig.run/1", "procedure": "kinematic_error", "gear": {"ratio": 50}}
T = np.arange(100) * 1e-3


def foreign(folder: Path, manifest: dict[str, Any] | None = None, **columns: Any) -> Path:
    """A folder somebody else made: a manifest, and columns without any metadata."""
    folder.mkdir(exist_ok=True)
    (folder / "manifest.json").write_text(json.dumps(LEAST if manifest is None else manifest))
    pq.write_table(pa.table(columns or {"t": T, "theta_m": T, "theta_l": T / 50}), folder / "samples.parquet")
    return folder


def in_unit(values: Any, unit: str) -> tuple[pa.Array, dict[str, str]]:
    return pa.array(values), {"unit": unit}


def with_units(folder: Path, **columns: tuple[pa.Array, dict[str, str]]) -> Path:
    """The same, where the columns say their units."""
    fields = [pa.field(name, array.type, metadata=about) for name, (array, about) in columns.items()]
    table = pa.table([array for array, _ in columns.values()], schema=pa.schema(fields))
    foreign(folder)
    pq.write_table(table, folder / "samples.parquet")
    return folder


def closed(root: Path, rows: int = 300) -> Path:
    """One of our own."""
    folder = new_folder(root, conditions={"tau_ext": -5.0}, declared={"K": 7160.0})
    write_journal(folder, 0, rows, close=True)
    finalise(folder, "completed", "end", timing={"missed_cycles": 0})
    return folder


def test_a_run_of_ours_tells_all_it_knows(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    run = Run.open(folder)
    assert (run.name, run.path, run.rows) == (folder.name, folder, 300)
    assert (run.ratio, run.procedure, run.simulated) == (50.0, "kinematic_error", True)
    assert (run.conditions, run.declared) == ({"tau_ext": -5.0}, {"K": 7160.0})
    assert run.timing == {"missed_cycles": 0}
    assert (run.unit("tau_l"), run.unit("flags")) == ("N·m", "")
    assert "generator" in run.meaning("theta_m")
    assert run.has("theta_l")
    assert not run.has("temperature")
    assert run.column("temperature") is None
    np.testing.assert_array_equal(run.flags, expected(300)["flags"])
    assert run.flags.dtype == np.uint32
    assert_prefix(folder, 300)


def test_a_column_is_the_callers_own_float64_with_nan_where_not_measured(tmp_path: Path) -> None:
    run = Run.open(closed(tmp_path))
    torque = run.need("tau_l")
    assert torque.dtype == np.float64
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(torque)), np.arange(3, 300, 7))
    torque[:] = 0.0
    assert run.need("tau_l").any()


def test_a_missing_channel_that_is_needed_is_named_with_those_there_are(tmp_path: Path) -> None:
    run = Run.open(foreign(tmp_path / "x"))
    with pytest.raises(UsageError, match="x has no tau_l; it has t, theta_m, theta_l"):
        run.need("tau_l")


def test_one_channel_is_read_without_the_others(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    raw = bytearray((folder / "samples.parquet").read_bytes())
    about = pq.ParquetFile(folder / "samples.parquet").metadata.row_group(0)
    spoilt = about.column(5)
    at = spoilt.data_page_offset
    raw[at : at + spoilt.total_compressed_size] = b"\xff" * spoilt.total_compressed_size
    (folder / "samples.parquet").unlink()
    (folder / "samples.parquet").write_bytes(raw)
    run = Run.open(folder)
    np.testing.assert_array_equal(run.need("theta_m"), expected(300)["theta_m"])
    with pytest.raises(DataError, match=rf"samples\.parquet cannot be read: it is damaged or cut short \({len(raw)} b"):
        run.need(spoilt.path_in_schema)


def test_a_run_that_was_never_closed_is_read_from_its_journal(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    write_journal(folder, 0, 120)
    assert_prefix(folder, 120)
    assert Run.open(folder).simulated


def test_a_journal_without_one_whole_batch_is_said_to_be_damaged(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    path = write_journal(folder, 0, 120)
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(DataError, match="holds no whole batch of samples"):
        Run.open(folder)


def test_a_run_can_be_sent_to_another_process(tmp_path: Path) -> None:
    run = pickle.loads(pickle.dumps(Run.open(closed(tmp_path))))
    np.testing.assert_array_equal(run.column("theta_l"), expected(300)["theta_l"])


def test_schema_procedure_ratio_and_one_angle_are_enough(tmp_path: Path) -> None:
    run = Run.open(foreign(tmp_path / "x", theta_m=T.astype(np.float32)))
    assert (run.ratio, run.procedure, run.simulated, run.conditions, run.declared) == (
        50.0,
        "kinematic_error",
        False,
        {},
        {},
    )
    column = run.need("theta_m")
    assert column.dtype == np.float64
    np.testing.assert_array_equal(column, T.astype(np.float32).astype(np.float64))
    assert not run.has("t")
    assert not run.flags.any()
    assert (run.unit("theta_m"), run.timing) == ("", {})


def test_a_foreign_journal_without_our_marks_is_read(tmp_path: Path) -> None:
    folder = foreign(tmp_path / "x")
    (folder / "samples.parquet").unlink()
    table = pa.table({"t": T, "theta_l": T})
    with pa.OSFile(str(folder / "journal-0001.arrows"), "wb") as sink, pa.ipc.new_stream(sink, table.schema) as stream:
        stream.write_table(table, max_chunksize=30)
    np.testing.assert_array_equal(Run.open(folder).need("theta_l"), T)


def test_a_channel_nobody_measured_is_absent_however_that_was_written(tmp_path: Path) -> None:
    nothing = np.full(100, np.nan)
    folder = foreign(tmp_path / "x", theta_m=T, tau_l=nothing, tau_m=pa.nulls(100, pa.float64()), theta_l=T)
    run = Run.open(folder)
    assert [name for name in run.channels if run.has(name)] == ["theta_m", "theta_l"]
    assert run.column("tau_l") is None


def test_a_column_without_statistics_is_looked_into(tmp_path: Path) -> None:
    folder = foreign(tmp_path / "x")
    table = pa.table({"theta_m": T, "tau_l": np.full(100, np.nan)})
    pq.write_table(table, folder / "samples.parquet", write_statistics=False)
    assert Run.open(folder).has("theta_m")
    assert not Run.open(folder).has("tau_l")


def test_a_run_without_any_angle_is_refused(tmp_path: Path) -> None:
    folder = foreign(tmp_path / "x", t=T, tau_l=T, theta_l=pa.nulls(100, pa.float64()))
    with pytest.raises(UsageError, match="has no angle: expected at least one of theta_m, theta_l"):
        Run.open(folder)


def test_raw_counts_are_an_angle(tmp_path: Path) -> None:
    assert Run.open(foreign(tmp_path / "x", counts_m=np.arange(100))).rows == 100


def test_time_that_runs_backwards_is_refused_with_where(tmp_path: Path) -> None:
    t = T.copy()
    t[41] = 0.039
    with pytest.raises(DataError, match=r"time runs backwards after row 40 \(0\.040000 s, then 0\.039000 s\)"):
        Run.open(foreign(tmp_path / "x", t=t, theta_m=T))


def test_time_that_runs_backwards_where_two_stretches_of_rows_meet_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rig.core.rows.STRETCH", 41)
    t = T.copy()
    t[3], t[41] = np.nan, 0.039
    with pytest.raises(DataError, match=r"backwards after row 39 \(0\.040000 s, then 0\.039000 s\)"):
        Run.open(foreign(tmp_path / "x", t=t, theta_m=T))


def test_time_that_stands_still_or_lacks_here_and_there_is_not(tmp_path: Path) -> None:
    t = pa.array([0.0, 0.0, None, 0.001, 0.001])
    assert Run.open(foreign(tmp_path / "x", t=t, theta_m=np.arange(5.0))).rows == 5


@pytest.mark.parametrize(
    ("name", "unit", "expected_unit"),
    [("theta_m", "deg", "rad"), ("tau_l", "mN·m", "N·m"), ("t", "ms", "s"), ("theta_l", "furlong", "rad")],
)
def test_a_column_in_another_unit_is_refused_and_never_converted_in_silence(
    tmp_path: Path, name: str, unit: str, expected_unit: str
) -> None:
    columns = {"theta_m": in_unit(T, "rad"), name: in_unit(T, unit)}
    folder = with_units(tmp_path / "x", **columns)
    with pytest.raises(UsageError, match=f"column {name} is in '{unit}', expected '{expected_unit}'"):
        Run.open(folder)


@pytest.mark.parametrize("unit", ["N·m", "Nm", "N*m", "N m", ""])
def test_other_spellings_of_the_same_unit_are_not(tmp_path: Path, unit: str) -> None:
    folder = with_units(tmp_path / "x", theta_m=in_unit(T, "rad"), tau_l=in_unit(T, unit))
    assert Run.open(folder).has("tau_l")


def test_a_channel_of_the_table_that_holds_words_is_refused(tmp_path: Path) -> None:
    folder = foreign(tmp_path / "x", theta_m=["1.0", "2.0"])
    with pytest.raises(UsageError, match="column theta_m holds string, expected numbers"):
        Run.open(folder)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"gear": {}}, "gear.ratio is missing, expected a number above 0"),
        ({"gear": {"ratio": "50"}}, 'gear.ratio is "50", expected a number above 0'),
        ({"gear": {"ratio": -50}}, "gear.ratio is -50, expected a number above 0"),
        ({"gear": 50}, "gear is 50, expected an object"),
        ({"procedure": None}, "procedure is missing, expected its name"),
        ({"schema": "lerobot/2"}, 'schema "lerobot/2", expected "hdrig.run/1"'),
    ],
)
def test_a_manifest_that_lacks_what_is_required_is_refused(
    tmp_path: Path, change: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(UsageError, match=sentence):
        Run.open(foreign(tmp_path / "x", {**LEAST, **change}))


def test_a_folder_without_samples_is_refused(tmp_path: Path) -> None:
    folder = foreign(tmp_path / "x")
    (folder / "samples.parquet").unlink()
    with pytest.raises(DataError, match=r"has no samples: neither samples\.parquet nor a journal"):
        Run.open(folder)
    shutil.rmtree(folder)
    with pytest.raises(UsageError, match="is not a run folder"):
        Run.open(folder)


def test_a_samples_file_that_is_none_is_said_to_be_damaged(tmp_path: Path) -> None:
    folder = foreign(tmp_path / "x")
    (folder / "samples.parquet").write_bytes(b"PAR1 no")
    with pytest.raises(DataError, match=r"samples\.parquet cannot be read: it is damaged or cut short \(7 bytes\)$"):
        Run.open(folder)


def test_samples_nobody_may_read_are_a_place_and_no_damage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = foreign(tmp_path / "x")

    def shut(path: Path, *args: object, **more: object) -> None:
        raise PermissionError(errno.EACCES, "Failed to open local file 'x' [errno 13]")

    monkeypatch.setattr(samples.pq, "ParquetFile", shut)
    with pytest.raises(DataError, match=r"samples\.parquet cannot be read: Permission denied$") as refused:
        Run.open(folder)
    assert refused.value.exit is Exit.USAGE
    assert main(["verify", str(folder)]) == Exit.USAGE


def test_a_temperature_is_known_by_its_unit_whatever_it_is_called(tmp_path: Path) -> None:
    angle = in_unit(T, "rad")
    run = Run.open(with_units(tmp_path / "a", theta_m=angle, temp_gear=in_unit(T + 25.0, "degC")))
    assert run.has("temperature")
    np.testing.assert_allclose(run.column("temperature"), T + 25.0)
    in_kelvin = Run.open(with_units(tmp_path / "b", theta_m=angle, x=in_unit(T + 300.0, "K")))
    np.testing.assert_allclose(in_kelvin.column("temperature"), T + 26.85)
    none = Run.open(with_units(tmp_path / "c", theta_m=angle, x=in_unit(T, "V")))
    assert none.column("temperature") is None
    assert not none.has("temperature")


def test_of_several_temperatures_that_of_the_gear_is_taken(tmp_path: Path) -> None:
    several = {name: in_unit(T + more, "°C") for name, more in (("t_motor", 1.0), ("t_room", 2.0), ("t_oil", 3.0))}
    run = Run.open(with_units(tmp_path / "a", theta_m=in_unit(T, "rad"), **several))
    np.testing.assert_allclose(run.column("temperature"), T + 3.0)
    named = Run.open(with_units(tmp_path / "b", theta_m=in_unit(T, "rad"), temperature=in_unit(T, "degC"), **several))
    np.testing.assert_allclose(named.column("temperature"), T)
