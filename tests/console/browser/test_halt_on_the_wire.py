"""From the finger on halt to zero torque on the wire, by the time stamps of the bus.

A listener of its own keeps the frames that carry the drive's torque. A frame's time is that at which it had passed on
the bus, the press's that of the pointer event in the browser: one clock on one machine, nothing in between is trusted.
"""

from __future__ import annotations

import struct
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from statistics import median

import can
import pytest
from playwright.sync_api import Browser, Page

from drivers.unixbus import UnixBus
from tests.chromium import SIZE
from tests.console.browser.look import in_state, text, until
from tests.console.browser.rigs import rig
from tests.console.browser.test_over_can import LOADED, STALLED

pytestmark = [pytest.mark.slow, pytest.mark.long, pytest.mark.xdist_group("browser")]
WANTED, ATTEMPTS = 20, 40
LEAST = 0.050  # s, the median the operator was promised
RPDO_1 = 0x201  # to node 1: u16 controlword, i16 target torque in per mille of the rated one
ENABLED = 1 << 3  # of the controlword: operation enabled
NOTE = """() => document.getElementById('halt').addEventListener('pointerdown',
  (event) => { window.pressed = (performance.timeOrigin + event.timeStamp) / 1e3; }, { capture: true })"""


class Wire:
    """What the drive was told, with the time each frame had passed: (s since 1970, whether it may give torque)."""

    def __init__(self, bus: can.BusABC) -> None:
        self.bus, self.told, self.ended = bus, [(0.0, False)], False

    def listen(self) -> None:
        """Until the end."""
        while not self.ended:
            message = self.bus.recv(0.1)
            if message is not None and message.arbitration_id == RPDO_1 and len(message.data) >= 4:
                controlword, torque = struct.unpack_from("<Hh", message.data)
                self.told.append((message.timestamp, bool(controlword & ENABLED and torque)))

    def last_torque(self) -> int:
        """Index of the last frame that asked for torque."""
        return max(k for k, (_, torque) in enumerate(self.told) if torque)


@contextmanager
def listening(channel: str) -> Iterator[Wire]:
    """A third station on the bus, which only hears."""
    with UnixBus(channel) as bus:
        wire = Wire(bus)
        thread = threading.Thread(target=wire.listen)
        thread.start()
        try:
            yield wire
        finally:
            wire.ended = True
            thread.join(5)


def test_from_halt_to_zero_torque_on_the_wire_under_50_ms_at_the_median(browser: Browser) -> None:
    delays: list[float] = []
    with rig() as made, browser.new_context(viewport=SIZE) as context, listening(made.bus) as wire:
        page = context.new_page()
        page.goto(made.url)
        page.evaluate(NOTE)
        page.click("[data-act=connect]", timeout=1e3 * LOADED)
        page.fill("#jog-turns", "9")
        for _ in range(ATTEMPTS):
            if len(delays) < WANTED and _turning(page):
                delays.append(_halted(page, wire))
    delays.sort()
    shown = ", ".join(f"{1e3 * delay:.1f}" for delay in delays)
    print(f"halt to zero torque on the wire, {len(delays)} times, ms: {shown}; median {1e3 * median(delays):.1f}")
    assert len(delays) == WANTED
    assert all(delay > 0 for delay in delays)  # or the clocks are not one
    assert median(delays) < LEAST


def _turning(page: Page) -> bool:
    """The motor turns, torque is asked for; False when the machine stalled and the guard ended it."""
    page.click("[data-jog='1']", timeout=1e3 * LOADED)
    page.wait_for_selector("#run-folder:has-text('jog'):not(:has-text('last')), #fault:visible", timeout=1e3 * LOADED)
    page.wait_for_selector("[data-tile=speed] .value:has-text('10.'), #fault:visible", timeout=1e3 * LOADED)
    if page.locator("#fault").is_hidden():
        return True
    assert STALLED.search(text(page, "#fault")), text(page, "#fault")
    page.click("#reset")
    in_state(page, "connected", LOADED)
    return False


def _halted(page: Page, wire: Wire) -> float:
    """s from the press to the first frame after which none asked for torque any more."""
    box = page.locator("#halt").bounding_box()
    assert box
    page.mouse.move(box["x"] + 50, box["y"] + 50)
    page.mouse.down()
    page.mouse.up()
    in_state(page, "ready", LOADED)
    until(lambda: wire.last_torque() + 1 < len(wire.told), "a frame without torque")
    page.wait_for_timeout(300)  # of bus traffic in which torque might come back
    pressed: float = page.evaluate("window.pressed")
    return wire.told[wire.last_torque() + 1][0] - pressed
