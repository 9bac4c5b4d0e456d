"""Fixtures of more than one package."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command line sets it, before numpy is imported

import numpy as np
import pytest
from hypothesis import settings

import rig.core.can_libraries  # noqa: F401  # before a test imports python-can: with all it brings it takes 1.6 s more
from rig.process.realtime import RealTime
from rig.report import page
from tests.chromium import ARGUMENTS, SIZE, chromium

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext

# shared machines stall: no deadline per example. In CI the same examples every time, elsewhere new ones.
settings.register_profile("hdrig", deadline=None, derandomize=os.environ.get("CI") == "true")
settings.load_profile("hdrig")

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of reference campaigns that lies beside a checkout (HDRIG_SHARED); skips where there is none."""
    folder = Path(os.environ.get("HDRIG_SHARED", ROOT.parent / "shared"))
    if not (folder / "cases").is_dir():
        pytest.skip(f"no reference campaigns at {folder} (set HDRIG_SHARED)")
    return folder


@pytest.fixture(scope="session", autouse=True)
def memory_is_not_locked() -> Iterator[None]:
    """A run in the process of the tests locks no memory: of all they import, three gigabytes that are only reserved
    would have to be there, and stay. `hdrig run` in a process of its own has 0.3."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(RealTime, "_lock", lambda self: "memory not locked")
        yield


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """A real Chromium, one for all tests of a process. Where there is none they are left out, and say so."""
    path = chromium()
    if path is None:
        pytest.skip("there is no Chromium on this machine: the page is not tried in a browser")
    from playwright.sync_api import sync_playwright  # a fifth of a second, of which most tests have no need

    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield found
        found.close()


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    """Pages of its own."""
    made = browser.new_context(viewport=SIZE)
    yield made
    made.close()


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pages of runs have no figures: nine tenths of what a short run's analysis takes, and many tests never look."""
    monkeypatch.setattr(page, "_plots", lambda curves, mark: [])


@pytest.fixture
def rng() -> np.random.Generator:
    """The same draws for every test, whatever ran before it in its process."""
    return np.random.default_rng(8)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_node_collection_finished(node, ids: list[str]) -> None:
    """Refuses to go on where tests of one group would be spread over the workers: what their modules make, minutes of
    it, would be made once for each. The ids of tests that pytest-xdist keeps together end in @ and their group.
    """
    if node.config.option.dist != "loadgroup" or any("@" in name for name in ids):
        return
    files = {node.config.rootpath / name.split("::")[0] for name in ids}
    marked = sorted(path for path in files if "xdist_group" in path.read_text(encoding="utf-8"))
    if marked:
        raise pytest.UsageError(f"pytest-xdist sees no group in {marked[0]}: expected ids that end in @group")
