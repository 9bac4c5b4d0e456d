"""A new run folder: `runs/2026-11-20/0147-kinematic-error-SN0042-3f9c`."""

from __future__ import annotations

import os
import re
import time
import uuid
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rig.core.errors import NotReady
from rig.runfile.manifest import SCHEMA, Manifest, sync_folder, told, utc_now, write, write_atomic
from rig.runfile.process import this_process


def create(root: Path | str, procedure: str, manifest: Mapping[str, Any], bench_toml: str = "") -> Path:
    """Make the folder of one run under `root`, by date, and write its manifest, status "running". Returns the folder.

    `procedure` as in the manifest, with underscores. `manifest` holds what the caller knows (backend, gear, declared,
    conditions, encoders, software, clock …) and wins over what is filled in here (uid, started_utc, clock, process).
    `bench_toml` is the resolved configuration. Raises NotReady when nothing can be written there; nothing moved.
    """
    first = _first_manifest(procedure, manifest)
    began = _began(first)
    with told(NotReady, f"no run folder can be made in {root}"):
        return _create(Path(root) / f"{began:%Y-%m-%d}", f"{began:%H%M}", procedure, first, bench_toml)


def create_in(root: Path | str, procedure: str, manifest: Mapping[str, Any], bench_toml: str = "") -> Path:
    """As `create`, but directly in `root`: a campaign is a folder of run folders."""
    first = _first_manifest(procedure, manifest)
    with told(NotReady, f"no run folder can be made in {root}"):
        return _create(Path(root), f"{_began(first):%m%d-%H%M}", procedure, first, bench_toml)


def create_hidden(root: Path | str, procedure: str, manifest: Mapping[str, Any]) -> Path:
    """As `create`, but no verb takes it for a run before `shown`: for what is one only when it is whole."""
    first = _first_manifest(procedure, manifest)
    began = _began(first)
    with told(NotReady, f"no run folder can be made in {root}"):
        return _create(Path(root) / f"{began:%Y-%m-%d}", f".{began:%H%M}", procedure, first, "")


def shown(hidden: Path) -> Path:
    """Give a folder made hidden its name as a run, safe on disk; returns it. Raises OSError."""
    name = hidden.name.removeprefix(".")
    while os.path.lexists(hidden.with_name(name)):
        name = _another(name)
    folder = hidden.rename(hidden.with_name(name))
    sync_folder(folder.parent)
    return folder


def _another(name: str) -> str:
    """The name of a second run in the same minute with the same four digits: one chance in 65 536."""
    return f"{name[:-4]}{uuid.uuid4().hex[:4]}"


def _create(parent: Path, start: str, procedure: str, first: Manifest, bench_toml: str) -> Path:
    folder = _new_folder(parent, start, procedure, first)
    write(folder, first)
    if bench_toml:
        write_atomic(folder / "bench.toml", bench_toml.encode())
    return folder


def _began(manifest: Manifest) -> datetime:
    return datetime.fromisoformat(manifest["started_utc"]).astimezone(UTC)


def _first_manifest(procedure: str, given: Mapping[str, Any]) -> Manifest:
    now = str(given.get("started_utc", utc_now()))
    return {
        "schema": SCHEMA,
        "uid": uuid.uuid4().hex,
        "procedure": procedure,
        "status": "running",
        "started_utc": now,
        "clock": {"utc_at_start": now, "monotonic_at_start_ns": time.monotonic_ns()},
        "process": this_process(),
        **given,
    }


def _new_folder(parent: Path, start: str, procedure: str, manifest: Manifest) -> Path:
    """The folder, empty and surely ours: two runs in one minute differ in their uid."""
    serial = re.sub(r"[^A-Za-z0-9._-]+", "-", str(manifest.get("gear", {}).get("serial") or "no-serial"))
    name = f"{start}-{manifest.get('label') or procedure.replace('_', '-')}-{serial}-{manifest['uid'][:4]}"
    parent.mkdir(parents=True, exist_ok=True)
    folder = parent / name
    while True:
        try:
            folder.mkdir()
            break
        except FileExistsError:
            folder = parent / _another(name)
    sync_folder(parent)
    return folder
