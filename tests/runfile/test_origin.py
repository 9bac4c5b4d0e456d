"""One sign of the twin is enough, in the manifest or in the samples; nothing else makes a run simulated."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.runfile import manifest
from rig.runfile.columns import schema
from rig.runfile.run import Run
from rig.runfile.verify import verify
from tests.runfile.rows import write_journal

LEAST = {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": 50}}
TWINS = {"backend": "sim", "simulated": "true"}


def run(folder: Path, said: Any, metadata: dict[str, str], **more: Any) -> Path:
    """Three rows somebody measured, or did not; `said` is the backend in the manifest, "absent" none."""
    folder.mkdir()
    columns = {"t": [0.0, 1e-3, 2e-3], "theta_m": [0.0, 0.1, 0.2], **more}
    table = pa.table(columns).replace_schema_metadata(metadata)
    pq.write_table(table, folder / "samples.parquet")
    (folder / "manifest.json").write_text(json.dumps({**LEAST, **({} if said == "absent" else {"backend": said})}))
    return folder


@pytest.mark.parametrize("said", ["absent", None, "can", "imported", "odd"])
@pytest.mark.parametrize(
    ("metadata", "simulated"),
    [
        (TWINS, True),
        ({"simulated": "true"}, True),
        ({"backend": "sim"}, True),
        ({"backend": "can", "simulated": "false"}, False),
        ({"simulated": "yes, no"}, False),
        ({}, False),
    ],
)
def test_samples_that_say_so_are_simulated_whatever_the_manifest_says(
    tmp_path: Path, said: Any, metadata: dict[str, str], simulated: bool
) -> None:
    folder = run(tmp_path / "run", said, metadata)
    kept = None if said == "absent" else said
    assert manifest.read(folder).get("backend") == ("sim" if simulated else kept)
    assert Run.open(folder).simulated is simulated
    assert manifest.as_written(folder).get("backend") == kept


def test_a_manifest_that_says_so_is_believed_and_no_sample_is_looked_at(tmp_path: Path) -> None:
    assert Run.open(run(tmp_path / "run", "sim", {"backend": "can", "simulated": "false"})).simulated
    (tmp_path / "run" / "samples.parquet").write_bytes(b"")
    assert manifest.read(tmp_path / "run")["backend"] == "sim"


def test_a_journal_alone_says_it_too(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps(LEAST))
    write_journal(tmp_path, 0, 100)
    assert Run.open(tmp_path).simulated
    pq.write_table(schema("can").empty_table(), tmp_path / "samples.parquet")
    assert not Run.open(tmp_path).simulated, "the archive goes before the journal, as for whoever reads the samples"


@pytest.mark.parametrize("name", ["samples.parquet", "journal-0001.arrows"])
@pytest.mark.parametrize("data", [b"", b"PAR1", b"\xff" * 64])
def test_samples_that_cannot_be_read_say_nothing_and_keep_no_manifest_from_being_read(
    tmp_path: Path, name: str, data: bytes
) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps({**LEAST, "backend": "can"}))
    (tmp_path / name).write_bytes(data)
    assert manifest.read(tmp_path)["backend"] == "can"


def test_a_change_of_the_manifest_keeps_what_it_says_itself(tmp_path: Path) -> None:
    folder = run(tmp_path / "run", "can", TWINS)
    manifest.update(folder, verdict="PASS")
    assert json.loads((folder / "manifest.json").read_text())["backend"] == "can"


@pytest.mark.parametrize(("said", "told"), [("absent", False), (None, False), ("sim", False), ("can", True)])
def test_verify_names_a_manifest_that_says_otherwise_than_the_samples(tmp_path: Path, said: Any, told: bool) -> None:
    sentence = (
        f"samples.parquet says that its samples are simulated, and manifest.json that the backend is {said!r}, "
        "expected 'sim'; the run counts as simulated"
    )
    found = verify(run(tmp_path / "run", said, TWINS))
    assert [(f.level, f.sentence) for f in found if f.check == "backend"] == ([("warning", sentence)] if told else [])


def test_rows_flagged_as_simulated_in_a_run_of_hardware_stay_an_error(tmp_path: Path) -> None:
    found = verify(run(tmp_path / "run", "can", TWINS, flags=[1, 1, 1]))
    levels = [f.level for f in found if f.check == "backend"]
    assert levels == ["warning", "error"]
