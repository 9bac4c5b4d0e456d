"""A picture of the live view as Chromium shows it: python -m tests.live.photograph RUN PICTURE.png [WIDTH HEIGHT]."""

from __future__ import annotations

import io
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from tests.chromium import chromium

ARGUMENTS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",  # WebGL by the processor
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
]
STILL = 15.0  # s the picture must not have changed: drawn by the processor, one frame can take a second
PATIENCE = 300.0  # s
NOISE, SAME = 24, 1e-4  # brightness of 255 and share of the pixels: a spinning sign is no change
BAR = 40  # px at the top: the viewer's own, with a clock in it


def photograph(run: Path, picture: Path, width: int = 1600, height: int = 900) -> list[str]:
    """The run's view once all of it is drawn, as PNG; addresses on other machines that answered."""
    command = [sys.executable, "-m", "rig.cli", "view", str(run), "--web"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as view:
        try:
            assert view.stderr is not None
            return _taken(_address(view.stderr), picture, width, height)
        finally:
            view.terminate()


def _address(lines: Any) -> str:
    for line in lines:
        if line.startswith("http://"):
            return str(line).strip()
    raise RuntimeError("hdrig view said no address")


def _taken(url: str, picture: Path, width: int, height: int) -> list[str]:
    from playwright.sync_api import sync_playwright

    answered: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=ARGUMENTS)
        page = browser.new_page(viewport={"width": width, "height": height})
        page.on("response", lambda response: answered.append(response.url))
        page.goto(url, timeout=60_000)
        picture.write_bytes(_still(page))
        browser.close()
    return [url for url in answered if not url.startswith("http://127.0.0.1:")]


def _still(page: Any) -> bytes:
    """The page once it has come to rest. Raises TimeoutError."""
    began = changed = time.monotonic()
    before = np.empty((0, 0))
    while time.monotonic() - began < PATIENCE:
        shot = page.screenshot(timeout=60_000)
        now = _pixels(shot)
        if before.shape != now.shape or (abs(before - now) > NOISE).mean() > SAME:
            before, changed = now, time.monotonic()
        elif time.monotonic() - changed > STILL and _drawn(now):
            return bytes(shot)
        time.sleep(3.0)
    raise TimeoutError(f"the view still changes after {PATIENCE:.0f} s")


def _pixels(png: bytes) -> np.ndarray[Any, Any]:
    from PIL import Image

    return np.asarray(Image.open(io.BytesIO(png)).convert("L"), dtype=np.int16)[BAR:]


def _drawn(pixels: np.ndarray[Any, Any]) -> bool:
    """More than empty panes: one pixel in fifty is bright in the left half, where the planes are."""
    left = pixels[: pixels.shape[0] // 2, : pixels.shape[1] // 2]
    return bool((left > 60).mean() > 0.02)


def share_of(picture: Path, colour: tuple[int, int, int]) -> float:
    """How much of a picture has a colour, nearly."""
    from PIL import Image

    pixels = np.asarray(Image.open(picture).convert("RGB"), dtype=np.int16)
    return float((abs(pixels - colour).max(axis=-1) < 12).mean())


if __name__ == "__main__":
    size = [int(word) for word in sys.argv[3:5]] or [1600, 900]
    print(photograph(Path(sys.argv[1]), Path(sys.argv[2]), *size) or "no other host was asked")
