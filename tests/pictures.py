"""The pictures of the README, from real runs on the twin: python -m tests.pictures [console report trace view].

Every picture is of a run made for it: the console's and the live view's in real time over CAN, the others on virtual
time. Five and a half minutes in all were measured on two cores (20 November 2026, load 3 to 8).
"""

from __future__ import annotations

import io
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

from tests.chromium import ARGUMENTS, chromium
from tests.console.browser.rigs import HDRIG, QUIET, rig
from tests.live.photograph import photograph

PLACE = Path(__file__).parent.parent / ".readme"
DESK = (1600, 900)
SHEET = (1200, 2400)  # px of a report: verdict, figures, down to the end of its first drawing
MARGIN = 24  # px below it
SHOWN = 0.75  # of a sheet's size in the README
ATTEMPTS = 4
INTO = 50.0  # s into the run: three whole turns forward, five in reverse
EFFECT = "twin.effects.load_dependent_error.A_inf=0.5"  # half the error is left under load; the trace has to find it


def console(picture: Path, folder: Path) -> None:
    """The operator's page in the middle of a slow run over CAN."""
    with rig() as made, sync_playwright() as playwright:
        page = _page(playwright, *DESK)
        page.goto(made.url)
        page.click("[data-act=connect]")
        page.click("[data-act=tare]", timeout=120e3)
        page.wait_for_selector("[data-step=tare][data-done=true]", state="attached", timeout=120e3)
        for name, value in (("amplitude_deg", "1080"), ("frequency", "0.0133")):  # 9.6 rpm
            page.fill(f"#parameter-{name}", value)
        for _ in range(ATTEMPTS):  # a run that ends because the machine stalled is made again
            page.click("#start", timeout=120e3)
            page.wait_for_selector("#run-folder:has-text('kinematic'):not(:has-text('last'))", timeout=120e3)
            page.wait_for_timeout(1e3 * INTO)
            if page.get_attribute("html", "data-state") == "running":
                break
            page.click("#reset", timeout=120e3)
        page.fill("#note-text", "housing 24 °C")
        page.click("[data-act=note]")
        page.wait_for_timeout(2e3)
        page.mouse.move(5, 5)
        _keep(page.screenshot(), picture)
        page.keyboard.press("F4")
        page.wait_for_selector("html[data-state=ready]", state="attached", timeout=120e3)


def report(picture: Path, folder: Path) -> None:
    """The page of a slow run."""
    _hdrig("run", "kinematic-error", "--bench", "twin", "--clock", "virtual", "--out", str(folder))
    _photograph(_only(folder, "*/*kinematic*/report.html"), picture, *SHEET)


def trace(picture: Path, folder: Path) -> None:
    """What is missing, found in a campaign of a twin that has it."""
    _hdrig("campaign", "modest", "--bench", "twin", "--clock", "virtual", "--set", EFFECT, "--out", str(folder))
    _hdrig("trace", str(_only(folder, "*/campaign.json").parent), "--out", str(folder / "trace"))
    _photograph(folder / "trace" / "report.html", picture, *SHEET)


def view(picture: Path, folder: Path) -> None:
    """The live view of a run, as Rerun draws it."""
    _hdrig(
        "run", "kinematic-error", "--bench", "twin", "--clock", "virtual", "--with", "cycles=1", "--out", str(folder)
    )
    photograph(_only(folder, "*/*kinematic*/manifest.json").parent, picture, *DESK)
    _keep(picture.read_bytes(), picture)


PICTURES: dict[str, Callable[[Path, Path], None]] = {f.__name__: f for f in (console, report, trace, view)}


def _page(playwright: object, width: int, height: int) -> Page:
    browser = playwright.chromium.launch(executable_path=chromium(), args=ARGUMENTS)  # type: ignore[attr-defined]
    page: Page = browser.new_page(viewport={"width": width, "height": height})
    return page


def _photograph(file: Path, picture: Path, width: int, height: int) -> None:
    with sync_playwright() as playwright:
        page = _page(playwright, width, height)
        page.goto(file.as_uri())
        drawing = page.locator("figure").first.bounding_box()
        assert drawing
        bottom = drawing["y"] + drawing["height"] + MARGIN
        clip = {"x": 0.0, "y": 0.0, "width": float(width), "height": bottom}
        _keep(page.screenshot(full_page=True, clip=clip), picture, SHOWN)  # type: ignore[arg-type]


def _hdrig(*words: str) -> None:
    """Exit codes from 1 to 9 are verdicts: a gear may be out of limits in a picture too."""
    code = subprocess.run([*HDRIG, *words], env=QUIET, stdout=subprocess.DEVNULL).returncode
    if code > 9:
        raise SystemExit(f"hdrig {' '.join(words)} ended with {code}")


def _only(folder: Path, pattern: str) -> Path:
    (found,) = folder.glob(pattern)
    return found


def _keep(png: bytes, picture: Path, scale: float = 1.0) -> None:
    """256 colours are enough for a page, and a third of the size."""
    image = Image.open(io.BytesIO(png)).convert("RGB")
    size = (round(scale * image.width), round(scale * image.height))
    shown = image.resize(size, Image.Resampling.LANCZOS) if scale != 1.0 else image
    shown.quantize(256, kmeans=4, dither=Image.Dither.NONE).save(picture, optimize=True)


def main(names: list[str]) -> None:
    """Those named, or all."""
    PLACE.mkdir(exist_ok=True)
    for name in names or list(PICTURES):
        with tempfile.TemporaryDirectory(prefix="hdrig-", dir="/tmp") as folder:
            PICTURES[name](PLACE / f"{name}.png", Path(folder))
        print(PLACE / f"{name}.png", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
