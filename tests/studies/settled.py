"""Does the one run that a trace advises settle what it calls ambiguous? Campaigns of the blind plant, which is no twin.

    .venv/bin/python -m tests.studies.settled --cases 15 --store /tmp/settled

draws truths and poor plans (the paper's runs alone, once, one way, without torque sensor) until so many traces said
`ambiguous`, has the blind plant make the run that was asked for, twice as hdrig makes it, behind the others, traces
again, and writes tests/studies/settled.md. What was made and said stays in the store: a study that was stopped goes on.
A tree that is edited meanwhile mixes versions: let it run on a copy.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from rig.analysis.tracing.answer import NextRun
from rig.analysis.tracing.outcome.record import document
from rig.analysis.tracing.trace import trace
from rig.closing.advice import sections
from rig.core.errors import UsageError
from rig.process.software import software
from tests.blind import plans
from tests.blind.builder import Builder
from tests.blind.campaign import simulate
from tests.blind.cases import Case, Request, make
from tests.blind.folder import write_campaign, write_run
from tests.blind.forms import form_of
from tests.blind.intervals import Rate
from tests.blind.plans import Plan, RunPlan
from tests.blind.rig import Rig
from tests.blind.strength import shape_rng

DRAWN = (
    ("paper", "quadratic_drag", "power_1p7"),
    ("paper", "quadratic_drag", "onset"),
    ("paper_one_way", "lost_motion", "sharp"),
    ("paper_once", "quadratic_drag", "power_1p7"),
    ("paper_no_torque_sensor", "torsional_mode", "sensor_shaft"),
    ("paper_no_torque_sensor", "channel_time_skew", "motor_late"),
)
"""Plan, truth and form, in turn: such were called ambiguous before. Of truths drawn at random four of 38 were."""
WEAKEST, STRONGEST = 2.0, 12.0  # of the floor: large enough to be seen, and still to be told apart
GAP = 18.0  # s between two runs, as in the blind plans
AMBIGUOUS = "ambiguous"


@dataclass(frozen=True)
class Said:
    """A trace in a line."""

    status: str
    effects: tuple[str, ...]
    rivals: tuple[str, ...]
    seconds: float

    @property
    def words(self) -> str:
        """For the table."""
        rivals = f" or {', '.join(self.rivals)}" if self.rivals else ""
        return f"{self.status.replace('_', ' ')}: {', '.join(self.effects) or '–'}{rivals}"


@dataclass(frozen=True)
class Followed:
    """One case: what was hidden, said, asked for, and said after the run; `outcome` is one of OUTCOMES."""

    case: str
    plan: str
    hidden: str
    size: float
    first: Said
    asked: str = ""
    because: str = ""
    outcome: str = ""
    second: Said | None = None

    @property
    def offered(self) -> bool:
        """Whether the truth is among what the first trace left open."""
        return self.truth in {*self.first.effects, *self.first.rivals}

    @property
    def truth(self) -> str:
        """Name of the hidden effect, without its form."""
        return self.hidden.partition("/")[0]


OUTCOMES = {
    "settled": "explained, the hidden effect first",
    "still ambiguous": "called ambiguous again",
    "wrong": "explained by another effect",
    "let go": "an unknown effect, or none missing",
    "not carried out": "no run, or one that the rig cannot make",
}


def requests(seed: int) -> Iterator[Request]:
    """Truths that have a look-alike, each on a poor plan and on a rig of its own, without end."""
    rng = np.random.default_rng([seed, 41])
    while True:
        for plan, effect, form in DRAWN:
            over = float(np.exp(rng.uniform(np.log(WEAKEST), np.log(STRONGEST))))
            yield Request("single", int(rng.integers(2**31)), plan, effect, form, over)


def runs_asked_for(asked: Mapping[str, Any], rig: Rig) -> list[RunPlan]:
    """What hdrig would make of the advice, as runs of the blind plant; the breakaways of a friction run are left out.

    Raises UsageError where there is no such run.
    """
    found: list[RunPlan] = []
    for section in sections(NextRun(asked["procedure"], asked["conditions"], asked["because"])):
        base = _run(section, rig)
        found += [replace(base, name=f"advised_{len(found) + k}_{base.name}") for k in range(section["repeats"])]
    return found


def _run(section: Mapping[str, Any], rig: Rig) -> RunPlan:
    wanted, weight = dict(section["with"]), float(section.get("weight", 0.0))
    match section["procedure"]:
        case "constant-torque":
            return plans.steady(round(wanted.pop("speed_rpm")), "x")
        case "friction":
            return plans.stairs(tuple(float(rpm) for rpm in wanted.pop("speeds_rpm").split(",")), "x")
        case "kinematic-error":
            return replace(plans.slow("x"), tau_ext=weight)
        case "stiffness-lock":
            amplitude = float(wanted.pop("tau_max")) * rig.N / rig.K
            return replace(plans.lock(60, "x"), amplitude=amplitude)
        case other:
            raise UsageError(f"the blind plant has no {other}")


def behind(plan: Plan, more: Sequence[RunPlan]) -> Plan:
    """The plan with `more` at its end, one after the other."""
    last, runs = plan.runs[-1], []
    clock = last.start_s + last.lead_s + last.duration_s + GAP
    for run in more:
        runs.append(replace(run, start_s=clock))
        clock += run.lead_s + run.duration_s + GAP
    return replace(plan, runs=(*plan.runs, *runs))


def plant(case: Case) -> Builder:
    """The plant of a case once more, as it was when its campaign began."""
    builder = Builder(case.stage.rig)
    hidden: Any = case.truth["hidden"]
    for place, part in enumerate(hidden):
        form_of(part["effect"], part["form"]).build(builder, shape_rng(case.stage.seed, place), part["strength"])
    return builder


def look(folder: Path) -> tuple[Said, dict[str, Any]]:
    """Trace a campaign: in a line, and the whole document."""
    began = time.perf_counter()
    said = document(trace(folder))
    v = said["verdict"]
    return Said(v["status"], tuple(v["effects"]), tuple(v["rivals"]), time.perf_counter() - began), said


def follow(request: Request, folder: Path) -> Followed:
    """One truth: campaign, trace, and where that is ambiguous the run asked for and a second trace."""
    case = make(request)
    write_campaign(case.runs, folder, case.stage.plan, case.stage.rig)
    first, document = look(folder)
    hidden: Any = case.truth["hidden"]
    size: Any = case.truth["size"]
    found = Followed(folder.name, request.plan, f"{hidden[0]['effect']}/{hidden[0]['form']}", size, first)
    return found if first.status != AMBIGUOUS else settle(found, case, document["next_run"], folder)


def settle(found: Followed, case: Case, asked: Mapping[str, Any] | None, folder: Path) -> Followed:
    """The rest of an ambiguous case."""
    if asked is None:
        return replace(found, outcome="not carried out", because="no run is asked for")
    given = " ".join(f"{k}={v}" for k, v in asked["conditions"].items())
    found = replace(found, asked=f"{asked['procedure']} {given}".strip(), because=asked["because"])
    try:
        more = behind(case.stage.plan, runs_asked_for(asked, case.stage.rig))
    except UsageError as error:
        return replace(found, outcome="not carried out", because=str(error))
    taken = simulate(plant(case), more, case.stage.noise, case.stage.seed)
    for run in taken[len(case.runs) :]:
        write_run(run, folder / run.plan.name, more.channels, case.stage.rig)
    second, _ = look(folder)
    return replace(found, second=second, outcome=judged(found.truth, second))


def judged(hidden: str, second: Said) -> str:
    """One of OUTCOMES."""
    if second.status == AMBIGUOUS:
        return "still ambiguous"
    if second.status != "explained":
        return "let go"
    return "settled" if second.effects[0] == hidden else "wrong"


def study(cases: int, seed: int, store: Path, most: int) -> list[Followed]:
    """Truths in turn until `cases` of them were ambiguous, at most `most`; all that were followed."""
    store.mkdir(parents=True, exist_ok=True)
    done: list[Followed] = []
    for number, request in enumerate(requests(seed)):
        if number == most or sum(f.first.status == AMBIGUOUS for f in done) == cases:
            return done
        book = store / f"case-{number:03d}.json"
        if not book.exists():
            found = follow(request, store / f"case-{number:03d}")
            book.write_text(json.dumps(asdict(found), indent=1, ensure_ascii=False), encoding="utf-8")
            print(f"{found.case} {found.plan} {found.hidden}: {found.first.words} {found.outcome}", flush=True)
        done.append(_read(book))
    raise AssertionError("requests have no end")


def _read(book: Path) -> Followed:
    values = json.loads(book.read_text(encoding="utf-8"))
    first, second = (Said(**(s | {k: tuple(s[k]) for k in ("effects", "rivals")})) if s else None
                     for s in (values.pop("first"), values.pop("second")))  # fmt: skip
    assert first is not None
    return Followed(**values, first=first, second=second)


def table(followed: Sequence[Followed]) -> list[str]:
    """Markdown: the share settled, then a line for every ambiguous case."""
    asked = [f for f in followed if f.first.status == AMBIGUOUS]
    offered = sum(f.offered for f in asked)
    others = [judged(f.truth, f.first) for f in followed if f.first.status != AMBIGUOUS]
    lines = [
        f"{len(followed)} campaigns were traced, {len(asked)} were called ambiguous; the hidden effect was among the "
        f"names offered in {offered} of them. Of the other {len(others)}, {others.count('settled')} were explained "
        f"with the hidden effect first, {others.count('wrong')} by another, {others.count('let go')} were called "
        "unknown or nothing missing.",
        "",
        "| after the advised run | cases, share (95 % interval) |",
        "|---|---|",
    ]
    for outcome, meaning in OUTCOMES.items():
        rate = Rate(sum(f.outcome == outcome for f in asked), len(asked))
        lines.append(f"| {outcome}: {meaning} | {rate} |")
    lines += [
        "",
        "| case | plan | hidden | over floor | said first | asked for | said then | outcome |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for f in asked:
        then = f.second.words if f.second is not None else f.because
        cells = (f.case, f.plan, f.hidden, f"{f.size:.1f} ×", f.first.words, f.asked, then, f.outcome)
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def document_of(followed: Sequence[Followed], seed: int) -> str:
    """The whole file."""
    said = software()
    return "\n".join(
        [
            "# Ambiguous cases and the one run that was advised",
            "",
            f"{datetime.now(UTC):%Y-%m-%d}, commit {said.get('commit')}{' with changes' if said.get('dirty') else ''}, "
            f"seed {seed}. SIMULATED by the blind plant (`tests/blind`), which shares no code with the tracer or the "
            "twin. One effect of the library, in textbook form or another, 2 to 12 times the floor, on a plan too "
            "poor to tell everything: the paper's runs alone, also once each, one way, or without a torque sensor.",
            "",
            "What is asked for becomes runs as `hdrig close-loop` makes them, each twice, the lock test in two "
            "amplitudes; a friction run is without its breakaways, which the blind plant's controller cannot make.",
            "",
            *table(followed),
            "",
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=15, help="ambiguous ones")
    parser.add_argument("--most", type=int, default=200, help="campaigns to be traced for them")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--store", type=Path, required=True, help="folder for campaigns (10 MB each) and what was said")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    args = parser.parse_args()
    text = document_of(study(args.cases, args.seed, args.store, args.most), args.seed)
    print(text)
    args.out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
