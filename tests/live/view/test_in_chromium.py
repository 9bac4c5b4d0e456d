"""The view as a browser shows it: curves and planes are drawn, and nobody else is asked for anything."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.chromium import chromium
from tests.live.photograph import photograph, share_of
from tests.live.view.test_recording import folder

__all__ = ["folder"]  # a fixture

FORWARD, ERROR, SIMULATED = (0x74, 0xB6, 0xF2), (0x5F, 0xC7, 0x9A), (0xC9, 0xA0, 0xEA)


@pytest.mark.long
@pytest.mark.skipif(chromium() is None, reason="there is no Chromium on this machine")
def test_chromium_draws_planes_and_curves_says_simulated_and_asks_no_other_machine(
    folder: Path, tmp_path: Path
) -> None:
    picture = tmp_path / "view.png"
    # in a thread of its own: beside a browser that other tests have open in this one, no second can be driven
    with ThreadPoolExecutor(1) as apart:
        assert apart.submit(photograph, folder, picture).result() == []
    for colour in (FORWARD, ERROR, SIMULATED):  # the mean over a turn, θ̃ over time, the word
        assert share_of(picture, colour) > 1e-5
