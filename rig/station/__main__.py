"""`python -m rig.station LINE SWITCHES OUT`: started by the console and by nobody else."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path

from rig.live.switches import Switches
from rig.station.channel import Channel
from rig.station.interrupts import Panel
from rig.station.jobs import JOBS
from rig.station.station import Station


def main(line: int, switches: Path, root: Path) -> int:
    """`line` is the number of an inherited socket."""
    channel = Channel(socket.socket(fileno=line))
    with Panel(seen := Switches.attach(switches)) as panel:
        assert isinstance(panel, Panel)
        Station(channel, seen, panel, root, JOBS).serve()
    channel.close()
    seen.unlink()  # where the server was killed it could not
    return 0


if __name__ == "__main__":
    line, switches, root = sys.argv[1:]
    sys.argv = ["hdrig serve"]  # what others are told who find the bench taken
    ended = main(int(line), Path(switches), Path(root))
    # All is let go of and closed by now. Taking the interpreter apart is seconds on a busy machine, and somebody waits.
    os._exit(ended)
