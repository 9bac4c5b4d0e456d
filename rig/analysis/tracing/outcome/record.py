"""trace.json: the result for programs, schema hdrig.trace/1; its keys are told in rig/analysis/tracing/REPORT.md."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rig.analysis.tracing.outcome.free_told import free_told
from rig.analysis.tracing.outcome.result import Before, Floor, Trace
from rig.analysis.tracing.outcome.told import meaning, unmoved, why_unmoved
from rig.analysis.tracing.outcome.without import ruled
from rig.model.effect import Parameter
from rig.model.effects import LIBRARY
from rig.runfile.manifest import write_atomic

SCHEMA = "hdrig.trace/1"


def document(trace: Trace) -> dict[str, Any]:
    """The document as plain values; what is not finite is null."""
    found = {
        "schema": SCHEMA,
        "campaign": trace.campaign,
        "simulated": trace.simulated,
        "runs": {
            "fitted": trace.fitted,
            "held_out": trace.held_out,
            "how": trace.held_out_how,
            "read": trace.read,
            "left_out": trace.left_out,
        },
        "noise_floor": {f.channel: _floor(f) for f in trace.floors},
        "baseline": {
            "parameters": _parameters(trace.baseline_after),  # what a program takes for the gear's
            "before_refit": _parameters(trace.baseline),
            "not_moved": _not_moved(trace),
            "cannot_be_told_apart": trace.cannot_be_told_apart,
        },
        "residual": {
            "unexplained": trace.unexplained,
            "lives_in": trace.lives_in,
            "over_floor_before": trace.ratios_before,
            "over_floor_after": trace.ratios_after,
            "over_floor_named": trace.by_names,
            "law": trace.law,
            "curves": [asdict(curve) for curve in trace.added_curves],
            "ripple": [r.document() for r in trace.ripple],
            "mean_drift": [drift.document() for drift in trace.mean_drift],
        },
        "candidates": [asdict(candidate) for candidate in trace.candidates],
        "verdict": asdict(trace.verdict) | {"sentence": ruled(trace), "left_out": trace.left_out},
        "effects": {
            f.effect: {"parameters": _parameters(f.parameters, f.effect), "share_removed": min(f.share, 1.0)}
            for f in trace.effects
        },
        "before": _errors(trace.before),
        "after": _errors(trace.after),
        "free_simulation": free_told(trace),
        "next_run": asdict(trace.next_run) if trace.next_run else None,
        "notes": trace.notes,
        "cannot": trace.cannot,
    }
    return dict(_plain(found))


def write_trace(path: Path, trace: Trace) -> Path:
    """Write trace.json. A file is replaced whole or not at all; what stands for something else, /dev/stdout or a pipe,
    is written to. Raises OSError."""
    text = (json.dumps(document(trace), ensure_ascii=False, indent=1) + "\n").encode(errors="replace")
    if path.is_symlink() or (path.exists() and not path.is_file()):
        path.write_bytes(text)
    else:
        write_atomic(path, text)
    return path


def _floor(f: Floor) -> dict[str, Any]:
    known = {"ci95": f.ci95} if f.ci95 else {}
    return {"rms": f.rms, **known, "unit": f.unit, "how": f.how}


def _parameters(found: Sequence[Parameter], effect: str = "") -> dict[str, Any]:
    """By name, with what they are; without `effect` those of the baseline."""
    known = LIBRARY.get(effect)
    gloss = known.gloss if known else meaning
    return {
        p.name: {"value": p.value, "ci95": p.ci95, "unit": p.unit}
        | ({"meaning": gloss(p.name)} if known or not effect else {})
        for p in found
    }


def _not_moved(trace: Trace) -> dict[str, Any]:
    effects = [f.effect for f in trace.effects]
    return {
        "parameters": unmoved(trace.baseline, trace.baseline_after),
        "because": why_unmoved(trace.baseline, trace.baseline_after, effects),
    }


def _errors(errors: Before) -> dict[str, Any]:
    return {"per_run": {name: asdict(e) for name, e in errors.per_run.items()}, "pooled": asdict(errors.pooled)}


def _plain(value: Any) -> Any:
    """Numbers JSON can hold, whole digits that mean something."""
    match value:
        case dict():
            return {str(k): _plain(v) for k, v in value.items()}
        case list() | tuple():
            return [_plain(v) for v in value]
        case bool() | str() | int() | None:
            return value
        case _:
            number = float(value)
            return float(f"{number:.10g}") if math.isfinite(number) else None
