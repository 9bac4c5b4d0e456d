"""`result.json`: the figures of one analysis for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.analysis.findings.result import Result
from rig.runfile.manifest import write_atomic

NAME = "result.json"


def as_json(result: Result) -> dict[str, Any]:
    """Everything but the curves; a number that is not finite becomes null. `limits`, `asked`, `former`: see Result."""
    return {
        "schema": "hdrig.result/1",
        "procedure": result.procedure,
        "verdict": str(result.verdict),
        "sentence": result.sentence,
        "rejected": result.rejected,
        "limits": dict(result.limits),
        "asked": finite(result.asked),
        "former": [{"verdict": f.verdict, "limits": dict(f.limits)} for f in result.former],
        "estimates": {
            e.name: {
                "label": e.label,
                "value": finite(e.value),
                "unit": e.unit,
                "ci95": [finite(e.ci95[0]), finite(e.ci95[1])],
                "how": e.how,
                "counts": e.counts,
            }
            for e in result.estimates
        },
        "checks": [{"name": c.name, "passed": c.passed, "sentence": c.sentence} for c in result.checks],
        "cannot": list(result.cannot),
        "tables": {
            name: [{k: finite(v) for k, v in row.items()} for row in rows] for name, rows in result.tables.items()
        },
    }


def finite(value: Any) -> Any:
    """JSON has no NaN: what was not measured is null."""
    if isinstance(value, Mapping):
        return {str(key): finite(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [finite(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_result(folder: Path, result: Result) -> Path:
    """Put `result.json` into `folder`, in place of an older one; its path."""
    path = folder / NAME
    write_atomic(
        path,
        json.dumps(as_json(result), indent=1, ensure_ascii=False, allow_nan=False).encode(errors="replace") + b"\n",
    )
    return path
