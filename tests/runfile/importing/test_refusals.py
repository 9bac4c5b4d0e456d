"""Every refusal is one sentence with the numbers in it, and leaves nothing behind (`Foreign.refused` looks)."""

from __future__ import annotations

import json
import os
import platform
import time
from typing import Any

import numpy as np
import pytest

from rig.analysis.reproduction.gather import entries
from rig.core.errors import DataError
from rig.runfile.listing import run_folders, runs_in
from rig.runfile.process import this_process

from .conftest import Foreign, with_column
from .formats import MAPPING, ROWS, columns, truth


def test_a_column_that_is_absent_is_named_with_the_nearest_there_is(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('column = "torque"', 'column = "torqe"'))
    assert said == "run.csv has no column 'torqe'; did you mean 'torque'?"


def test_a_column_like_none_there_gets_the_list(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('column = "torque"', 'column = "Kanal 7"'))
    assert "there is time, motor, load, torque, temperature" in said


def test_a_column_that_stands_twice(foreign: Foreign) -> None:
    path = foreign.file()
    path.write_text(path.read_text().replace("temperature", "torque", 1))
    said = foreign.refused(path, MAPPING.split("[channels.temperature]")[0])
    assert said == "run.csv: column 'torque' stands in 2 places; expected it once"


def test_time_that_runs_backwards_is_told_with_row_and_values(foreign: Foreign) -> None:
    data = columns()
    data["time"][10], data["time"][11] = 5022.5, 5020.25
    said = foreign.refused(foreign.file(data))
    assert said.startswith("run.csv: time runs backwards 1 times, first at row 12: 5022.5 ms is followed by 5020.25 ms")


def test_equal_time_stamps_are_counted_and_refused_unless_they_may_be_dropped(foreign: Foreign) -> None:
    data = columns()
    data["time"][[21, 22, 40]] = data["time"][[20, 20, 39]]
    said = foreign.refused(foreign.file(data))
    assert said.startswith("run.csv: 3 rows have the time stamp of the row before, first row 22 (")
    assert 'set channels.t.duplicates = "drop"' in said
    run = foreign.imported(foreign.file(data), MAPPING.replace('unit = "ms"', 'unit = "ms"\nduplicates = "drop"'))
    assert run.rows == ROWS - 3
    assert "3 rows dropped: they had the time stamp of the row before" in run.manifest["notes"]
    assert np.allclose(run.need("theta_l"), np.delete(truth()["theta_l"], [21, 22, 40]), rtol=0, atol=1e-12)


@pytest.mark.parametrize(("column", "channel"), [("time", "t"), ("motor", "theta_m"), ("load", "theta_l")])
@pytest.mark.parametrize(("hole", "word"), [(np.nan, "missing (null or NaN)"), (np.inf, "infinite")])
def test_a_hole_in_a_needed_channel(foreign: Foreign, column: str, channel: str, hole: float, word: str) -> None:
    data = columns()
    data[column] = data[column].astype(float)
    data[column][[6, 7, 30]] = hole
    said = foreign.refused(foreign.file(data, "run.parquet"))
    assert said.startswith(f"run.parquet: 3 of 400 values of {channel} (column '{column}') are {word}, first in row 7")
    assert f'or set channels.{channel}.holes = "drop"' in said
    keys = MAPPING.replace(f"[channels.{channel}]", f'[channels.{channel}]\nholes = "drop"')
    run = foreign.imported(foreign.file(data, "run.parquet"), keys)
    note = f"3 of 400 rows left out: {channel} has no value there, first in row 7 of the file"
    assert note in run.manifest["notes"]
    assert np.allclose(run.need("theta_l"), np.delete(truth()["theta_l"], [6, 7, 30]), rtol=0, atol=1e-12)


def test_infinity_is_not_a_measurement_even_in_an_optional_channel(foreign: Foreign) -> None:
    data = columns()
    data["temperature"][[0, 9]] = -np.inf
    assert "2 of 400 values of temperature (column 'temperature') are infinite, first in row 1" in foreign.refused(
        foreign.file(data)
    )


def test_columns_of_unequal_length(foreign: Foreign) -> None:
    data = columns()
    data["torque"] = data["torque"][::2]
    said = foreign.refused(foreign.file(data, "run.tdms"))
    assert "not equally long: 'time' 400, 'motor' 400, 'load' 400, 'torque' 200" in said


