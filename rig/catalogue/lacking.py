"""Figures that some of the runs side by side do not have: which run lacks which, and when nothing is left."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rig.catalogue.figures import Figure
from rig.catalogue.row import Row
from rig.core.errors import UsageError

Known = Mapping[str, Figure]  # the figures of one run by name


def shared(known: Sequence[Known]) -> list[str]:
    """Names of the figures that two runs or more have, in the order they come."""
    names = dict.fromkeys(name for one in known for name in one)
    return [name for name in names if sum(name in one for one in known) > 1]


def lacks(found: Sequence[Row], known: Sequence[Known]) -> list[str]:
    """One sentence for each run that was analysed and has not every figure of the others."""
    labels: dict[str, str] = {}
    for one in known:
        labels |= {name: figure.label for name, figure in one.items() if name not in labels}
    said = []
    for row, own in zip(found, known, strict=True):
        absent = [label for name, label in labels.items() if name not in own]
        if own and absent:
            many = "a figure" if len(absent) == 1 else f"{len(absent)} figures"
            said.append(f"{row.path.name} lacks {many} that another has: {'; '.join(absent)}")
    return said


def without_figures(row: Row, own: Known) -> str:
    """Why a run has no figure at all; "" where it has some."""
    if own:
        return ""
    if not (row.path / "result.json").exists():
        return f"{row.path.name} was not analysed (hdrig analyse does so)"
    return f"{row.path.name} has no figures: its report says why"


def refuse_nothing(found: Sequence[Row], known: Sequence[Known]) -> None:
    """Raises UsageError, which says who lacks what, when the first run shares no figure with any other."""
    if any(name in known[0] for one in known[1:] for name in one):
        return
    first, *others = found
    why = [w for row, own in zip(found, known, strict=True) if (w := without_figures(row, own))]
    unlike = [_what(other) for other, own in zip(others, known[1:], strict=True) if own]
    if unlike and known[0]:
        figures = "; ".join(figure.label for figure in known[0].values())
        have = "has" if len(unlike) == 1 else "have"
        why.append(f"{' and '.join(unlike)} {have} no figure of {_what(first)}: {figures}")
    raise UsageError(f"nothing to compare: {'; '.join(why)}")


def _what(row: Row) -> str:
    return f"{row.path.name} ({row.procedure.replace('_', '-') or 'no procedure named'})"
