"""The contract with rerun: what is written into a recording can be read back, and the viewer takes it."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.core.errors import UsageError
from rig.live.view.recording import record
from rig.live.view.rerun_canvas import Gone, RerunCanvas
from rig.live.view.server import binary
from tests.live.view.kept import turning

MANIFEST = {
    "schema": "hdrig.run/1",
    "uid": "0123456789abcdef",
    "procedure": "kinematic_error",
    "backend": "sim",
    "gear": {"ratio": 50, "serial": "G1"},
    "loop": {"rate": 1000.0},
    "started_utc": "2026-11-20T08:00:00+00:00",
}
EXPECTED = {
    *(f"/curves/{name}" for name in ("angle", "error", "speed", "shaft", "tick")),
    *(f"/folded/{name}" for name in ("banner", "frame/numbers", "frame/titles", "forward/mean", "now/line")),
    *(f"/rig/{name}" for name in ("wave_generator", "output", "material", "banner", "words")),
    "/orders",
    "/events",
    "/page",
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two seconds of a gear that turns four times, without motor torque."""
    rows = turning(4.0, 40.0, n=2000).rows
    names = ("t", "theta_m", "theta_l", "tau_l", "age")
    run = tmp_path / "run"
    run.mkdir()
    pq.write_table(pa.table({name: rows[name] for name in names}), run / "samples.parquet")
    (run / "manifest.json").write_text(json.dumps(MANIFEST))
    (run / "events.jsonl").write_text('{"t": 0.5, "kind": "trip", "text": "twist 1.2° above 1.0°"}\n')
    return run


def entities(path: Path) -> dict[str, Any]:
    """Rows by entity path."""
    from rerun.chunk import RrdReader

    found: dict[str, int] = {}
    for chunk in RrdReader(path).stream():
        batch = chunk.to_record_batch()
        name = batch.schema.metadata[b"rerun:entity_path"].decode()
        found[name] = found.get(name, 0) + batch.num_rows
    return found


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_recording_is_read_back_with_every_entity_and_every_row(folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "view.rrd"
    record(folder, path)
    found = entities(path)
    assert found.keys() >= EXPECTED
    assert "/curves/motor" not in found  # nothing was measured of it
    assert found["/curves/angle"] == 2000 + 1  # and one row for what they are called
    verified = subprocess.run([str(binary()), "rrd", "verify", str(path)], capture_output=True, text=True, check=False)
    assert verified.returncode == 0, verified.stderr
    assert not list(tmp_path.glob("*.part"))


def test_a_disk_that_fills_up_is_one_sentence_and_leaves_nothing_behind(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(canvas: RerunCanvas, within: float) -> None:
        raise Gone("File-writer thread shut down prematurely")

    monkeypatch.setattr(RerunCanvas, "flush", full)
    (tmp_path / "there").mkdir()
    with pytest.raises(UsageError, match=r"cannot be written: the disk is full.* MB were free"):
        record(folder, tmp_path / "there" / "view.rrd")
    assert list((tmp_path / "there").iterdir()) == []


@pytest.mark.slow
def test_what_cannot_be_written_or_read_is_one_sentence(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be written"):
        record(folder, tmp_path / "nowhere" / "view.rrd")
    with pytest.raises(UsageError):
        record(tmp_path, tmp_path / "view.rrd")
