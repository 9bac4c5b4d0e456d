"""One result in lines: verdict, figures with unit and interval, what was not met, what it cannot tell."""

from __future__ import annotations

from rig.analysis.findings.result import Result
from rig.analysis.sensors.latch_skew_words import bench_lines
from rig.report.history import told
from rig.report.numbers import estimate


def lines(result: Result, name: str, simulated: bool) -> list[str]:
    """Of the run or campaign called `name`."""
    said = {"MEASURED": "no limit set"}.get(result.verdict, str(result.verdict))
    head = [f"{'SIMULATED ' if simulated else ''}{name}", f"{said}: {result.sentence}"]
    if history := told(result, last=1):
        head.append(history)
    width = max((len(e.label) for e in result.estimates), default=0)
    return [
        *head,
        *(f"  {e.label:{width}s}  {estimate(e.value, e.ci95, e.unit)}" for e in result.estimates),
        *(f"  not met: {check.sentence}" for check in result.checks if not check.passed),
        *(f"  note: {sentence}" for sentence in result.cannot),
        *bench_lines(result),
    ]
