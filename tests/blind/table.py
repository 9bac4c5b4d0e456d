"""The table of a blind test: rates with their intervals, misses by name, who was taken for whom."""

from __future__ import annotations

from collections import Counter

import numpy as np

from tests.blind.intervals import Rate, rate
from tests.blind.marks import WORTH_A_NAME, Mark

Row = tuple[str, str]


def worth(marks: list[Mark], *kinds: str) -> list[Mark]:
    """Cases of these kinds whose effect is large enough to be named."""
    return [m for m in marks if m.kind in kinds and m.size >= WORTH_A_NAME]


def of_kind(marks: list[Mark], kind: str) -> list[Mark]:
    return [m for m in marks if m.kind == kind]


def rows(marks: list[Mark]) -> list[Row]:
    """What a blind test is asked for, one row each."""
    names = [name for m in marks for name in m.names]
    wrong = [name for m in marks for name in m.wrong]
    clean, outside, pairs = (of_kind(marks, kind) for kind in ("clean", "outside", "pair"))
    ample = [m for m in pairs if m.smallest >= WORTH_A_NAME]
    outside = [m for m in outside if m.size >= WORTH_A_NAME]
    ambiguous = worth(marks, "ambiguous")
    return [
        (f"first name right, textbook form, ≥ {WORTH_A_NAME} × floor", str(firsts(marks, "single"))),
        (f"first name right, another form, ≥ {WORTH_A_NAME} × floor", str(firsts(marks, "single_other"))),
        (f"first name right, one main among many small, ≥ {WORTH_A_NAME} × floor", str(firsts(marks, "crowded"))),
        ("first name right, no repeats / one direction / no torque sensor", str(firsts_of_poorer_plans(marks))),
        ("wrong names among names issued, all cases", str(Rate(len(wrong), len(names)))),
        ("false alarms on clean campaigns", str(rate([bool(m.names) or m.status != CLEAN for m in clean]))),
        ("outside the library: refused", str(rate([m.refused for m in outside]))),
        ("outside the library: coordinate right", str(rate([m.coordinate in m.coordinates for m in outside]))),
        (f"two effects, both ≥ {WORTH_A_NAME} × floor: exactly both", str(rate([m.exact for m in ample]))),
        ("held-out error over floor, before", spread([m.before for m in worth(marks, *NAMED)])),
        ("held-out error over floor, after", spread([m.after for m in worth(marks, *NAMED)])),
        ("parameters: relative error", percent([c.relative_error for m in marks for c in m.compared])),
        ("parameters: inside their 95 % interval", str(rate([c.covered for m in marks for c in m.compared]))),
        (
            "undecidable: truth named or among the rivals, nothing wrong claimed",
            str(rate([m.decent for m in ambiguous])),
        ),
        ("undecidable: called ambiguous, truth among the rivals", str(rate([m.handled for m in ambiguous]))),
        ("undecidable: a wrong name claimed", str(rate([bool(m.wrong) for m in ambiguous]))),
        ("cases without an answer", str(rate([m.status == "no answer" for m in marks]))),
        ("seconds per case", spread([m.seconds for m in marks if m.seconds > 0], "s")),
    ]


CLEAN = "no_missing_effect"
NAMED = ("single", "single_other", "crowded", "pair")


def firsts(marks: list[Mark], kind: str) -> Rate:
    """First names of the complete plan."""
    return rate([m.first_right for m in worth(marks, kind) if m.plan == "complete"])


def firsts_of_poorer_plans(marks: list[Mark]) -> Rate:
    return rate([m.first_right for m in worth(marks, *NAMED) if m.plan != "complete"])


def spread(values: list[float | None], unit: str = "×") -> str:
    there = [value for value in values if value is not None]
    if not there:
        return "not told"
    median, high = np.median(there), np.percentile(there, 90)
    return f"median {median:.2f} {unit}, 90 % below {high:.2f} {unit} ({len(there)} cases)"


def percent(values: list[float]) -> str:
    if not values:
        return "nothing comparable"
    median, high = np.median(values), np.percentile(values, 90)
    return f"median {median:.1%}, 90 % below {high:.0%} ({len(values)} numbers)"


def is_miss(m: Mark) -> bool:
    """Whether a person would want to read about this case."""
    if m.kind == "clean":
        return bool(m.names) or m.status != CLEAN
    if m.kind == "outside":
        return not m.refused or m.coordinate not in m.coordinates
    if m.kind == "ambiguous":
        return not m.decent
    if m.kind == "pair":
        return not m.exact
    return not m.first_right or bool(m.wrong)


def confusion(marks: list[Mark]) -> list[str]:
    """Planted → said, of single cases worth a name, off the diagonal, most frequent first."""
    said = Counter()
    for m in worth(marks, "single", "single_other", "crowded"):
        if not m.first_right:
            said[m.expected[0], m.names[0] if m.names else m.status] += 1
    return [f"| {planted} | {name} | {n} |" for (planted, name), n in said.most_common()]


def markdown(marks: list[Mark], heading: str) -> str:
    """The whole page."""
    lines = [
        f"# Blind test of the tracer: {heading}",
        "",
        f"{len(marks)} simulated campaigns of an independent plant.",
        "",
    ]
    lines += [
        "| what | result (95 % interval) |",
        "|---|---|",
        *(f"| {name} | {value} |" for name, value in rows(marks)),
    ]
    mixed = confusion(marks)
    if mixed:
        lines += ["", "## Taken for something else", "", "| planted | said | cases |", "|---|---|---|", *mixed]
    missed = [m for m in marks if is_miss(m)]
    lines += ["", f"## Misses ({len(missed)})", ""]
    lines += ["| case | kind | plan | hidden | size | said |", "|---|---|---|---|---|---|"]
    for m in sorted(missed, key=lambda m: (m.kind, m.case)):
        hidden = " + ".join(m.hidden) or "nothing"
        lines.append(f"| {m.case} | {m.kind} | {m.plan} | {hidden} | {m.size:.1f} × | {m.answer} |")
    return "\n".join(lines) + "\n"
