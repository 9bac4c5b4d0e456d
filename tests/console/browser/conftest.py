"""The console's pages, opened in a real Chromium."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import BrowserContext, Page

from tests.console.browser.puppet import Puppet, puppet

Open = Callable[..., Page]


@pytest.fixture
def wrong() -> list[str]:
    """What went wrong in a page, in its own words."""
    return []


@pytest.fixture
def open_page(context: BrowserContext, wrong: list[str]) -> Open:
    """Opens an address and waits until the page hears its server."""

    def opened(url: str, link: str = "live") -> Page:
        page = context.new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.goto(url)
        page.wait_for_selector(f"html[data-link={link}]", state="attached")
        return page

    return opened


@pytest.fixture
def station() -> Iterator[Puppet]:
    with puppet() as made:
        yield made


@pytest.fixture
def page(open_page: Open, station: Puppet, wrong: list[str]) -> Iterator[Page]:
    """The page on a made-up station; nothing may go wrong in it."""
    found = open_page(station.url)
    yield found
    assert wrong == []
