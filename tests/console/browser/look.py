"""What a person sees of the page, in the words of the tests."""

from __future__ import annotations

import time
from collections.abc import Callable

from playwright.sync_api import Page

PATIENCE = 10.0  # s for what is only a matter of time


def until(found: Callable[[], bool], what: str, patience: float = PATIENCE) -> None:
    """Wait for something that no selector says; `patience` in s."""
    end = time.monotonic() + patience
    while not found():
        assert time.monotonic() < end, f"never came: {what}"
        time.sleep(0.02)


def in_state(page: Page, state: str, timeout: float = 30.0) -> None:
    """Wait until the page says that state."""
    page.wait_for_selector(f"html[data-state={state}]", state="attached", timeout=1e3 * timeout)


def enabled(page: Page) -> set[str]:
    """The acts whose button may be pressed, of the buttons that are there."""
    buttons = page.locator("[data-act]").all()
    return {b.get_attribute("data-act") or "" for b in buttons if b.get_attribute("aria-disabled") == "false"}


def text(page: Page, selector: str) -> str:
    """As the page has it, hidden or not."""
    return page.locator(selector).first.text_content() or ""
