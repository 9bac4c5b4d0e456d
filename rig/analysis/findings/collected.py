"""What an analysis collects on its way to a Result: each part of it adds what it found and what it could not."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from rig.analysis.findings.limits import judge
from rig.analysis.findings.result import Array, Check, Estimate, Part, Result, Verdict

WHY_REJECTED = ("stuck_share", "speed_scatter", "hunting_frequency")  # they describe the run and do count


def pm(value: float, half: float, unit: str) -> str:
    """ "0.3197 ± 0.0004 N·m": the half width in two significant digits at most, the value to as many decimals."""
    if not (math.isfinite(value) and math.isfinite(half) and half > 0.0):
        return f"{value:.4g} {unit}"
    places = max(1 - math.floor(math.log10(half)), 0)
    return f"{value:.{places}f} ± {half:.{places}f} {unit}"


def true_minus(text: str) -> str:
    """`text` with the hyphens before numbers made minus signs."""
    return re.sub(r"(?<![\w.\-])-(?=\d)", "−", text)


@dataclass
class Findings:
    """A Result in the making."""

    estimates: list[Estimate] = field(default_factory=list)
    checks: list[Check] = field(default_factory=list)
    cannot: list[str] = field(default_factory=list)
    tables: dict[str, list[dict[str, float | str]]] = field(default_factory=dict)
    curves: dict[str, Array] = field(default_factory=dict)
    sentence: str = ""  # the headline
    rejected: str = ""  # why the run must not be believed, "" when it may
    inconclusive: str = ""  # why the run settles nothing, "" when it does
    broken: str = ""  # why the samples are not those that were recorded, "" when they are
    beyond: str = ""  # why a torque cannot be what its column says, "" when it can
    believed: int = 0  # how many estimates were there when it was rejected: those are about the run, not the gear

    def reject(self, why: str) -> None:
        """The figures added from here on are shown and do not count."""
        self.rejected, self.believed = why, len(self.estimates)

    def figure(
        self,
        name: str,
        label: str,
        value: float,
        unit: str,
        half: float,
        how: str,
        *parts: Part,
        over: tuple[float, float] | None = None,
    ) -> None:
        """Add an estimate given as value ± half width of its 95 % interval, what that is made of, and the torques that
        it is `over` where it is not over all."""
        self.estimates.append(Estimate(name, label, value, unit, (value - half, value + half), how, parts, over=over))

    def exact(self, name: str, label: str, value: float, unit: str, how: str) -> None:
        """Add a figure without an interval: a count is exact, anything else has none that this run could show."""
        ci95 = (value, value) if unit == "1" else (float("nan"), float("nan"))
        self.estimates.append(Estimate(name, label, value, unit, ci95, how))

    def curve(self, **arrays: Array | None) -> None:
        """Add curves; `ke__fit` stands for "ke.fit". None is left out: an absent curve is an absent figure."""
        for key, array in arrays.items():
            if array is not None:
                self.curves[key.replace("__", ".", 1)] = np.asarray(array, dtype=np.float64)


def conclude(found: Findings, procedure: str, manifest: Mapping[str, Any]) -> Result:
    """The verdict and its sentence.

    `manifest["limits"]`, optional: as `findings.limits.judge` takes them. A rejected run is INCONCLUSIVE whatever its
    figures: the gear may be sound and a sensor turned round. A run that did not end as planned cannot PASS; one whose
    samples are not those recorded, or not in the unit they say, neither PASS nor FAIL by a limit.
    """
    judged = judge(found.estimates, manifest.get("limits") or {})
    found.checks += judged.checks
    said = (found.sentence, judged.outside, judged.unsettled)
    verdict, sentence, estimates = judged.verdict, " ".join(filter(None, said)), found.estimates
    status = str(manifest.get("status", "completed"))
    if status not in ("completed", "imported"):
        reason = manifest.get("exit_reason")
        text = f"The run is {status}" + (f" ({reason})" if reason else "") + ": the figures are from what was recorded."
        found.checks.append(Check("run_complete", False, text))
        sentence = f"{text} {sentence}"
        found.inconclusive = found.inconclusive or text
    if not any(np.isfinite(e.value) for e in estimates):
        found.inconclusive = found.inconclusive or "Nothing could be measured."
    for name, doubt in (("as_recorded", found.broken), ("within_range", found.beyond)):
        if doubt:
            found.checks.append(Check(name, False, doubt))
            verdict, sentence = Verdict.INCONCLUSIVE, f"{doubt} {sentence}"
    if found.inconclusive and verdict in (Verdict.PASS, Verdict.MEASURED):
        verdict = Verdict.INCONCLUSIVE
    if found.rejected:
        verdict, sentence = Verdict.INCONCLUSIVE, f"{found.rejected} Figures are shown but do not count: {sentence}"
        doubtful = estimates[found.believed :]
        estimates = estimates[: found.believed] + [
            e if e.name in WHY_REJECTED else replace(e, how=f"Rejected run. {e.how}", counts=False) for e in doubtful
        ]
    return Result(
        procedure=procedure,
        verdict=verdict,
        sentence=true_minus(sentence),
        estimates=tuple(replace(e, how=true_minus(e.how)) for e in estimates),
        checks=tuple(replace(c, sentence=true_minus(c.sentence)) for c in found.checks),
        cannot=tuple(true_minus(s) for s in found.cannot),
        tables=found.tables,
        curves=found.curves,
        limits=judged.limits,
        rejected=bool(found.rejected),
    )