def test_a_wrap_nobody_declared_is_told_with_the_key_that_mends_it(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace("bits = 16\n", ""))
    assert "column 'motor' jumps by -65337 counts" in said
    assert "counts at row 317, nearly a full 65536: it wraps; set channels.theta_m.modulus = 65536" in said


def test_a_wrap_at_a_turn_in_degrees(foreign: Foreign) -> None:
    data = with_column("load", lambda load: (load + 100.0) % 360.0)
    said = foreign.refused(foreign.file(data))
    assert "nearly a full 360: it wraps; set channels.theta_l.modulus = 360" in said
    run = foreign.imported(foreign.file(data), MAPPING.replace("sign = -1", "sign = -1\nmodulus = 360"))
    theta_l = run.need("theta_l")
    assert np.allclose(theta_l - theta_l[0], truth()["theta_l"] - truth()["theta_l"][0], rtol=0, atol=1e-9)


def test_one_wild_value_is_not_called_a_wrap(foreign: Foreign) -> None:
    data = columns()
    data["load"][200] += 360.0
    assert "wraps" not in foreign.refused(foreign.file(data))


def test_a_modulus_that_is_too_small(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace("bits = 16", "bits = 12"))
    assert "channels.theta_m wraps at 4096 counts, but column 'motor' goes from " in said


