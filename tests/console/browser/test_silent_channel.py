"""One device of a real bench that goes silent: the page shows dashes for what it told, and goes on with the others."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser, Page

from tests.chromium import SIZE
from tests.console.browser.rigs import Rig, rig

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]
DASH, NUMBER = "^—$", "^[−0-9]"
LOADED = 150e3  # ms for what takes a tenth of a second on an idle machine, and a compilation on a new one


@pytest.mark.long
def test_a_silent_device_is_a_dash_on_the_page_and_the_others_live(browser: Browser) -> None:
    with rig() as made, browser.new_context(viewport=SIZE) as context:
        page = context.new_page()
        page.goto(made.url)
        page.click("[data-act=connect]", timeout=LOADED)
        page.wait_for_selector("[data-act=prove][aria-disabled=false]", timeout=LOADED)
        shown(page, "angle", NUMBER)
        shown(page, "shaft", NUMBER)

        assert made.ask(do="mute", line="torque")["ok"]
        shown(page, "shaft", DASH)
        shown(page, "angle", NUMBER)
        heal(made, page)

        assert made.ask(do="drop", identifier=0x281)["ok"]  # the motor's position; its torque still comes
        for tile in ("angle", "speed", "motor"):
            shown(page, tile, DASH)
        shown(page, "shaft", NUMBER)
        page.wait_for_selector("#chain:has-text('not known')", timeout=LOADED)
        heal(made, page)


def heal(made: Rig, page: Page) -> None:
    """All devices tell again, and nothing else has to be done for the page to show it: nothing was energised."""
    assert made.ask(do="heal")["ok"]
    for tile in ("angle", "speed", "motor", "shaft"):
        shown(page, tile, NUMBER)


def shown(page: Page, tile: str, what: str) -> None:
    """The tile's number becomes `what`, a pattern."""
    page.wait_for_selector(f"[data-tile={tile}] .value > span:text-matches('{what}')", timeout=LOADED)
