"""--limit NAME=VALUE: what a run's figures are judged against; PASS, FAIL or INCONCLUSIVE instead of "no limit set"."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

from rig.core.errors import UsageError
from rig.core.few import few
from rig.core.nearest import nearest
from rig.core.procedure import Procedure

FORM = (
    "expected NAME=UPPER, NAME=LOWER.. or NAME=LOWER..UPPER, in the figure's unit or with a space and another, for "
    "example 'peak-to-peak=60 arcsec' or 'K1=7000..'"
)

TOLD = 8  # names in a sentence
NONE = "none"  # lifts a limit


def limit_argument(parser: argparse.ArgumentParser) -> None:
    """--limit, as often as there are limits."""
    parser.add_argument(
        "--limit",
        action="append",
        default=[],
        dest="limits",
        metavar="NAME=LIMIT",
        help="judge a figure: at most 'peak-to-peak=60 arcsec', at least 'K1=7000..', between 'C_2=30..40'; names: "
        "peak-to-peak, C_2, K1, hysteresis-loss, friction, or as in result.json; without a unit in the figure's, an "
        "angle also in arcsec, arcmin, deg, rad or mrad; of several runs it judges those made for the figure; a run "
        "keeps it when it is analysed again, beside limits on other figures, until another one of the same name or "
        "'NAME=none' is given",
    )


def limits_of(assignments: Sequence[str]) -> dict[str, Any]:
    """What --limit says, as a manifest's `limits` has it, None for one that is lifted. Raises UsageError: for a name
    that no analysis gives a figure of, a unit that is not one of that figure, a limit below zero of what never is;
    nothing is moved or written by then.
    """
    limits: dict[str, Any] = {}
    for assignment in assignments:
        word, equals, text = (part.strip() for part in assignment.partition("="))
        if not (word and equals):
            raise UsageError(f"--limit '{assignment}': {FORM}")
        name = _figure(assignment, word)
        if name in limits:
            raise UsageError(f"--limit '{assignment}': {word} was given a limit before; expected one for each figure")
        limits[name] = None if text == NONE else _bounds(assignment, text)
        if limits[name] is not None:
            _refuse_order(assignment, word, name)
            _refuse_senseless(assignment, word, name, limits[name])
    return limits


def refuse_unanswerable(kind: type[Procedure], called: str, limits: Mapping[str, Any]) -> None:
    """Raises UsageError when a run of `kind`, `called` so, gives no figure to judge, or none of those asked about."""
    if limits and kind.answers:
        raise UsageError(
            f"--limit: a {called} run says what it found in a sentence and gives no figure to limit; expected no limit"
        )
    refuse_not_given(kind.name, called, limits)


def refuse_not_given(procedure: str, called: str, limits: Mapping[str, Any]) -> None:
    """Raises UsageError when a run of `procedure`, as manifests name it, is not made for a figure it is to be judged
    by; people call it `called`."""
    if not limits:
        return
    from rig.analysis.findings.figure_names import figures_of, is_run_for

    given = figures_of(procedure)
    for name in limits:
        if given and not is_run_for(procedure, name):
            raise UsageError(f"--limit: a {called} run gives no figure {name}; expected one of {few(given, TOLD)}")


def refuse_absent(have: Sequence[str], limits: Mapping[str, Any]) -> None:
    """Raises UsageError when a run that has figures lacks one it is to be judged by; one without any is for the
    analysis to tell of, which knows why."""
    for name in limits:
        if have and name not in have:
            like = [one for one in have if one.rpartition("_")[0] == name.rpartition("_")[0]]
            raise UsageError(f"--limit: this run has no figure {name}; expected one of {few(like or have, TOLD)}")


def _figure(assignment: str, word: str) -> str:
    """The estimate `word` stands for; C_4 is the amplitude of order 4."""
    from rig.analysis.findings.figure_names import FIGURES, unit_of
    from rig.catalogue.figures import WORDS, names_of

    name = re.sub(r"^[Cc]_(\d+)$", r"fourier_amplitude_\1", names_of(word)[0])
    if unit_of(name) is not None:
        return name
    said = nearest(word, {*WORDS, *FIGURES})
    if not said.startswith("did"):  # sixty names are no answer
        said = f"expected {', '.join(WORDS)}, or the name of a figure as in result.json"
    raise UsageError(f"--limit '{assignment}': no figure is called '{word}'; {said}")


def _refuse_senseless(assignment: str, word: str, name: str, bounds: Mapping[str, Any]) -> None:
    from rig.analysis.findings.conversion import factor, others
    from rig.analysis.findings.figure_names import may_be_negative, unit_of

    wanted = unit_of(name) or "1"
    unit = bounds.get("unit", wanted)
    numbers = [bounds[key] for key in ("lower", "upper") if key in bounds]
    said = f"{' to '.join(f'{number:g}' for number in numbers)}{'' if unit == '1' else f' {unit}'}"
    if not math.isfinite(factor(unit, wanted)):
        raise UsageError(
            f"--limit '{assignment}': {said} is no size of {word}, for '{unit}' is no unit of it; expected a number in "
            f"{'no unit' if wanted == '1' else others(wanted)}"
        )
    if min(numbers) < 0 and not may_be_negative(name):
        least = "0" if wanted == "1" else f"0 {wanted}"
        raise UsageError(f"--limit '{assignment}': {said}, and {word} is never below zero; expected {least} or more")


def _refuse_order(assignment: str, word: str, name: str) -> None:
    """Raises UsageError for an order whose amplitude is no figure of any run."""
    from rig.analysis.findings.figure_names import SHOWN_ORDERS

    order = name.removeprefix("fourier_amplitude_")
    if order != name and order not in map(str, SHOWN_ORDERS):
        orders = ", ".join(f"C_{n}" for n in SHOWN_ORDERS)
        raise UsageError(f"--limit '{assignment}': no run has a figure {word}; of the orders expected one of {orders}")


def _bounds(assignment: str, text: str) -> dict[str, Any]:
    numbers, _, unit = text.partition(" ")
    low, both, high = numbers.partition("..")
    said = {"lower": low, "upper": high} if both else {"upper": numbers}
    bounds: dict[str, Any] = {key: _number(assignment, number) for key, number in said.items() if number}
    if not bounds:
        raise UsageError(f"--limit '{assignment}': {FORM}")
    if list(bounds.values()) != sorted(bounds.values()):
        raise UsageError(f"--limit '{assignment}': the lower end {low} lies above the upper end {high}; {FORM}")
    return bounds | ({"unit": unit.strip()} if unit else {})


def _number(assignment: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise UsageError(f"--limit '{assignment}': '{text}' is not a number; {FORM}")
    return value
