"""The story of the rounds: one value, written after each of them as close-loop.json, schema hdrig.close-loop/1."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.analysis.tracing.outcome.record import document
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.outcome.without import ruled
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.thresholds import EXPLAINED
from rig.core.errors import RecorderError, UsageError
from rig.runfile.manifest import contents, parse, told, write_atomic

NAME = "close-loop.json"
SCHEMA = "hdrig.close-loop/1"


class End(StrEnum):
    """How a loop ended."""

    NOTHING = "nothing_missing"
    EXPLAINED = "explained"
    UNKNOWN = "unknown"  # something is left, and no effect of the library is it
    UNDECIDED = "undecided"  # rivals are left, and the run that would decide cannot be made, or did not
    BUDGET = "budget"
    STOPPED = "stopped"
    OPEN = "open"  # it goes on


SETTLED = {Status.EXPLAINED: End.EXPLAINED, Status.NOTHING: End.NOTHING}


@dataclass(frozen=True)
class Round:
    """Runs made, and what a trace of all runs so far said.

    Errors are RMS on held-out runs, over the floor, by channel; `asked` is what the trace asked for next, `plan` the
    text of the plan made of it, `refused` why there is none.
    """

    number: int
    made: tuple[str, ...]
    minutes: float  # of rig time, since the campaign began
    status: Status
    effects: tuple[str, ...]
    rivals: tuple[str, ...]
    coordinate: str | None
    sentence: str
    fitted: int
    held_out: int
    over_floor_before: dict[str, float]
    over_floor_after: dict[str, float]
    pooled_before: dict[str, float | None]
    pooled_after: dict[str, float | None]
    parameters: dict[str, dict[str, Any]]
    lives_in: tuple[str, ...] = ()  # coordinates of what was left, the telling ones first
    asked: dict[str, Any] | None = None
    plan: str = ""
    words: str = ""
    refused: str = ""
    in_part: int = 0  # of the held-out ones: parts of runs that were fitted with the rest of them


def left(found: Round) -> str:
    """What the trace's page calls not explained although the verdict has a name for most; "" where there is none."""
    loud = {word: r for c, word in SENSOR_NAMES.items() if (r := found.over_floor_after.get(c, 0.0)) > EXPLAINED}
    said = " and ".join(f"the {word} stays at {ratio:.2f} times its floor" for word, ratio in loud.items())
    return f"Not all of it: {said}, and what that is, is not known." if said else ""


def settled_by(found: Round) -> End | None:
    """How a loop ends with this round; None where something is left to be run for, or cannot be."""
    return None if left(found) else SETTLED.get(found.status)


@dataclass(frozen=True)
class Story:
    """All rounds of one campaign."""

    campaign: str
    simulated: bool
    budget_minutes: float
    end: End = End.OPEN
    sentence: str = ""
    rounds: tuple[Round, ...] = field(default=())

    def finished(self, budget_minutes: float) -> bool:
        """Whether it came to an end that a budget of so many minutes of rig time does not open again."""
        more = self.end is End.BUDGET and budget_minutes > self.budget_minutes
        return self.end not in (End.OPEN, End.STOPPED) and not more


def concluded(story: Story) -> Story:
    """The same, with the end that its last trace came to where the loop was ended before it could say so."""
    end = settled_by(story.rounds[-1]) if story.rounds and story.end in (End.OPEN, End.STOPPED) else None
    return story if end is None else replace(story, end=end, sentence=story.rounds[-1].sentence)


def told_by(found: Trace, number: int, made: Sequence[str], minutes: float) -> Round:
    """A round from its trace."""
    said = document(found)
    return Round(
        number=number,
        made=tuple(made),
        minutes=round(minutes, 3),
        status=found.verdict.status,
        effects=found.verdict.effects,
        rivals=found.verdict.rivals,
        coordinate=found.verdict.coordinate,
        sentence=ruled(found),
        fitted=len(found.fitted),
        held_out=len(found.held_out),
        in_part=sum(name not in found.fitted and whole_run(name) in found.fitted for name in found.held_out),
        over_floor_before=found.ratios_before,
        over_floor_after=found.ratios_after if found.verdict.status is Status.UNKNOWN else found.by_names,
        pooled_before=said["before"]["pooled"],
        pooled_after=said["after"]["pooled"],
        parameters={name: effect["parameters"] for name, effect in said["effects"].items()},
        lives_in=found.lives_in,
        asked=said["next_run"],
    )


def write_story(folder: Path, story: Story) -> Path:
    """Replace close-loop.json. Raises RecorderError when it cannot be written."""
    path = folder / NAME
    text = json.dumps({"schema": SCHEMA, **asdict(story)}, indent=1, ensure_ascii=False)
    with told(RecorderError, f"{path} cannot be written"):
        write_atomic(path, text.encode() + b"\n")
    return path


def read_story(folder: Path) -> Story:
    """The story so far. Raises UsageError when there is none."""
    path = folder / NAME
    try:
        book = parse(contents(path))
        if book.pop("schema") != SCHEMA:
            raise KeyError("schema")
        rounds = tuple(Round(**_tuples(r) | {"status": Status(r["status"])}) for r in book.pop("rounds"))
        return Story(**book | {"rounds": rounds, "end": End(book["end"])})
    except FileNotFoundError:
        raise UsageError(f"{folder} is no loop to go on with: it has no {NAME}") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{path} is not of schema {SCHEMA}: {error}") from None


def _tuples(values: dict[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in values.items()}
