"""hdrig list: the runs in folders, from their manifests alone."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from rig.catalogue.filter import ALL, ORDERS, STATUSES, VERDICTS, asked
from rig.catalogue.row import UNREADABLE, Row
from rig.catalogue.scan import passing
from rig.commands.folders import say_twice, say_unread
from rig.core.errors import UsageError
from rig.core.in_order import in_order
from rig.core.kinds import KINDS
from rig.core.nearest import nearest
from rig.procedures import CATALOGUE

HEAD = (
    f"{'started (UTC)':19s} {'procedure':18s} {'gear':16s} {'status':12s} {'duration':>9s} {'verdict':12s} "
    f"{'origin':9s} run"
)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig list`."""
    parser.add_argument("roots", nargs="*", type=Path, default=[Path("runs")], metavar="FOLDER", help="default: runs")
    parser.add_argument("--gear", default="", metavar="SERIAL", help="serial of the gear; * and ? stand for anything")
    parser.add_argument("--procedure", default="", metavar="NAME", help="as in hdrig run, for example kinematic-error")
    parser.add_argument("--verdict", default="", metavar="WORD", help=", ".join(VERDICTS))
    parser.add_argument("--status", default="", metavar="WORD", help=", ".join(STATUSES))
    parser.add_argument("--since", default="", metavar="DATE", help="from this day on, UTC: 2026-11-20, or with a time")
    parser.add_argument("--until", default="", metavar="DATE", help="up to and with this day, UTC")
    parser.add_argument("--sort", default="started", metavar="BY", help=f"{', '.join(ORDERS)}; default: started")
    parser.add_argument("--reverse", action="store_true", help="the other way round: newest first")
    parser.add_argument("--json", action="store_true", help="one JSON object per line and run")


def run(args: argparse.Namespace) -> int:
    """One line a run, oldest first unless told otherwise; a damaged manifest has a line that says what is wrong."""
    names = ("gear", "procedure", "verdict", "status", "since", "until", "sort", "reverse")
    filter = asked(**{name: getattr(args, name) for name in names})
    line_of, tell = (_json, print) if args.json else (_line, say)
    count = 0
    # of each run nothing is kept but its line and who it is: years of runs take little more memory than a day's
    found = passing(args.roots, filter, say_unread, say_twice)
    for line in in_order(((filter.key(row), line_of(row)) for row in found), filter.reverse):
        if not count and not args.json:
            say(HEAD)
        tell(line)
        count += 1
    if not count and args.procedure:
        _refuse_unknown(args.procedure, args.roots)
    if not count and not args.json:
        print(f"no such runs in {', '.join(map(str, args.roots))}")
    return 0


def _refuse_unknown(procedure: str, roots: Sequence[Path]) -> None:
    """Raises UsageError when no procedure, and no run below `roots`, is called so: a run of somebody else may have any
    name, so that it is looked for among them first."""
    there = {row.procedure for row in passing(roots, ALL) if row.procedure}
    known = {name.replace("_", "-") for name in (*CATALOGUE, *KINDS, *there)}
    if (said := procedure.replace("_", "-")) not in known:
        raise UsageError(f"there is no procedure '{procedure}'; {nearest(said, known)}")


def _json(row: Row) -> str:
    """ASCII: names of folders may be anything."""
    return json.dumps(row.as_json(), allow_nan=False)


def _line(row: Row) -> str:
    if row.status == UNREADABLE:
        return f"{'–':19s} {UNREADABLE:18s} {row.problem}"
    duration = "–" if row.duration is None else f"{row.duration:.1f} s"
    procedure = row.procedure.replace("_", "-")
    return (
        f"{row.started_utc[:19]:19s} {procedure:18s} {row.gear:16s} {row.status:12s} {duration:>9s} "
        f"{row.ruling or '–':12s} {row.origin or '–':9s} {row.path}{_remark(row)}"
    )


def _remark(row: Row) -> str:
    """What is wrong with a run, behind its name."""
    said = [*([row.problem] if row.problem else []), *([f"figures in doubt: {row.doubt}"] if row.doubt else [])]
    return f"  ({'; '.join(said)})" if said else ""


def say(line: str) -> None:
    """Print what a terminal can take: names of folders and words of manifests may be anything."""
    spaced = line.translate({0xA0: " ", 0x202F: " "})  # what holds a number and its unit on one line of a page
    shown = "".join(c if c.isprintable() else "\ufffd" for c in spaced)
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"  # a closed standard output has none
    print(shown.encode(encoding, "replace").decode(encoding))
