"""A manifest that is damaged is rebuilt by recover from what lies beside it; nothing is overwritten."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from rig.cli import main
from rig.core.errors import UsageError
from rig.runfile import manifest
from rig.runfile.finalise import finalise
from rig.runfile.recover import recover
from rig.runfile.run import Run
from rig.runfile.verify import verify
from tests.runfile.rows import copy_of, manifest_of, new_folder, write_journal

BENCH = 'schema = "hdrig.bench/1"\n[gear]\nserial = "SN7"\nN = { value = 80.0, unit = "1", from = "paper" }\n'


def damaged(root: Path, left: bytes = b"", close: bool = True, **about: str) -> Path:
    """A run of 300 rows of which the manifest holds `left`."""
    folder = new_folder(root, **about)
    (folder / "bench.toml").write_text(BENCH)
    write_journal(folder, 0, 300, close=True)
    if close:
        finalise(folder, "completed", "end", timing={"ticks": 300})
    (folder / "manifest.json").write_bytes(left)
    return folder


@pytest.mark.parametrize("close", [True, False])
@pytest.mark.parametrize("left", [b"", b'{"schema": "hdrig.run/1", "proc', b"\0" * 400], ids=["empty", "cut", "zeros"])
def test_recover_rebuilds_a_damaged_manifest_and_keeps_the_old_one(tmp_path: Path, left: bytes, close: bool) -> None:
    folder = damaged(tmp_path, left, close)
    told = recover(folder)
    assert "300 rows" in told.sentence
    assert "rebuilt from bench.toml and the samples" in told.sentence
    about = manifest_of(folder)
    assert (about["procedure"], about["status"], about["backend"]) == ("other", "interrupted", "sim")
    assert about["gear"] == {"ratio": 80.0, "serial": "SN7"}
    assert "rebuilt" in about["exit_reason"]
    assert (folder / "manifest-damaged-1.json").read_bytes() == left
    assert (Run.open(folder).rows, [f for f in verify(folder) if f.level == "error"]) == (300, [])
    assert not recover(folder).changed


@pytest.mark.parametrize("close", [True, False])
def test_recover_makes_a_manifest_that_is_gone(tmp_path: Path, close: bool) -> None:
    folder = damaged(tmp_path, close=close)
    (folder / "manifest.json").unlink()
    assert "manifest.json is missing and was rebuilt from bench.toml and the samples" in recover(folder).sentence
    assert (Run.open(folder).rows, manifest_of(folder)["gear"]) == (300, {"ratio": 80.0, "serial": "SN7"})
    assert not list(folder.glob("manifest-damaged-*"))  # there was no file to keep
    assert not recover(folder).changed


def test_a_second_damaged_manifest_does_not_overwrite_the_first(tmp_path: Path) -> None:
    folder = damaged(tmp_path, b"one")
    recover(folder)
    (folder / "manifest.json").write_bytes(b"two")
    recover(folder)
    assert [(folder / f"manifest-damaged-{n}.json").read_bytes() for n in (1, 2)] == [b"one", b"two"]


def test_samples_alone_get_a_manifest_and_stay_as_they_are(tmp_path: Path) -> None:
    folder = damaged(tmp_path)
    (folder / "journal-0001.arrows").unlink()
    before = (folder / "samples.parquet").read_bytes()
    assert "was rebuilt" in recover(folder).sentence
    assert ((folder / "samples.parquet").read_bytes(), Run.open(folder).rows) == (before, 300)


def test_a_drive_led_by_speed_is_told_by_the_names_of_its_columns(tmp_path: Path) -> None:
    folder = damaged(tmp_path)
    (folder / "journal-0001.arrows").unlink()
    table = pq.read_table(folder / "samples.parquet")
    (folder / "samples.parquet").unlink()
    names = ["omega_ask" if name == "tau_ask" else name for name in table.column_names]
    pq.write_table(table.rename_columns(names), folder / "samples.parquet")
    recover(folder)
    assert manifest_of(folder)["loop"] == {"mode": "velocity"}


@pytest.mark.parametrize("bench", [None, "", "[gear]\nN = 0\n", "gear = 1\n", "[gear\n"])
def test_without_a_ratio_nothing_is_made_up(tmp_path: Path, bench: str | None) -> None:
    folder = damaged(tmp_path)
    (folder / "bench.toml").unlink()
    if bench is not None:
        (folder / "bench.toml").write_text(bench)
    before = sorted(p.name for p in folder.iterdir())
    with pytest.raises(UsageError, match=r"is empty \(0 bytes\), and no bench.toml beside it says gear.N .* at least"):
        recover(folder)
    assert (sorted(p.name for p in folder.iterdir()), (folder / "manifest.json").read_bytes()) == (before, b"")


def test_an_empty_manifest_is_said_to_be_empty_with_the_next_step(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = copy_of(damaged(tmp_path), tmp_path / "copy")
    assert main(["analyse", str(folder)]) == 2
    said = capsys.readouterr().err
    assert f"{manifest.NAME} is empty (0 bytes); hdrig recover makes it anew" in said
