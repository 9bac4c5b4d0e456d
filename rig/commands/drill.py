"""hdrig drill: every fault of bus and devices in every phase of a run, on the twin and virtual time; nothing moves."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rig.core.errors import Exit, UsageError

if TYPE_CHECKING:
    from rig.drill.drill import Outcome

WIDTH = 52


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig drill`."""
    parser.add_argument("--only", default="", metavar="WORDS", help="faults whose name contains this")
    parser.add_argument("--drive", choices=("cia402", "odrive"), default="cia402", help="which drive is on the rig")
    parser.add_argument("--phase", default="", metavar="NAME", help="idle, enabling, tracking, reversal … (all)")


def run(args: argparse.Namespace) -> int:
    """One line a fault: reaction in ms per phase; exit 1 when something was not as it has to be."""
    from rig.drill.catalogue import RIGS
    from rig.drill.drill import drill
    from rig.drill.phase import PHASES

    kind = RIGS[args.drive]
    causes = [c for c in kind.causes if args.only in c.name]
    phases = [p for p in PHASES if args.phase in p.name]
    if not causes or not phases:
        what, asked, some = ("phase", args.phase, PHASES) if causes else ("fault", args.only, kind.causes)
        raise UsageError(
            f"no {what} has '{asked}' in its name; expected one of\n  " + "\n  ".join(x.name for x in some)
        )
    print(f"SIMULATED: the drivers of real devices against the twin's {kind.words}, virtual time, 1 kHz, 1 Mbit/s")
    print(
        "ms from the cause to the last torque commanded; – none commanded, ok went on as it has to, ✗ not as expected\n"
        "(ms) not seen by design: in this phase no reading shows it, or the phase is over before; no time is promised"
    )
    print(f"{'':{WIDTH}s}{'allowed':>9s}" + "".join(f"{p.name:>18s}" for p in phases), flush=True)
    outcomes: list[Outcome] = []
    for cause in causes:
        row = [drill(cause, phase, kind.made) for phase in phases]
        outcomes += row
        print(f"{cause.name:{WIDTH}s}{_allowed(row[0])}" + "".join(f"{_cell(o):>18s}" for o in row), flush=True)
    for line in _summary(outcomes):
        print(line)
    return Exit.PASS if all(o.passed for o in outcomes) else Exit.OUT_OF_LIMITS


def _allowed(outcome: Outcome) -> str:
    from rig.drill.cause import Expected

    return f"{'–' if outcome.cause.expected is Expected.GO_ON else f'{outcome.allowed * 1e3:.0f}':>9s}"


def _cell(outcome: Outcome) -> str:
    if not outcome.passed:
        return f"✗ {outcome.ended}"
    if outcome.ended in ("completed", "stopped"):
        return "ok"
    shown = f"{outcome.reaction * 1e3:.1f}" if outcome.reaction else "–"
    return f"({shown})" if outcome.phase in outcome.cause.unseen else shown


def _summary(outcomes: list[Outcome]) -> Iterator[str]:
    timed = [o for o in outcomes if o.phase not in ("idle", "enabling", *o.cause.unseen)]
    tripped = [o for o in timed if o.ended == "tripped"]
    failed = [o for o in outcomes if not o.passed]
    yield f"{len(outcomes)} drills, {len(failed)} not as expected"
    if tripped:
        worst = max(tripped, key=lambda o: o.reaction - o.cause.detection)
        over = (worst.reaction - worst.cause.detection) * 1e3
        where = f"{worst.cause.name}, {worst.phase}"
        yield f"worst case beyond the declared detection time: {over:+.1f} ms ({where}), 3 ms allowed"
    for outcome in failed:
        yield f"✗ {outcome.cause.name}, {outcome.phase}: {'; '.join(outcome.wrong)} ({outcome.reason})"
