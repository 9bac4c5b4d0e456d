"""Where the runs of a trace come from: their manifests, in the order they were taken, and the software."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.runs.campaign import folders_of_runs
from rig.analysis.tracing.runs.holdout import whole_run
from rig.core.errors import UsageError
from rig.core.numbers import number
from rig.report.numbers import counted, duration
from rig.report.provenance import software
from rig.report.rows import cut, measured, show, table, utc
from rig.report.words import kind
from rig.runfile.manifest import contents, parse
from rig.runfile.origin import with_origin


class RunRow(NamedTuple):
    """One run of the campaign."""

    name: str
    part: str
    procedure: str
    conditions: str
    started: str
    backend: str


@dataclass(frozen=True)
class Provenance:
    """Manifests by run folder, the software that traced, and when (UTC, ISO 8601; "" where it is not said)."""

    manifests: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    traced_with: Mapping[str, Any] = field(default_factory=dict)
    traced_utc: str = ""

    @property
    def backends(self) -> set[str]:
        """What the manifests say their runs were recorded with."""
        return {str(m.get("backend")) for m in self.manifests.values()}

    @property
    def backend(self) -> str | None:
        """What all manifests agree on; None where they do not."""
        said = self.backends
        return said.pop() if len(said) == 1 else None

    @property
    def software(self) -> list[tuple[str, str]]:
        """What recorded and what traced, as rows."""
        recorded = sorted({s for m in self.manifests.values() if (s := software(m))})
        rows = [("Recorded with", ", ".join(recorded) or "unknown")]
        rows.append(("Traced with", software({"software": dict(self.traced_with)}) or "unknown"))
        return [*rows, *([("Traced", utc(self.traced_utc))] if self.traced_utc else [])]

    def facts(self, trace: Trace) -> list[str]:
        """The line below the title."""
        gears = {show(table(m.get("gear")).get("serial")) for m in self.manifests.values()} - {"unknown"}
        ratios = {show(table(m.get("gear")).get("ratio")) for m in self.manifests.values()} - {"unknown"}
        starts = sorted(str(m["started_utc"]) for m in self.manifests.values() if m.get("started_utc"))
        found = [f"Gear {', '.join(sorted(gears))}"] if gears else []
        found += [f"ratio {', '.join(sorted(ratios))}"] if ratios else []
        found += [utc(starts[0])] if starts else []
        neither = trace.read - len({whole_run(name) for name in (*trace.fitted, *trace.held_out)})
        found += [f"{counted(len(trace.fitted), 'run')} fitted", f"{len(trace.held_out)} held out"]
        return [*found, *([f"{neither} neither"] if neither > 0 else [])]

    def rows(self, trace: Trace) -> list[RunRow]:
        """Every run, fitted, held out or neither."""
        part = dict.fromkeys(trace.held_out, "held out") | dict.fromkeys(trace.fitted, "fitted")
        part |= dict.fromkeys(trace.left_out, "left out")
        of = {
            name: self.manifests.get(whole_run(name), {}) for name in (*self.manifests, *part)
        }  # a part is of its run
        order = sorted(of, key=lambda n: (not of[n], str(of[n].get("started_utc") or ""), n))
        return [_row(name, part.get(name, "not used"), of[name]) for name in order]


def provenance(folder: Path, traced_with: Mapping[str, Any], traced_utc: str) -> Provenance:
    """Of the campaign in `folder`; manifests that cannot be read are left out, the trace has said why."""
    found: dict[str, Mapping[str, Any]] = {}
    try:
        places = folders_of_runs(folder)
    except UsageError:  # none of them is left
        places = []
    for place in places:
        try:
            manifest = parse(contents(place / "manifest.json"))
        except (OSError, ValueError):
            continue
        found[place.name] = with_origin(place, table(cut(manifest)))
    return Provenance(found, traced_with, traced_utc)


def _row(name: str, part: str, manifest: Mapping[str, Any]) -> RunRow:
    procedure = str(manifest.get("procedure", "unknown"))
    said = [measured(str(k), v) for k, v in table(manifest.get("conditions")).items() if v is not False and k != "note"]
    seconds = number(manifest.get("duration"))
    length = f", {duration(seconds)}" if seconds == seconds else ""
    return RunRow(
        name,
        part,
        kind(procedure) + length,
        ", ".join(f"{row.name} {row.value}" for row in said),
        utc(manifest["started_utc"]) if manifest.get("started_utc") else "unknown",
        show(manifest.get("backend")),
    )
