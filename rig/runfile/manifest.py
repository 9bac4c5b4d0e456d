"""`manifest.json`: who, what, when, with what. Written first, as "running"; every change replaces the whole file."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rig.core.errors import HdrigError, UsageError, of_place, said_of
from rig.core.numbers import number
from rig.core.regular import regular
from rig.runfile.origin import with_origin
from rig.runfile.remains import SAMPLES, hold_samples

SCHEMA = "hdrig.run/1"
NAME = "manifest.json"
SIMULATED = "SIMULATED"  # how an export marks the twin's samples, by which an import knows them again
ENDINGS = ("completed", "stopped", "tripped", "interrupted")

LONGEST = 2**24  # bytes: of a thousand times what ours have, and still read within a second
DEPTH = 64  # of lists and objects in one another; ours have 5, and what recurses over a hundred times more fails
OBJECTS = (
    "gear", "declared", "conditions", "encoders", "software", "clock", "files", "process", "closing",
)  # fmt: skip
STRINGS = ("backend", "status", "exit_reason", "started_utc", "ring", "uid")

Manifest = dict[str, Any]


class Damaged(UsageError):
    """A manifest that holds no JSON, or no object: empty, cut short or overwritten."""

    def __init__(self, path: Path, what: str, said: str = "") -> None:
        anew = "hdrig recover makes it anew where bench.toml and samples lie beside it"
        super().__init__(f"{said or f'{path} {what}'}; {anew}")
        self.what = what  # "is empty (0 bytes)"


class Missing(Damaged):
    """Samples in a folder without a manifest."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, "is missing", f"{path.parent} has samples and no {path.name}")


def read(folder: Path) -> Manifest:
    """The manifest of `folder` as everybody goes by it: its `backend` is "sim" also where only the samples say that
    they are the twin's, see `origin`. Raises what `as_written` does.
    """
    return with_origin(folder, as_written(folder))


def as_written(folder: Path) -> Manifest:
    """The manifest of `folder` as its file has it, for who changes or checks it; a null is as good as an absent key.

    Raises UsageError when there is none, it is JSON of another schema, or a key holds what it cannot; Damaged when it
    is no object in JSON, Missing when there are samples and none.
    """
    path = folder / NAME
    try:
        found = parse(contents(path))
    except FileNotFoundError:
        if is_nameless(folder):
            raise Missing(path) from None
        raise UsageError(f"{folder} is not a run folder: it has no {NAME}") from None
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror}") from error
    except ValueError as error:
        what = f"is not JSON: {error}" if path.stat().st_size else "is empty (0 bytes)"
        raise Damaged(path, what) from error
    if not isinstance(found, dict):
        raise Damaged(path, f'is {_kind(found)}, expected an object with schema "{SCHEMA}"')
    if found.get("schema") != SCHEMA:
        said = f"has schema {_short(found['schema'])}" if "schema" in found else "has no schema"
        raise UsageError(f'{path} {said}, expected "{SCHEMA}"')
    found = {key: value for key, value in found.items() if value is not None}
    _refuse_other_kinds(path, found)
    return found


def is_nameless(folder: Path) -> bool:
    """Whether `folder` holds samples and no manifest. False also where that cannot be seen."""
    try:
        names = os.listdir(folder)
    except (OSError, ValueError):
        return False
    return NAME not in names and hold_samples(names)


