"""Every button in every state the station can be in: a press does what the table says, or says why not."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page

from rig.station.rules import allowed
from tests.console.browser.look import text, until
from tests.console.browser.puppet import Puppet
from tests.console.browser.table import AT_REST, BUTTONS, SITUATIONS, Button

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]
SHOWN = "button => button.checkVisibility() && !button.closest('[inert]')"


@pytest.mark.long
def test_every_button_does_what_the_table_says_or_says_why_not(page: Page, station: Puppet) -> None:
    """On one page, from one situation to the next: that of before leaves no button as it was."""
    for name, (told, expected) in SITUATIONS.items():
        station.tell(**{**AT_REST, **told})
        page.wait_for_selector(f"html[data-revision='{station.revision}']", state="attached")
        if "start" in expected:
            page.wait_for_selector("#start[aria-disabled=false]")  # its parameters have been looked at
        for what, button in BUTTONS.items():
            _press(page, station, f"{name}: {what}", button, what in expected)


def _press(page: Page, station: Puppet, which: str, button: Button, expected: bool) -> None:
    found = page.locator(button.selector)
    if not found.evaluate(SHOWN):
        assert not expected, f"{which} is hidden"
    elif expected:
        assert _sent(found, station) == [button.act], which
    else:
        assert _sent(found, station) == [], which
        assert text(page, "#answer") == f"Not possible now: {_why(button, station)}", which


def _sent(button: Locator, station: Puppet) -> list[str]:
    """The acts that one press brought to the server. What is covered or dashed is pressed all the same."""
    before, page = len(station.acts), button.page
    page.evaluate("document.querySelector('#answer').textContent = ''")
    halts = button.get_attribute("id") == "halt"
    button.dispatch_event("pointerdown" if halts else "click")
    if button.get_attribute("aria-disabled") != "true":
        until(lambda: len(station.acts) > before, "the act")
        until(lambda: text(page, "#answer") != "", "the answer, lest it be taken for that of the next press")
    page.wait_for_timeout(20)  # for what would come besides
    return [act["act"] for act in station.acts[before:]]


def _why(button: Button, station: Puppet) -> str:
    """In the words of the station."""
    return str({**allowed(station.picture), "take_control": "this page holds control"}[button.act])
