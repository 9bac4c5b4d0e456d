"""hdrig verify RUN…: does the folder keep its promises."""

from __future__ import annotations

import argparse
from pathlib import Path

from rig.commands.folders import expand, for_each
from rig.commands.folders import runs_argument as arguments
from rig.commands.list_ import say
from rig.core.errors import Exit, UsageError

__all__ = ["arguments", "run"]


def run(args: argparse.Namespace) -> int:
    """One line a finding; exit 6 when a promise is broken."""
    return for_each(expand(args.runs), verify_one)


def verify_one(folder: Path) -> Exit:
    """Says sound or BROKEN, and what was found."""
    from rig.runfile.verify import verify

    findings = verify(folder)
    broken = any(finding.level == "error" for finding in findings)
    simulated = "SIMULATED " if _is_simulated(folder) else ""
    say(f"{simulated}{folder.resolve().name}: {'BROKEN' if broken else 'sound'}")
    for finding in findings:
        say(f"  {finding.level:7s} {finding.sentence}")
    return Exit.INCOMPLETE if broken else Exit.PASS


def _is_simulated(folder: Path) -> bool:
    """By its manifest, and where that cannot be read by its samples."""
    from rig.runfile import manifest
    from rig.runfile.origin import SIM, samples_are_simulated

    try:
        return manifest.read(folder).get("backend") == SIM
    except UsageError:
        return samples_are_simulated(folder)
