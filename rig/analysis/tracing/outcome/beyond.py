"""Held-out runs beyond what the fitted ones cover: an error there may be that nothing told the model more.

A fit to slow runs alone says next to nothing of damping and inertia; what it then foretells at 400 rpm is a guess, and
what that guess misses is no effect of the gear.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.answer import Status, Verdict
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.outcome.honest import in_words, left_open
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.thresholds import ALONE, MISSING
from rig.core.units import RPM
from rig.model.effect import Array, Parameter

FURTHER: Final = 1.3  # of the speeds and torques fitted: up to there a law is taken on
LEAST: Final = 2.0  # N·m beyond the torques fitted: less is a motor that starts
NAMED: Final = 3  # runs


@dataclass(frozen=True)
class Range:
    """Mean speeds of the motor [rpm] of runs that turn freely, and torques [N·m], least and largest; nan where there
    are none."""

    speed: tuple[float, float]
    torque: tuple[float, float]


@dataclass(frozen=True)
class Beyond:
    """Held-out runs outside the range of the fitted ones, and the parameters these do not determine."""

    fitted: tuple[str, ...]
    held_out: int
    outside: tuple[int, ...]
    names: tuple[str, ...]  # of the same
    covered: Range
    asked: Range  # by them, of what lies outside
    open: tuple[Parameter, ...]

    def sentence(self) -> str:
        """For people."""
        said = (
            f"{len(self.outside)} of {self.held_out} held-out runs ({_some(self.names)}) "
            f"{'lies' if len(self.outside) == 1 else 'lie'} outside what the "
            f"{len(self.fitted)} fitted runs ({_some(self.fitted)}) cover ({'; '.join(self._what())})"
        )
        more = any(len(names) > NAMED for names in (self.names, self.fitted))
        listed = " All runs stand in the report's list of runs and under `runs` in trace.json." if more else ""
        if not self.open:
            return f"{said}.{listed}"
        return (
            f"{said}, and the fitted runs do not determine {in_words(self.open)}, which no gear has below zero.{listed}"
        )

    def _what(self) -> list[str]:
        covered, asked, out = self.covered, self.asked, []
        if np.isfinite(asked.speed[0]):
            out.append(f"mean motor speed {_both(covered.speed, asked.speed, 'rpm')}")
        if np.isfinite(asked.torque[0]):
            out.append(f"shaft torque, but for a hundredth at each end, {_both(covered.torque, asked.torque, 'N·m')}")
        return out


def _some(names: Sequence[str]) -> str:
    """The first of them, and how many more: the page lists every run, and `runs` in trace.json."""
    more = len(names) - NAMED
    return ", ".join(names[:NAMED]) + (f" and {more} more" if more > 0 else "")


def _both(covered: tuple[float, float], asked: tuple[float, float], unit: str) -> str:
    fitted, held = (_range(lo, hi, unit) if np.isfinite(lo) else "none" for lo, hi in (covered, asked))
    return f"{fitted} fitted, {held} there"


def _range(low: float, high: float, unit: str) -> str:
    least, most = f"{low:.3g}", f"{high:.3g}"
    return f"{least} {unit}" if least == most else f"{least} to {most} {unit}"


def beyond(p: Prepared, baseline: Sequence[Parameter]) -> Beyond | None:
    """None where every held-out run lies within what was fitted."""
    fitted, held = [p.eq.runs[i] for i in p.split.fitted], p.held_out.runs
    covered = reach(fitted)
    faster = [i for i in held if _turns_outside(p.eq.runs[i], covered)]
    harder = [i for i in held if _is_loaded_outside(p.eq.runs[i], covered)]
    outside = tuple(i for i in held if i in {*faster, *harder})
    if not outside:
        return None
    asked = Range(reach([p.eq.runs[i] for i in faster]).speed, reach([p.eq.runs[i] for i in harder]).torque)
    names, far = tuple(run.name for run in fitted), tuple(p.eq.runs[i].name for i in outside)
    told = left_open([q for q in baseline if q.name != "B_sp"])  # which filters that lag make of either sign
    return Beyond(names, len(held), outside, far, covered, asked, told)


def reach(runs: Sequence[Recording]) -> Range:
    """Of some runs; (nan, nan) of speeds where none turns freely, of torques where none was measured."""
    speeds = [run.turning / RPM for run in runs if not run.locked]
    ends = np.array([t for run in runs if (t := _torques(run)) is not None])
    torque = (float(ends[:, 0].min()), float(ends[:, 1].max())) if ends.size else (np.nan, np.nan)
    return Range((min(speeds), max(speeds)) if speeds else (np.nan, np.nan), torque)


def _torques(run: Recording) -> tuple[float, float] | None:
    """Least and largest torque of a run without its peaks; None where none was measured."""
    x = np.concatenate([p.torque for p in run.pieces])
    x = x[np.isfinite(x)]
    return (float(np.percentile(x, 1)), float(np.percentile(x, 99))) if x.size and "tau_l" in run.has else None


def _turns_outside(run: Recording, covered: Range) -> bool:
    slow, fast = covered.speed
    return not run.locked and not slow / FURTHER <= run.turning / RPM <= fast * FURTHER  # where none is known too


def _is_loaded_outside(run: Recording, covered: Range) -> bool:
    (low, high), torques = covered.torque, _torques(run)
    if torques is None or not np.isfinite(low):
        return False
    margin = max(LEAST, (FURTHER - 1) * (high - low) / 2)
    return torques[0] < low - margin or torques[1] > high + margin


def undecided(
    p: Prepared, conclusion: Conclusion, after: Mapping[Key, Array], out: Beyond | None
) -> tuple[Conclusion, bool]:
    """The conclusion; where what is left stands in runs outside the fitted range alone, that nothing can be said of it,
    and False."""
    if out is None:
        return conclusion, True
    inside = {key: e for key, e in after.items() if key[0] not in out.outside}
    one = MISSING if conclusion.verdict.effects else ALONE
    guessed = conclusion.home is not None and conclusion.home.coordinate != "time_periodic"
    if conclusion.verdict.status is not Status.UNKNOWN or not guessed or (inside and p.held_out.loud(inside, one)):
        return replace(conclusion, cannot=(*conclusion.cannot, out.sentence())), True
    total, _ = p.held_out.worst(after)
    sentence = (
        f"Not decided: the held-out runs are {total:.1f} times the floor off, but {out.sentence()} Hold out some runs "
        "of every speed and load, and fit the others."
    )
    verdict = Verdict(Status.AMBIGUOUS, (), (), None, None, None, sentence)
    return replace(conclusion, verdict=verdict, home=None, lives_in=(), next_run=None), False
