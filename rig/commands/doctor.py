"""hdrig doctor: is this machine, this bus and this bench fit for a run? Energises nothing."""

from __future__ import annotations

import argparse

from rig.core.errors import Exit


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig doctor`."""
    parser.add_argument("--bench", default="twin", metavar="FILE", help="bench file, or the name of one that ships")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="change a number of it")


def run(args: argparse.Namespace) -> int:
    """One line a finding; exit 3 when a run would fail."""
    from rig.bench import read
    from rig.doctor import CHECKS
    from rig.doctor.finding import Health

    bench = read(args.bench, args.set)
    worst = Health.GOOD
    for check in CHECKS:
        for finding in check(bench):
            print(f"{finding.health:9s} {finding.what}: {finding.sentence}", flush=True)
            worst = max(worst, finding.health, key=list(Health).index)
    simulated = " (SIMULATED)" if bench.simulated else ""
    print(f"{bench.file.name}{simulated}: {worst}")
    return Exit.NOT_READY if worst is Health.BAD else Exit.PASS
