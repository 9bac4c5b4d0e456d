"""`python -m tests.bench [--row N …] [--quick] [--table FILE]`."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy is imported: threads that spin are noise
os.environ["OMP_WAIT_POLICY"] = "passive"  # the same of the C floor that has two

from rig.core.errors import HdrigError
from tests.bench.built import Unavailable, peers
from tests.bench.figure import Shown, not_measured
from tests.bench.machine import head, load
from tests.bench.row import Row
from tests.bench.rows import ROWS
from tests.bench.table import Measured, lines_of, table
from tests.bench.turns import Rounds

ROUNDS = 7  # in earnest: the 10th and the 90th percentile are then those of the second and the last but one
REMARKS = (
    "Sides take turns within one run; a figure is ours over theirs, round by round: median, 10th and 90th percentile "
    "of the rounds. CPU time unless a figure says otherwise. Rigs are SIMULATED (the twin). The load average "
    "says how many processes wanted to run on these cores; what the machine does falls on both sides of a ratio."
)


def main() -> int:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("--row", type=int, action="append", help="only these rows")
    parser.add_argument("--quick", action="store_true", help="small sizes, one round: figures mean nothing")
    parser.add_argument("--table", type=Path, help="write the table here")
    args = parser.parse_args()
    rounds = Rounds(1 if args.quick else ROUNDS, args.quick)
    wanted = [row() for row in ROWS if not args.row or row.number in args.row]
    remarks = [REMARKS, f"Peers: {peers()[1]}.", *(["QUICK: the figures mean nothing."] if args.quick else [])]
    began, measured, text = head(), list[Measured](), ""
    said = by_hand(args.table) if args.table else ""
    for row in wanted:
        measured.append(one(row, rounds))
        print("\n".join(lines_of(measured[-1])), flush=True)
        text = table([*measured, *map(pending, wanted[len(measured) :])], began, remarks)
        if args.table:
            args.table.write_text(text + said, encoding="utf-8")  # after each row: what was measured stays
    print(f"\n{text}")
    return 0


def by_hand(table: Path) -> str:
    """What people wrote below a table, from its first heading on: it stays below the next one."""
    text = table.read_text(encoding="utf-8") if table.exists() else ""
    return text[text.index("\n## ") :] if "\n## " in text else ""


def one(row: Row, rounds: Rounds) -> Measured:
    """A row measured, or why it was not."""
    before = load()
    try:
        figures = row.measure(rounds)
    except (Unavailable, HdrigError) as why:  # a run that the guard ended on a busy machine is no figure
        figures = [not_measured(row.name, Shown(), str(why))]
    return Measured(row, figures, before, load())


def pending(row: Row) -> Measured:
    """A row that the bench has not come to: it stands in the table all the same."""
    return Measured(
        row, [not_measured(row.name, Shown(), "the bench was ended before it came to this row")], load(), load()
    )


if __name__ == "__main__":
    sys.exit(main())
