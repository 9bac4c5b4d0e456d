"""What the bridge of the live view holds after many minutes of run: python -m tests.studies.viewer_memory --minutes 20.

Rows of a 1 kHz run in the bridge's own blocks, as fast as they are taken, into the real proxy: its memory is limited by
an option, the bridge's own has to stay where it is. Half of the time the proxy is frozen.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import signal
import tempfile
from pathlib import Path

from rig.core.ring import Ring
from rig.core.sample import Sample
from rig.live.view.bridge import BEAT, Bridge
from rig.live.view.server import Proxy

RATE = 1000  # Hz
PAGE = os.sysconf("SC_PAGESIZE")


def resident(pid: int) -> float:
    """MB of memory a process has."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * PAGE / 1e6


def put(ring: Ring, first: int, rows: int) -> None:
    """A gear of N = 50 at 9.6 rpm with 30 arcsec of order 2."""
    for i in range(first, first + rows):
        t = i / RATE
        theta = t * 9.6 / 60 * 2 * math.pi
        error = math.radians(30 / 3600) * math.cos(2 * theta)
        sample = Sample(t, theta, theta / 50 - error, 1.005, 0.3, 3.0, 1e-4, i, i, 1, "")
        assert ring.put(sample, 0.3, 0.3, theta)
        ring.tell_acked(i + 1)


def main() -> None:
    """A line a minute of run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=int, default=20)
    args = parser.parse_args()
    now, beats, block = 0.0, int(60 / BEAT), int(RATE * BEAT)
    server, ring = Proxy(), Ring.create(4096)
    with tempfile.TemporaryDirectory() as folder:
        said = {"schema": "hdrig.run/1", "procedure": "kinematic_error", "gear": {"ratio": 50}, "status": "running"}
        more = {"loop": {"rate": RATE}, "ring": str(ring.path), "backend": "sim"}
        (Path(folder) / "manifest.json").write_text(json.dumps({**said, **more}))
        server.start()
        bridge = Bridge(server, lambda: now)
        bridge.follow(Path(folder))
        print(f"{'minute':>6s} {'viewer':>8s} {'bridge MB':>10s} {'proxy MB':>9s} {'skipped':>8s}")
        for minute in range(args.minutes):
            frozen = minute >= args.minutes // 2
            os.kill(server.pid, signal.SIGSTOP if frozen else signal.SIGCONT)
            for beat in range(beats):
                put(ring, (minute * beats + beat) * block, block)
                now += BEAT
                bridge.beat()
            state = "frozen" if frozen else "there"
            memory = f"{resident(os.getpid()):10.0f} {resident(server.pid):9.0f}"
            print(f"{minute + 1:6d} {state:>8s} {memory} {bridge.skipped:8d}", flush=True)
        server.stop()
    ring.unlink()
    os._exit(0)  # the SDK would try to reach the proxy for some seconds


if __name__ == "__main__":
    main()
