"""MCAP: one JSON message a sample on one topic, which Foxglove and PlotJuggler both plot as they are.

A batch of samples in one message would be a quarter of the size, and neither plots the inside of one.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa
from mcap.writer import Writer

from rig.core.errors import UsageError
from rig.runfile.run import Run

TOPIC = "/rig/sample"
LATEST = 1e12  # s; far beyond what the check in ns allows, and still an integer of it


def write(run: Run, path: Path) -> None:
    """Write every measured channel of `run`; a value that was not measured is left out of its message.

    Log time is UTC where the run says when it started, else time since then. Raises UsageError for a run without `t`,
    or with a time that no message can carry.
    """
    if not run.has("t"):
        raise UsageError(f"{run.name} has no t: an MCAP message needs its time; csv and hdf5 do not")
    with open(path, "wb") as file:
        writer = Writer(file)
        writer.start(library="hdrig")
        schema = writer.register_schema("hdrig.Sample", "jsonschema", json.dumps(_schema(run)).encode())
        said = {"simulated": "true" if run.simulated else "false"}
        channel = writer.register_channel(TOPIC, "json", schema, said)
        for number, (at, message) in enumerate(_messages(run)):
            writer.add_message(channel, at, json.dumps(message).encode(), at, sequence=number & 0xFFFFFFFF)
        writer.add_metadata("hdrig", {**said, "procedure": run.procedure, "manifest": json.dumps(run.manifest)})
        writer.finish()


def _schema(run: Run) -> dict[str, Any]:
    """JSON schema of one message; units stand in the descriptions, the only place it has for them."""
    fields = {}
    for name in _names(run):
        kind = "integer" if pa.types.is_integer(run.samples.layout.field(name).type) else "number"
        fields[name] = {"type": kind, "description": f"[{run.unit(name)}] {run.meaning(name)}", "unit": run.unit(name)}
    title = "SIMULATED sample" if run.simulated else "sample"
    return {"type": "object", "title": title, "properties": fields}


def _names(run: Run) -> list[str]:
    return [name for name in run.channels if run.has(name)]


def _messages(run: Run) -> Iterator[tuple[int, dict[str, Any]]]:
    """(log time [ns], values) of each sample that has a time."""
    names, start = _names(run), _start_ns(run)
    for batch in run.samples.batches():
        for values in zip(*(batch.column(name).to_pylist() for name in names), strict=True):
            message = {name: value for name, value in zip(names, values, strict=True) if value is not None}
            if math.isfinite(message.get("t", math.nan)):
                yield _log_time(run, start, message["t"]), message


def _log_time(run: Run, start: int, t: float) -> int:
    """`t` s after `start` in ns. Raises UsageError for what 64 bits without a sign cannot say."""
    at = start + round(t * 1e9) if abs(t) < LATEST else -1
    if not 0 <= at < 2**64:
        raise UsageError(f"{run.name} has a sample at t = {t:g} s: an MCAP message lies between 1970 and 2554")
    return at


def _start_ns(run: Run) -> int:
    started = run.started
    return round(started.timestamp() * 1e6) * 1000 if started else 0
