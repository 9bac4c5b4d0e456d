"""Through every state with the real server, the drivers of real devices and the twin at the other end of a CAN bus: in
each every button is pressed, those that may not be pressed first.
"""

from __future__ import annotations

import pytest
from playwright.sync_api import Page

from tests.console.browser.conftest import Open
from tests.console.browser.look import in_state, text, until
from tests.console.browser.rigs import Rig
from tests.console.browser.table import BUTTONS, IDLE, IN_FAULT, URGENT
from tests.console.browser.test_over_can import ATTEMPTS, LOADED, _connected, fresh

__all__ = ["fresh"]
pytestmark = [pytest.mark.long, pytest.mark.xdist_group("browser")]
SHOWN = "button => button.checkVisibility()"
BUSY = URGENT | {"note"}
OVERCURRENT = 0x2310


def test_every_button_in_every_state_on_the_real_thing(fresh: Rig, open_page: Open) -> None:
    page = open_page(fresh.url)
    _only(page, "disconnected", URGENT | {"connect", "check"})
    _at_rest(page)
    _connected(page)
    _only(page, "connected", IDLE)
    _at_rest(page)
    _press(page, "check")
    page.wait_for_selector("[data-step=check] .said:has-text('passed')", timeout=1e3 * LOADED)
    _press(page, "tare")  # makes the proof first
    in_state(page, "running", LOADED)
    _only(page, "running", BUSY)
    page.wait_for_selector("[data-step=tare] .said:has-text('N·m')", timeout=2e3 * LOADED)
    page.wait_for_selector("[data-step=prove] .said:has-text('ratio')")
    _only(page, "ready", IDLE)
    for what in ("jog forward", "jog back"):
        _press(page, what)
        _started(page, "jog")
        _only(page, "ready", IDLE)
    page.fill("#jog-turns", "9")
    _press(page, "jog forward")
    _started(page, "jog")
    _press(page, "hold")
    in_state(page, "holding", LOADED)
    _only(page, "holding", BUSY)
    _press(page, "stop")
    _only(page, "ready", IDLE)
    page.fill("#note-text", "seen by eye: nothing loose")
    _press(page, "note")
    page.wait_for_selector("#events li:has-text('nothing loose')")
    _in_fault(page, fresh)
    _press(page, "disconnect")
    in_state(page, "disconnected", LOADED)
    _only(page, "disconnected", URGENT | {"connect", "check"})
    assert {one["status"] for one in fresh.closed(6)} == {"completed", "stopped", "tripped"}


def _in_fault(page: Page, rig: Rig) -> None:
    _press(page, "jog forward")
    _started(page, "jog")
    in_state(page, "running", LOADED)  # a fault while it is being enabled is a refusal, and no trip of a run
    rig.ask(do="trip", code=OVERCURRENT)
    in_state(page, "fault", LOADED)
    _only(page, "fault", IN_FAULT)
    _at_rest(page)
    _press(page, "reset")
    in_state(page, "connected", LOADED)
    _only(page, "connected", IDLE)


def _only(page: Page, state: str, expected: set[str]) -> None:
    """What is not expected says why, and changes nothing; what is expected may be pressed."""
    in_state(page, state, LOADED)
    until(lambda: _may(page) == expected, f"{sorted(expected)} in {state}", LOADED)
    sent: list[str] = []
    page.on("request", lambda request: sent.append(request.url))
    for what in BUTTONS:
        found = page.locator(BUTTONS[what].selector)
        if what not in expected and found.evaluate(SHOWN):
            found.dispatch_event("click")
            assert text(page, "#answer").startswith("Not possible now: "), what
    page.wait_for_timeout(200)
    assert [url for url in sent if url.endswith("/api/act")] == []


def _may(page: Page) -> set[str]:
    """Those that are shown and not dashed; halt is always."""
    found = {what: page.locator(button.selector) for what, button in BUTTONS.items()}
    return {what for what, one in found.items() if one.evaluate(SHOWN) and one.get_attribute("aria-disabled") != "true"}


def _at_rest(page: Page) -> None:
    """Hold, stop and halt are taken where nothing moves, and move nothing. What the drive says of a halt takes the
    place of the answer, at once where it is quick."""
    for what in ("hold", "stop", "halt"):
        _press(page, what)
        told = f":has-text('{what.capitalize()}: '), :has-text('halted while nothing ran')"
        page.wait_for_selector(f"#answer[data-ok=true]:is({told})")


def _press(page: Page, what: str) -> None:
    button = page.locator(BUTTONS[what].selector)
    if what == "halt":
        button.dispatch_event("pointerdown")
        return
    page.wait_for_selector(f"{BUTTONS[what].selector}:not([aria-disabled=true])", timeout=1e3 * LOADED)
    word = BUTTONS[what].act.capitalize()
    for _ in range(ATTEMPTS):  # what was pressed on a state that had just passed is refused: look again, press again
        button.click()
        page.wait_for_selector(
            f"#answer:has-text('{word}: '), #answer:has-text('{word} refused: ')", timeout=1e3 * LOADED
        )
        if "the state has changed" not in text(page, "#answer"):
            return
        page.evaluate("document.getElementById('answer').textContent = ''")


def _started(page: Page, title: str) -> None:
    """A run of that name has begun, the one before it being over."""
    page.wait_for_selector(f"#run-folder:has-text('{title}'):not(:has-text('last'))", timeout=1e3 * LOADED)