def entry(about: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """What a manifest says of a file of its folder."""
    files = about.get("files")
    said = files.get(name) if isinstance(files, Mapping) else None
    return said if isinstance(said, Mapping) else {}


def digest_of(about: Mapping[str, Any], name: str = SAMPLES) -> str:
    """SHA-256 of a file of the folder; "" where the manifest does not say it."""
    said = entry(about, name).get("sha256")
    return said if isinstance(said, str) else ""


def ratio_of(folder: Path, about: Mapping[str, Any]) -> float:
    """gear.ratio of the manifest `about` of the run in `folder`. Raises UsageError when it is none."""
    gear = about.get("gear")
    gear = gear if isinstance(gear, dict) else {}
    found = number(gear.get("ratio"))
    if not found > 0.0:
        said = f"is {_short(gear['ratio'])}" if "ratio" in gear else "is missing"
        raise UsageError(f"{folder / NAME}: gear.ratio {said}, expected a number above 0")
    return found


def procedure_of(folder: Path, about: Mapping[str, Any]) -> str:
    """The procedure's name, as files are called. Raises UsageError when it is none."""
    procedure = about.get("procedure")
    if not isinstance(procedure, str) or not procedure:
        said = f"is {_short(procedure)}" if "procedure" in about else "is missing"
        raise UsageError(f"{folder / NAME}: procedure {said}, expected its name")
    return procedure.replace("-", "_")


def of_no_use(folder: Path, about: Mapping[str, Any]) -> list[str]:
    """Why the run in `folder` cannot be analysed, by its manifest alone."""
    said = []
    for need in (ratio_of, procedure_of):
        try:
            need(folder, about)
        except UsageError as error:
            said.append(said_of(folder, error))
    return said


def contents(path: Path) -> bytes:
    """What a small regular file holds. Raises OSError, and ValueError for what is too long to hold."""
    size = regular(path).st_size
    if size > LONGEST:
        raise ValueError(f"{size} bytes long, expected at most {LONGEST}")
    return path.read_bytes()


def parse(data: bytes) -> Any:
    """JSON as files hold it, in strings that can be written again. Raises ValueError, also when nested too deeply."""
    try:
        found = json.loads(data)
    except RecursionError:
        raise ValueError("nested too deeply") from None
    if data.count(b"{") + data.count(b"[") > DEPTH:  # as many as can be in one another: looked at only then
        _refuse_depth(found)
    if b"\\ud" in data.lower() or b"\xed" in data:  # perhaps half a surrogate pair, which no file can hold
        found = json.loads(json.dumps(found, ensure_ascii=False).encode(errors="replace"))
    return found


def _refuse_depth(found: Any) -> None:
    level = [found]
    for _ in range(DEPTH):
        inner = [v.values() if isinstance(v, dict) else v for v in level if isinstance(v, dict | list)]
        level = [value for values in inner for value in values]
        if not level:
            return
    raise ValueError("nested too deeply")


def _refuse_other_kinds(path: Path, found: Manifest) -> None:
    for names, kind, word in ((OBJECTS, dict, "an object"), (STRINGS, str, "text")):
        for name in names:
            if name in found and not isinstance(found[name], kind):
                raise UsageError(f"{path}: {name} is {_short(found[name])}, expected {word}")
    for name, entry in found.get("files", {}).items():
        if not isinstance(entry, dict):
            raise UsageError(f"{path}: files.{name} is {_short(entry)}, expected an object")


def _kind(value: Any) -> str:
    """What JSON it is, in words."""
    match value:
        case None:
            return "null"
        case bool():
            return "true" if value else "false"
        case str():
            return "text"
        case list():
            return "a list"
        case _:
            return "a number"


def _short(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def write(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Put `manifest` in place of the one there: a reader sees the old or the new, never a part. Raises OSError."""
    write_atomic(folder / NAME, json.dumps(manifest, indent=1, ensure_ascii=False).encode() + b"\n")


def update(folder: Path, **changes: Any) -> Manifest:
    """Change some keys; None removes a key. Returns the manifest as it is now. Raises OSError, UsageError."""
    manifest = {k: v for k, v in (as_written(folder) | changes).items() if v is not None}
    write(folder, manifest)
    return manifest


def write_atomic(path: Path, data: bytes) -> None:
    """Write `data` beside `path`, make it safe on disk, then rename. Raises OSError; then, and when it is interrupted,
    `path` is as it was and nothing lies beside it."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with open(part, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
    sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Make a rename or a new file in `folder` survive a power cut. Raises OSError."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextlib.contextmanager
def told(kind: type[HdrigError], what: str) -> Iterator[None]:
    """Turn an OSError into a sentence of `kind`: "<what>: No space left on device"; exit code as in `of_place`."""
    try:
        yield
    except OSError as error:
        raise of_place(kind(f"{what}: {error.strerror or error}"), error) from error


def utc_now() -> str:
    """Now, as manifests and events write it: ISO 8601, UTC, microseconds."""
    return datetime.now(UTC).isoformat(timespec="microseconds")
