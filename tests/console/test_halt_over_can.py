"""From a halt that is posted to zero torque on the wire, on the twin over CAN: 30 times, the median is told."""

from __future__ import annotations

import socket
import statistics
import struct
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from drivers.unixbus import FRAME
from tests.console.browser.rigs import rig
from tests.console.client import Client
from tests.console.hand import FOREVER

pytestmark = [pytest.mark.slow, pytest.mark.long, pytest.mark.xdist_group("real time")]
HALTS = 30
TARGETS = 0x201  # RPDO of the drive, node 1: controlword, target torque
DISABLE, ENABLE = 0x00, 0x0F
MOST = 0.050  # s at the median, from POST to the frame
PATIENCE = 60.0  # s


class Listener:
    """Hears every command to the drive, by the time it had passed on the bus."""

    def __init__(self, bus: str) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._socket.connect(bus)
        self.commands: list[tuple[float, int, int]] = []  # s on the monotonic clock, controlword, per mille
        self._thread = threading.Thread(target=self._hear, daemon=True)
        self._thread.start()

    def _hear(self) -> None:
        while packet := self._received():
            identifier, _, data, passed = FRAME.unpack(packet)
            if identifier == TARGETS:
                word, torque = struct.unpack_from("<Hh", data)
                self.commands.append((passed * 1e-9, word, torque))

    def _received(self) -> bytes:
        try:
            return self._socket.recv(FRAME.size)
        except OSError:  # closed here
            return b""

    def close(self) -> None:
        """Hears no more."""
        self._socket.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._socket.close()

    def off_after(self, begin: float) -> float:
        """s on the monotonic clock when the drive was told to disable, with no torque, after `begin`."""
        give_up = time.monotonic() + PATIENCE
        while time.monotonic() < give_up:
            for passed, word, torque in reversed(self.commands):
                if passed < begin:
                    break
                if word == DISABLE:
                    assert torque == 0
                    return min(p for p, w, _ in self.commands if p >= begin and w == DISABLE)
            time.sleep(0.002)
        raise AssertionError("no frame took the torque off")

    def turns(self) -> bool:
        """Whether the newest command asks for torque."""
        return bool(self.commands) and self.commands[-1][1] == ENABLE and self.commands[-1][2] != 0


def turning(console: Client, listener: Listener) -> None:
    """A run in which the drive is given torque; a trip, for the machine stalls, is reset and the run made again."""
    give_up = time.monotonic() + 4 * PATIENCE
    while time.monotonic() < give_up:
        if console.state()["state"] == "fault":
            console.finish("reset")
        console.do("start", procedure="kinematic-error", parameters=FOREVER)
        state = console.until(lambda s: not s["job"] or (_turning(s["run"]) and listener.turns()))
        if state["job"]:
            return
    raise AssertionError(f"no run lasted for a second: {console.state()['fault']}")


def _turning(run: dict[str, Any] | None) -> bool:
    return run is not None and run["procedure"] == "kinematic_error" and run["t"] > 1.0


def test_a_halt_reaches_the_wire_within_50_ms_at_the_median(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    taken, seen = [], []
    with rig() as made:
        console, listener = Client(made.url), Listener(made.bus)
        assert console.finish("connect", bench=f"{made.doors}/can-rig.toml")["bench"]
        while len(taken) < HALTS:
            turning(console, listener)
            began, answer = console.halt()
            taken.append(listener.off_after(began) - began)
            seen.append(answer["seen_by_loop_ms"])
            assert console.until(lambda s: not s["job"])["last_run"]["status"] == "stopped"
        listener.close()
        console.close()
    ordered = sorted(1e3 * t for t in taken)
    with capsys.disabled():
        print(
            f"\nhalt, POST to zero torque on the wire, {HALTS} times: median {statistics.median(ordered):.1f} ms, "
            f"90 % {ordered[int(0.9 * HALTS)]:.1f} ms, most {ordered[-1]:.1f} ms; seen by the loop after "
            f"{statistics.median(seen):.1f} ms (median)"
        )
    assert statistics.median(taken) < MOST


def test_the_hard_wired_chain_is_seen_open_when_safe_torque_off_acts_and_closed_again_after() -> None:
    with rig() as made:
        console = Client(made.url)
        console.finish("connect", bench=f"{made.doors}/can-rig.toml")
        assert console.until(lambda s: s["chain"]["known"])["chain"]["closed"] is True
        made.ask(do="sto", active=True)
        assert "power stage has no voltage" in console.until(lambda s: s["chain"]["closed"] is False)["chain"]["text"]
        made.ask(do="sto", active=False)
        assert console.until(lambda s: s["chain"]["closed"])["chain"]["known"]
        console.close()
