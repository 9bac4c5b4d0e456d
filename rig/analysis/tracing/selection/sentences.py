"""What a verdict says in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.fit.channels import CHANNEL, WHOLE
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.thresholds import EXPLAINED
from rig.model.effects import LIBRARY

HOUSING, SPRING = "support_compliance", "nonlinear_stiffness"
OF_EITHER: Final = "a spring that is not linear (the gear's, or the housing's mount: no channel tells which)"
FINELY: Final = 2.0  # floors, up to which a tenth is as much as what is said to fall
FORETELLS_NOTHING: Final = 0.05  # of the excess: so much is chance


def lacks(names: Sequence[str], before: float, after: float, of: str = "worst") -> str:
    """Which effects the model lacks, and what they do to a channel's held-out RMS over floor."""
    them, first = "them" if len(names) > 1 else "it", f"{before:.{1 if before > FINELY else 2}f}"
    return (
        f"The model lacks {in_words(names)}: with {them} the {of} held-out error of a channel falls from {first} "
        f"to {after:.2f} times the floor."
    )


def nothing(read: Sequence[str], after: float, little: bool) -> str:
    """That nothing is missing in the channels that were `read`, by letter: of the others nothing is said, nor where
    the runs show `little` of what they do."""
    leaves = f"the baseline leaves {after:.2f} times the floor on held-out runs."
    if after > EXPLAINED:
        leaves += " So few rows may leave as much by chance, or by friction that differs from run to run."
    unread = [CHANNEL[c].name for c in WHOLE if c not in read]
    missing = "Nothing that these runs could show is missing" if little else "Nothing is missing"
    if not read or not unread:
        return f"{missing}: {leaves}"
    of = _listed([CHANNEL[c].name for c in read])
    return f"{missing} in the {of}: {leaves} Of the {_listed(unread)} these runs show nothing."


def of_the_rest(best: Home, total: float) -> str:
    """How much is left, in floors, and where it lives."""
    where = best.said or best.coordinate.replace("_", " ")
    if best.share < FORETELLS_NOTHING:
        return (
            f"What is left is {total:.1f} times the floor and follows no effect of the library; no coordinate that was "
            f"tried foretells it, {where} comes nearest."
        )
    return (
        f"What is left is {total:.1f} times the floor and follows no effect of the library; it lives in "
        f"{where} ({min(best.share, 1.0):.0%} of it)"
        + (f", order {best.order:.2f}" if best.order else "")
        + (f", {best.frequency_hz:.3g} Hz" if best.frequency_hz else "")
        + "."
    )


def how_often(home: Home) -> str:
    """In words; seconds where it takes some."""
    hz = home.frequency_hz or 0.0
    return f"every {1 / hz:.3g} s of the campaign's clock" if hz < 1 else f"{hz:.2f} times a second, whatever the speed"


def in_words(names: Sequence[str]) -> str:
    """Effects, each with what it is in short; last a spring whose owner no channel tells."""
    of_whom = HOUSING in names
    told = [_name(name) for name in names if not (of_whom and name == SPRING)]
    return _listed(told + [OF_EITHER] * (of_whom and SPRING in names))


def _name(name: str) -> str:
    return f"{name.replace('_', ' ')} ({LIBRARY[name].in_short})"


def _listed(words: Sequence[str]) -> str:
    """a, b and c."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
