"""Fixtures of more than one package."""

from __future__ import annotations

import os
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command line sets it, before numpy is imported

import numpy as np
import pytest
from hypothesis import settings

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


@pytest.fixture
def rng() -> np.random.Generator:
    """The same draws for every test, whatever ran before it in its process."""
    return np.random.default_rng(8)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Refuses to go on where tests of one group would be spread over the workers: what their modules make, minutes of
    it, would be made once for each."""
    together = getattr(session.config.option, "loadgroup", False)
    grouped = [item.nodeid for item in session.items if item.get_closest_marker("xdist_group")]
    apart = [name for name in grouped if "@" not in name]
    if together and apart:
        raise pytest.UsageError(f"{apart[0]}: pytest-xdist does not see its group, expected an id that ends in @group")
