"""A real Chromium, and the pages opened in it. Where there is none the tests are left out, and say so."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, sync_playwright

from tests.console.browser.puppet import Puppet, puppet

ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
SIZE = {"width": 1920, "height": 1080}
Open = Callable[..., Page]


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if path is None:
        pytest.skip("there is no Chromium on this machine: the page is not tried in a browser")
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield found
        found.close()


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    made = browser.new_context(viewport=SIZE)
    yield made
    made.close()


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
