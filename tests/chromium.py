"""How Chromium is started for tests and pictures."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from playwright.sync_api import ViewportSize

# the first that is there; a page in the shell, which draws nothing nobody sees, takes a seventh of the time of a core
NAMES: Final = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
ARGUMENTS: Final = ["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
SIZE: Final[ViewportSize] = {"width": 1920, "height": 1080}  # px


def chromium() -> str | None:
    """Where it is; None where there is none."""
    return next((path for name in NAMES if (path := shutil.which(name)) is not None), None)
