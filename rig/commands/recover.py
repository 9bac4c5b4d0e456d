"""hdrig recover RUN…: what a killed program left becomes a readable run."""

from __future__ import annotations

import argparse
from pathlib import Path

from rig.commands.folders import expand, for_each
from rig.commands.folders import runs_argument as arguments
from rig.commands.list_ import say
from rig.core.errors import Exit

__all__ = ["arguments", "run"]


def run(args: argparse.Namespace) -> int:
    """One sentence a run."""
    return for_each(expand(args.runs), recover_one)


def recover_one(folder: Path) -> Exit:
    """Says what was found and made of it."""
    from rig.runfile.recover import recover

    say(recover(folder).sentence)
    return Exit.PASS
