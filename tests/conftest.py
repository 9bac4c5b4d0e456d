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
