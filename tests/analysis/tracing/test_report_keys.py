"""rig/analysis/tracing/REPORT.md names every key that trace.json has, with a unit and a meaning, and no other."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import rig
from rig.analysis.tracing.outcome.mean_drift import MeanDrift
from rig.analysis.tracing.outcome.record import document
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.outcome.ripple import KEYS, Ripple
from tests.report.trace import made_up

PAGE = Path(rig.__file__).parent / "analysis" / "tracing" / "REPORT.md"
LINE = re.compile(r"^\| `(?P<key>[^`]+)` \| (?P<unit>[^|]+) \| (?P<meaning>[^|]+) \|$", re.MULTILINE)
ROWS = {m["key"]: (m["unit"].strip(), m["meaning"].strip()) for m in LINE.finditer(PAGE.read_text("utf-8"))}
IN_ITS_NAME = {"_arcsec": "arcsec", "_hz": "Hz", "_Nm": "N·m"}


def rippled() -> Trace:
    """One with a channel missing, a run that was left out and a law without a name."""
    ripple = Ripple("tau_m", 2, 8, 0.01, 1e-3, 1e-6, (1e-3, 1e-4), (0.01, 0.002), dict.fromkeys(KEYS, 1e-7))
    drift = MeanDrift("tau_l", 0.02, 0.001, 9)
    return replace(
        made_up.unknown(),
        ripple=(ripple,),
        mean_drift=(drift,),
        read=5,
        left_out=("torn",),
        law=("The spring gives more.",),
    )


TRACES = {name: make() for name, make in made_up.ALL.items()} | {"rippled": rippled()}


def leaves(value: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Paths to what is neither object nor list; an entry of a list has the name of the list with [] behind it."""
    match value:
        case dict():
            for name, inner in value.items():
                yield from leaves(inner, (*path, name))
        case list():
            for inner in value:
                yield from leaves(inner, (*path[:-1], f"{path[-1]}[]"))
        case _:
            yield path


def fits(key: str, path: tuple[str, ...]) -> bool:
    parts = key.split(".")
    return len(parts) == len(path) and all(p.startswith("<") or p == q for p, q in zip(parts, path, strict=True))


def whole(path: tuple[str, ...]) -> bool:
    """Whether an object stands here that is null: its keys are told, not it."""
    return any(key.startswith(f"{'.'.join(path)}.") for key in ROWS)


def test_the_page_is_read_as_it_stands() -> None:
    lines = [line for line in PAGE.read_text("utf-8").splitlines() if line.startswith("| `")]
    assert len(ROWS) == len(lines) > 60
    assert all(unit and len(meaning) > 2 for unit, meaning in ROWS.values())


@pytest.mark.parametrize("name", TRACES)
def test_every_key_that_is_written_is_told_once(name: str) -> None:
    for path in leaves(document(TRACES[name])):
        told = [key for key in ROWS if fits(key, path)]
        assert len(told) == 1 or (not told and whole(path)), f"{'.'.join(path)}: {told}"


def test_every_key_that_is_told_is_written() -> None:
    written = [path for trace in TRACES.values() for path in leaves(document(trace))]
    assert {key for key in ROWS if not any(fits(key, path) for path in written)} == set()


def test_a_unit_in_a_key_is_the_unit_that_is_told() -> None:
    for ending, unit in IN_ITS_NAME.items():
        keys = [key for key in ROWS if key.endswith(ending)]
        assert keys
        assert {ROWS[key][0] for key in keys} == {unit}


def test_the_verdict_says_which_runs_it_does_not_go_by() -> None:
    whole = made_up.nothing()
    assert document(whole)["verdict"]["sentence"] == whole.verdict.sentence
    assert document(whole)["verdict"]["left_out"] == []
    out = ("a", "b", "c", "d", "e")
    verdict = document(replace(whole, read=7, left_out=out))["verdict"]
    assert verdict["sentence"] == f"{whole.verdict.sentence} 5 of 12 runs were left out: a, b, c and 2 more."
    assert verdict["left_out"] == list(out)
