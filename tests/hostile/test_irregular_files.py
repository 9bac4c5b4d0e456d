"""A pipe, a socket, a device, a folder or a link in a ring where a file should be: a sentence at once, no waiting."""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.core.errors import HdrigError
from rig.core.regular import regular
from rig.model import gearfile
from rig.report.trace.campaign import provenance
from rig.runfile.events import read_events
from rig.runfile.importing.mapping import load_mapping
from rig.runfile.recover import recover
from rig.runfile.run import Run
from rig.runfile.verify import verify

T = np.arange(100) * 1e-3


def pipe(path: Path) -> None:
    os.mkfifo(path)  # nobody ever writes: to open it would be to wait for ever


def ear(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))


def device(path: Path) -> None:
    path.symlink_to("/dev/zero")


def ring(path: Path) -> None:
    path.symlink_to(path.name)


KINDS: dict[Callable[[Path], None], str] = {
    pipe: "a named pipe",
    ear: "a socket",
    device: "a device",
    Path.mkdir: "a folder",
}
IN_PLACE = pytest.mark.parametrize("put", KINDS, ids=lambda put: put.__name__)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A run by somebody else; its names stay short, as those of sockets have to be."""
    monkeypatch.chdir(tmp_path)
    made = Path("r")
    made.mkdir()
    least = {"schema": "hdrig.run/1", "procedure": "kinematic_error", "gear": {"ratio": 50}}
    said = {"files": {"samples.parquet": {"sha256": "0"}, "events.jsonl": {"sha256": "0"}}}
    (made / "manifest.json").write_text(json.dumps({**least, **said}))
    pq.write_table(pa.table({"t": T, "theta_m": T, "theta_l": T / 50}), made / "samples.parquet")
    (made / "events.jsonl").write_text('{"kind": "note"}\n')
    return made


def replaced(folder: Path, name: str, put: Callable[[Path], None]) -> None:
    (folder / name).unlink(missing_ok=True)
    put(folder / name)


@IN_PLACE
def test_what_is_no_regular_file_is_called_by_what_it_is(
    tmp_path: Path, put: Callable[[Path], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    put(Path("x"))
    with pytest.raises(OSError, match=f"it is {KINDS[put]}, expected a regular file"):
        regular("x")


def test_a_link_in_a_ring_and_a_name_that_is_none_are_no_files(tmp_path: Path) -> None:
    ring(tmp_path / "x")
    for path in (tmp_path / "x", tmp_path / "absent", "a\0b", "\ud800", "a" * 5000):
        with pytest.raises((OSError, ValueError)):
            regular(path)
    (tmp_path / "y").write_text("as it is")
    assert regular(tmp_path / "y").st_size == 8


@IN_PLACE
def test_samples_that_are_no_file_are_refused_in_words(folder: Path, put: Callable[[Path], None]) -> None:
    replaced(folder, "samples.parquet", put)
    with pytest.raises(HdrigError, match=rf"samples\.parquet cannot be read: it is {KINDS[put]}, expected a reg"):
        Run.open(folder)
    said = [f.sentence for f in verify(folder) if f.check == "hashes"]
    assert any(s.startswith(f"samples.parquet cannot be read: it is {KINDS[put]}") for s in said)


@IN_PLACE
def test_events_that_are_no_file_are_refused_in_words(folder: Path, put: Callable[[Path], None]) -> None:
    replaced(folder, "events.jsonl", put)
    with pytest.raises(HdrigError, match=rf"events\.jsonl cannot be read: it is {KINDS[put]}"):
        read_events(folder)


@IN_PLACE
def test_a_journal_that_is_no_file_is_refused_in_words(folder: Path, put: Callable[[Path], None]) -> None:
    (folder / "samples.parquet").unlink()
    open_still = {"schema": "hdrig.run/1", "procedure": "kinematic_error", "gear": {"ratio": 50}, "status": "running"}
    (folder / "manifest.json").write_text(json.dumps(open_still))
    put(folder / "journal-0001.arrows")
    for act in (Run.open, recover):
        with pytest.raises(HdrigError, match=f"it is {KINDS[put]}, expected a regular file"):
            act(folder)


@IN_PLACE
def test_no_file_beside_the_samples_is_waited_for(folder: Path, put: Callable[[Path], None]) -> None:
    replaced(folder, "timing.json", put)
    assert Run.open(folder).timing == {}
    replaced(folder, "manifest.json", put)
    assert provenance(folder.parent, {}, "").manifests == {}
    put(Path("gear.toml"))
    for read in (gearfile.read, load_mapping):
        with pytest.raises(HdrigError, match=f"it is {KINDS[put]}"):
            read(Path("gear.toml"))


def test_a_file_the_disk_cannot_read_is_a_finding(folder: Path) -> None:
    replaced(folder, "samples.parquet", lambda path: path.symlink_to("/proc/self/mem"))  # reads as an I/O error
    assert any("Input/output error" in f.sentence for f in verify(folder))


@pytest.mark.slow
def test_a_line_of_two_hundred_megabytes_is_no_event(folder: Path) -> None:
    with open(folder / "events.jsonl", "ab") as file:
        file.truncate(200 * 2**20)  # sparse: zero bytes, which is what a file system may leave after a power cut
    assert read_events(folder) == [{"kind": "note"}]
