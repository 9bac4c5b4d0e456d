"""What `hdrig export` wrote and `hdrig import` reads again: simulated samples are never read in as measured ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.core.errors import UsageError
from rig.report.words import origin
from rig.runfile.export import export
from rig.runfile.finalise import finalise
from rig.runfile.importing import import_file
from rig.runfile.run import Run
from rig.runfile.verify import verify
from tests.runfile.rows import new_folder, write_journal

from . import formats
from .conftest import Foreign

MAPPING = """
schema = "hdrig.import/1"
procedure = "kinematic_error"
[csv]
units_row = true
[gear]
ratio = 50
[accept]
ratio = "made-up rows"
speed = "made-up rows"
torque = "made-up rows"
stiffness = "made-up rows"
[channels.t]
column = "t"
unit = "s"
[channels.theta_m]
column = "theta_m"
unit = "rad"
[channels.theta_l]
column = "theta_m"
scale = 0.02
unit = "rad"
"""


def exported(folder: Path, kind: str, backend: str) -> Path:
    made = new_folder(folder, backend=backend, started_utc="2026-11-20T01:47:00+00:00")
    write_journal(made, 0, 300, close=True)
    finalise(made, "completed", "end")
    return made / "samples.parquet" if kind == "parquet" else export(Run.open(made), kind)


@pytest.mark.parametrize("kind", ["csv", "hdf5", "mdf4", "parquet"])
@pytest.mark.parametrize(("backend", "again"), [("sim", "sim"), ("can", "imported")])
def test_an_export_read_again_is_as_simulated_as_the_run_was(
    foreign: Foreign, tmp_path: Path, kind: str, backend: str, again: str
) -> None:
    file = exported(tmp_path / "first", kind, backend)
    run = Run.open(import_file(file, foreign.mapping(MAPPING), foreign.out))
    assert run.manifest["backend"] == again
    assert run.simulated is (backend == "sim")
    assert (origin(run.manifest["backend"]).mark == "SIMULATED") is (backend == "sim")
    assert not [f for f in verify(run.path) if f.level == "error"]


def test_a_row_of_units_that_was_not_announced_is_told_with_the_key_to_set(foreign: Foreign, tmp_path: Path) -> None:
    file = exported(tmp_path / "first", "csv", "can")
    said = foreign.refused(file, MAPPING.replace("[csv]\nunits_row = true\n", ""))
    assert "row 1 holds 's', a unit, in column 't'; set [csv] units_row = true" in said
    without = MAPPING.replace("[csv]\nunits_row = true\n", "").replace('unit = "s"\n', "").replace('unit = "rad"\n', "")
    assert foreign.refused(file, without) == said


@pytest.mark.parametrize("deep", ["", "lab"])
def test_a_file_that_was_imported_before_is_refused_and_the_run_named(foreign: Foreign, deep: str) -> None:
    file, mapping = foreign.file(), foreign.mapping(formats.MAPPING)
    first = import_file(file, mapping, foreign.out / deep)
    moved = file.rename(file.with_name("renamed.csv"))
    with pytest.raises(UsageError, match=f"renamed.csv was imported by this mapping before, as {first}; .*--again"):
        import_file(moved, mapping, foreign.out)
    again = import_file(moved, mapping, foreign.out, again=True)
    assert again != first


def test_another_file_or_another_mapping_is_another_run(foreign: Foreign) -> None:
    import_file(foreign.file(), foreign.mapping(formats.MAPPING), foreign.out)
    import_file(foreign.file(), foreign.mapping(formats.MAPPING + "# corrected\n"), foreign.out)
    data = formats.columns()
    warmer = foreign.file(data | {"temperature": data["temperature"] + 1})
    import_file(warmer, foreign.mapping(formats.MAPPING), foreign.out)
