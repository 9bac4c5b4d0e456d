"""The verdicts a run had before it was judged again: kept in `result.json`, told on the page and at the terminal."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.analysis.findings.result import Former, Result
from rig.report.record import NAME
from rig.runfile.manifest import contents, parse


def with_former(folder: Path, result: Result) -> Result:
    """`result` with what stands in `folder`/result.json as its history; nothing of a file that cannot be read.

    The verdict there joins its own history unless verdict and limits are still the same.
    """
    try:
        there = parse(contents(folder / NAME))
    except (OSError, ValueError):
        return result
    there = there if isinstance(there, Mapping) else {}
    listed = there.get("former")
    past = [f for one in (listed if isinstance(listed, list) else []) if (f := _former(one)) is not None]
    last = _former(there)
    if last is not None and last != Former(str(result.verdict), dict(result.limits)):
        past.append(last)
    return dataclasses.replace(result, former=tuple(past))


def asked_before(*folders: Path) -> Mapping[str, Any]:
    """The limits by which the result in the first of `folders` that has one was judged, as they were set; none where
    nothing says."""
    for folder in folders:
        try:
            there = parse(contents(folder / NAME))
        except (OSError, ValueError):
            continue
        asked = there.get("asked") if isinstance(there, Mapping) else None
        return asked if isinstance(asked, Mapping) else {}
    return {}


def told(result: Result, last: int = 0) -> str:
    """What the verdict was, by which limit, and what it is now; "" of a run that was judged in one way only.

    Of a long history `last` gives the newest so many, 0 all of it.
    """
    if not result.former:
        return ""
    before = ", then ".join(ruled(f.verdict, f.limits) for f in result.former[-last:])
    return f"judged before: {before}; now {ruled(str(result.verdict), result.limits)}"


def ruled(verdict: str, limits: Mapping[str, str]) -> str:
    """ "FAIL by Kinematic error, peak to peak at most 60 arcsec"."""
    said = {"MEASURED": "no limit set"}.get(verdict, verdict)
    return f"{said} by {' and '.join(limits.values())}" if limits else said


def _former(entry: Any) -> Former | None:
    """An entry of `former`, or the file itself, that says it as we do; None otherwise."""
    if not isinstance(entry, Mapping) or not isinstance(entry.get("verdict"), str):
        return None
    limits = entry.get("limits")
    if not isinstance(limits, Mapping):  # written before limits were kept: each has a check that says it
        limits = {c["name"]: c["sentence"].rstrip(".") for c in _checks(entry) if c["name"].startswith("limit_")}
    return Former(entry["verdict"], {str(name): str(words) for name, words in limits.items()})


def _checks(entry: Mapping[str, Any]) -> list[Mapping[str, str]]:
    listed = entry.get("checks")
    checks = [c for c in (listed if isinstance(listed, list) else []) if isinstance(c, Mapping)]
    return [c for c in checks if isinstance(c.get("name"), str) and isinstance(c.get("sentence"), str)]