@pytest.mark.parametrize("low", [0.0, -np.pi])
@pytest.mark.parametrize("written", [3, 4, 9, 12, np.float32])
def test_the_modulus_that_was_advised_is_taken_however_many_digits_were_written(
    foreign: Foreign, low: float, written: Any
) -> None:
    def wrapped(load: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        rad = low + np.radians(load + 300.0) % (2 * np.pi)
        rad[np.argmax(rad)], rad[np.argmin(rad)] = low + 2 * np.pi - 1e-13, low  # at the very ends
        return np.round(rad, written) if isinstance(written, int) else rad.astype(written).astype(np.float64)

    mapping = MAPPING.replace('unit = "deg"', 'unit = "rad"').replace("sign = -1", "sign = 1")
    mapping += '[accept]\nratio = "only the wrap matters here"\n'
    file = foreign.file(with_column("load", lambda load: wrapped(-load)))
    advice = "set channels.theta_l.modulus = 6.283185307179586"
    assert advice in foreign.refused(file, mapping)
    run = foreign.imported(file, mapping.replace("sign = 1", "modulus = 6.283185307179586"))
    assert float(np.abs(np.diff(run.need("theta_l"))).max()) < 0.1


def test_what_spans_more_than_its_last_digit_beyond_the_modulus_is_refused(foreign: Foreign) -> None:
    data = with_column("load", lambda load: np.linspace(0.0, 6.2835, load.size))
    mapping = MAPPING.replace('unit = "deg"', 'unit = "rad"').replace("sign = -1", "modulus = 6.2832")
    assert "goes from 0 to 6.2835; take modulus" in foreign.refused(foreign.file(data), mapping)


def test_counts_that_are_not_whole(foreign: Foreign) -> None:
    data = with_column("motor", lambda motor: motor + 0.25 * (np.arange(motor.size) == 4))
    said = foreign.refused(foreign.file(data))
    assert said.startswith("run.csv: 1 of 400 values of theta_m (column 'motor') are not whole counts, first ")
    assert "in row 5" in said


@pytest.mark.parametrize("rows", [0, 1])
def test_less_than_two_rows(foreign: Foreign, rows: int) -> None:
    data = {name: values[:rows] for name, values in columns().items()}
    said = foreign.refused(foreign.file(data))
    assert f"run.csv has {rows} row" in said
    assert "expected at least 2" in said


def test_one_column_for_both_angles(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('column = "load"', 'column = "motor"'))
    assert "theta_m and theta_l are both column 'motor'" in said


def test_text_where_numbers_should_be_is_shown(foreign: Foreign) -> None:
    path = foreign.file()
    lines = path.read_text().splitlines()
    lines[8] = lines[8].rpartition(",")[0] + ",overflow"
    path.write_text("\n".join(lines) + "\n")
    assert foreign.refused(path) == "run.csv: column 'temperature' is not numbers: row 8 holds 'overflow'"


def test_a_unit_the_file_states_otherwise(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(name="run.tdms"), MAPPING.replace("mN·m", "N·m"))
    assert "channels.tau_l.unit = 'N·m', but run.tdms states 'mN·m' for column 'torque'; set unit = \"mN·m\"" in said


def test_a_unit_nobody_states(foreign: Foreign) -> None:
    said = foreign.refused(foreign.file(), MAPPING.replace('unit = "deg"\n', ""))
    assert "channels.theta_l has no unit and run.csv states none; expected one of rad, mrad, deg" in said


def test_a_root_that_cannot_be_written_is_not_the_operators_mapping(foreign: Foreign) -> None:
    from rig.core.errors import NotReady
    from rig.runfile.importing import import_file

    foreign.out.write_text("a file where the runs should go")
    with pytest.raises(NotReady, match="no run folder can be made in"):
        import_file(foreign.file(), foreign.mapping(MAPPING), foreign.out)


def test_a_disk_that_fills_up_leaves_no_half_run(foreign: Foreign, monkeypatch: pytest.MonkeyPatch) -> None:
    from rig.core.errors import UsageError
    from rig.runfile.importing import import_file, write

    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(write, "_write_samples", full)
    with pytest.raises(UsageError, match=r"cannot write the imported run to .*: No space left on device"):
        import_file(foreign.file(), foreign.mapping(MAPPING), foreign.out)
    assert not list(foreign.out.rglob("manifest.json"))


@pytest.mark.parametrize("other", [False, True], ids=["first of its day", "beside another"])
def test_ctrl_c_while_it_writes_leaves_nothing(foreign: Foreign, monkeypatch: pytest.MonkeyPatch, other: bool) -> None:
    kept = [foreign.imported(foreign.file()).path] if other else []

    def halted(*args: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("rig.runfile.importing.write._close", halted)
    with pytest.raises(KeyboardInterrupt):
        foreign.imported(foreign.file(), MAPPING.replace("SN7", "SN8"))
    assert [path for day in foreign.out.iterdir() for path in day.iterdir()] == kept
    assert [day.name for day in foreign.out.iterdir()] == [path.parent.name for path in kept]


def test_what_a_kill_leaves_is_no_run_for_any_verb(foreign: Foreign, monkeypatch: pytest.MonkeyPatch) -> None:
    from rig.runfile.importing import write

    seen: list[object] = []
    close, out = write._close, foreign.out

    def looked_at(*given: Any) -> None:
        close(*given)  # its manifest says completed by now
        seen.append((runs_in(out), list(run_folders(str(out))), len(list(out.rglob("manifest.json")))))
        with pytest.raises(DataError, match="holds no completed run"):
            entries(out)

    monkeypatch.setattr(write, "_close", looked_at)
    run = foreign.imported(foreign.file())
    assert seen == [([], [], 1)]
    assert runs_in(out) == [run.path]
    assert not run.path.name.startswith(".")


def test_the_next_import_sweeps_what_a_killed_one_left_and_nothing_else(foreign: Foreign) -> None:
    kept = foreign.imported(foreign.file()).path
    whole = json.loads((kept / "manifest.json").read_text())
    about = whole | {"status": "recording"}
    day, here = kept.parent, platform.node()
    gone = {"pid": 2**22 - 1, "started": 1, "host": here}
    left = {
        ".0147-killed": about | {"process": gone},
        ".0147-alive": about | {"process": this_process()},
        ".0147-elsewhere": about | {"process": gone | {"host": "another"}},
        ".0147-no-import": {k: v for k, v in about.items() if k != "import"} | {"process": gone},
        ".0147-being-named": whole,
        ".0147-never-named": whole,
    }
    for name, manifest in left.items():
        (day / name).mkdir()
        (day / name / "manifest.json").write_text(json.dumps(manifest))
    (day / ".0147-nothing").mkdir()
    os.utime(day / ".0147-never-named", (0.0, time.time() - 4000.0))
    again = foreign.imported(foreign.file(), MAPPING.replace("SN7", "SN8")).path
    stay = {*left, ".0147-nothing", kept.name, again.name} - {".0147-killed", ".0147-never-named"}
    assert {path.name for path in day.iterdir()} == stay
