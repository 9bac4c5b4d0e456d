"""python -m rig.live.view web|native: the bridge as a process of its own. See `bridge`."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys

from rig.core.errors import HdrigError
from rig.live.view.server import Proxy, Server, Window, quiet_home

NICE = 10  # whatever else runs on this machine comes first


def main() -> int:
    """Start the viewer, say where it is, follow what is asked for."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a Ctrl-C is the operator's word to the loop
    server: Server = {"web": Proxy, "native": Window}[sys.argv[1]]()
    try:
        os.environ["XDG_CONFIG_HOME"] = str(quiet_home())
        server.start()
        url = _page(server) if sys.argv[1] == "web" else ""
        # pyarrow looks for pandas with the first array, and nothing here has a data frame: as much again
        sys.modules["pandas"] = None  # type: ignore[assignment]
        from rig.live.view.bridge import Bridge, Commands  # the SDK itself: 0.3 s

        _stand_back(os.getpid(), server.pid)
        print(json.dumps({"url": url, "viewer": server.pid}), flush=True)
        Bridge(server).run(Commands(sys.stdin.fileno()))
    except HdrigError as error:
        print(json.dumps({"error": str(error)}), flush=True)
    finally:
        server.stop()
    sys.stdout.flush()
    os._exit(0)  # the SDK would try for 5 s to reach a viewer that is gone


def _stand_back(*groups: int) -> None:
    """From here on, every thread of these process groups: they start before anything moves, as fast as it goes.

    Beside 15 busy processes a start that stands back takes 40 s. A viewer that is started anew in mid-run inherits it.
    """
    for group in groups:
        with contextlib.suppress(OSError):
            os.setpriority(os.PRIO_PGRP, group, NICE)


def _page(server: Server) -> str:
    from rig.live.view.pages import Pages

    return Pages(server.port, lambda: server.starts).url


if __name__ == "__main__":
    raise SystemExit(main())
