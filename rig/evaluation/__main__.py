"""`python -m rig.evaluation run|campaign FOLDER`: figures and report of one run, or what follows a campaign.

So the control process behind the console has them made while it goes on reading its instruments. What is found stands
in the folder; the exit code is that of `hdrig analyse` and `hdrig campaign`; why there is no report is the last line on
stderr.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from rig.core.loading import load
from rig.core.way_out import ending_in_a_sentence
from rig.process.ctrl_c import Ears, after_imports, leave
from rig.process.streams import show_what_fits


def run(folder: Path) -> int:
    """result.json and report.html of the run in `folder`."""
    from rig.evaluation.run import NEEDED, analyse_folder, exit_of

    load(*NEEDED)
    result, _ = analyse_folder(folder, folder)
    if result.defect:
        print(f"hdrig: {folder}: {result.sentence}", file=sys.stderr)
    return int(exit_of(result))


def campaign(folder: Path) -> int:
    """Gear file or report of the campaign in `folder`, where its plan has one."""
    from rig.evaluation.afterwards import afterwards

    return int(afterwards(folder, lambda text: None).exit)


WHAT = {"run": run, "campaign": campaign}


def act() -> int:
    """What the command line asks for."""
    return WHAT[sys.argv[1]](Path(sys.argv[2]))


def interruptible(ears: Ears) -> int:
    """The same; an interrupt that was lost in it is one."""
    with ears.kept():
        return act()


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # our matrices are small, and a loop may run beside us
    show_what_fits(sys.stderr)
    with after_imports(act, leave) as ears:
        sys.exit(ending_in_a_sentence(lambda: interruptible(ears)))
