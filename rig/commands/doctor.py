"""hdrig doctor: is this machine, this bus and this bench fit for a run? Energises nothing."""

from __future__ import annotations

import argparse

from rig.commands.options import bench_argument
from rig.core.errors import Exit


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig doctor`."""
    bench_argument(parser)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="change a number of it")


def run(args: argparse.Namespace) -> int:
    """One line a finding; exit 3 when a run would fail."""
    from rig.bench import read
    from rig.doctor import CHECKS
    from rig.doctor.finding import Health

    bench = read(args.bench, args.set)
    worst, twin = Health.GOOD, bench.simulated
    for check in CHECKS:
        for finding in check(bench):
            mark = " (SIMULATED)" if finding.simulated else ""
            print(f"{finding.health:9s} {finding.what}{mark}: {finding.sentence}", flush=True)
            twin = twin or finding.simulated
            worst = max(worst, finding.health, key=list(Health).index)
    simulated = " (SIMULATED)" if twin else ""
    print(f"{bench.file.name}{simulated}: {worst}")
    return Exit.NOT_READY if worst is Health.BAD else Exit.PASS
