"""A disc that hung on the load in some runs: what their manifests declare of J_l above the least of all.

One rig in one assembly has one inertia, and one number is fitted. With a disc added it has two, known apart by more
than the number itself: what a catalogue says of the disc is good to a per cent. So the disc is taken as declared, and
what hangs there in all runs is found.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.mixed import SAME
from rig.analysis.tracing.runs.recording import Recording

MOST: Final = 3.0  # times what all have: a larger disc is believed only where a torque shows it
SLIDES: Final = 1 - 1e-9  # of a direction that is low-passed
FEWEST: Final = 50  # rows
READ: Final = frozenset({"theta_l", "tau_l", "t"})


def with_discs(runs: Sequence[Recording]) -> tuple[list[Recording], str]:
    """`runs` with what was added to each, and a sentence on it, "" where the manifests declare one J_l, or the shaft
    torque tells that it is one."""
    declared = [run.declared.get("J_l") for run in runs]
    known = [J for J in declared if J is not None]
    if not known or len(known) < len(runs) or max(known) <= SAME * min(known):
        return list(runs), ""
    least = min(known)
    bare = [run for run, J in zip(runs, known, strict=True) if SAME * least >= J]
    added = {J for J in known if SAME * least < J}
    shown = {J: _more(bare, [run for run, other in zip(runs, known, strict=True) if other == J]) for J in added}
    if not all(_is_shown(J - least, more, least) for J, more in shown.items()):
        return list(runs), ""
    made = [replace(run, added=J - least if J in added else 0.0) for run, J in zip(runs, known, strict=True)]
    said = ", ".join(f"{J - least:.4g}" for J in sorted(added))
    named = [run.name for run in made if run.added]
    return made, (
        f"The manifests declare more J_l in {len(named)} runs ({', '.join(named)[:80]}) than the {least:.4g} kg·m² of "
        f"the others: {said} kg·m² more is taken for a disc that was added there, and the J_l told is without it."
    )


def _is_shown(disc: float, more: float | None, least: float) -> bool:
    """Whether `more` inertia is nearer to that of the `disc` than to none; of one that nothing shows, whether it is no
    slip of the decimal point."""
    return disc < MOST * least if more is None else abs(more - disc) < abs(more)


def _more(bare: Sequence[Recording], others: Sequence[Recording]) -> float | None:
    """By how much the inertia that turns with `others` is larger, kg·m², as their shaft torques show; None where they
    show nothing."""
    seen = [_inertia(of) for of in (bare, others)]
    if seen[0] is None or seen[1] is None:
        return None
    return seen[1] - seen[0]


def _inertia(runs: Iterable[Recording]) -> float | None:
    """kg·m² of the load of all `runs` by its own equation in each, weighted by what each tells."""
    told = [one for run in runs if not run.locked and run.has >= READ and (one := _of_one(run)) is not None]
    weight = sum(1 / variance for _, variance in told)
    return sum(J / variance for J, variance in told) / weight if told else None


def _of_one(run: Recording) -> tuple[float, float] | None:
    """J_l and its variance, by least squares over rows in which friction has one sign."""
    f = run.smoother
    parts = [(f(p.tau_l + p.tau_ext), f(p.theta_l, 2), f(p.theta_l, 1), f(p.way)) for p in run.pieces]
    y, alpha, omega, way = (np.concatenate(column) for column in zip(*parts, strict=True))
    slides = (np.abs(way) > SLIDES) & np.isfinite(y + alpha)
    z = np.stack([alpha, omega, way, np.ones_like(way)], 1)[slides]
    if len(z) < FEWEST:
        return None
    gram = np.linalg.pinv(z.T @ z)
    c = gram @ z.T @ y[slides]
    variance = float(np.mean((y[slides] - z @ c) ** 2)) * float(gram[0, 0])
    return (float(c[0]), variance) if variance > 0.0 else None
