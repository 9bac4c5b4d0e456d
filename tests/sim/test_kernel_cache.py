"""The compiled kernel on disk: never used once any file of its package has changed, used again when none has."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import sim
from sim.kernel.entries import text_of_the_package

ASK = """
import numpy as np
from sim import kernel
p = np.zeros(kernel.PARAMETERS)
p[[kernel.A_0, kernel.SERIES_AT, kernel.LINES_AT, kernel.LINES, kernel.TERMS]] = 1.0, kernel.PARAMETERS, 0, 0, 0
value = kernel.kinematic_error(1.0, 2.0, np.append(p, np.zeros(4)))[2]
print(value, sum(kernel.kinematic_error.stats.cache_hits.values()))
"""


def ask(root: Path) -> tuple[float, int]:
    """dθ̃_p/dT̄ of a kernel read anew from `root`, and how often its cache on disk was good."""
    environment = {**os.environ, "PYTHONPATH": str(root)}
    environment.pop("NUMBA_CACHE_DIR", None)
    run = subprocess.run(
        [sys.executable, "-c", ASK], cwd=root, env=environment, capture_output=True, text=True, check=True, timeout=120
    )
    value, hits = run.stdout.split()
    return float(value), int(hits)


@pytest.mark.slow
@pytest.mark.long
def test_a_change_in_a_file_that_is_only_called_is_never_missed(tmp_path: Path) -> None:
    assert sim.__file__ is not None
    shutil.copytree(Path(sim.__file__).parent, tmp_path / "sim", ignore=shutil.ignore_patterns("__pycache__"))
    first, again = ask(tmp_path), ask(tmp_path)
    assert (first[0], first[1]) == (0.0, 0)
    assert again == (0.0, 1)
    gear = tmp_path / "sim" / "kernel" / "gear.py"
    stamp, text = gear.stat(), gear.read_text(encoding="utf-8")
    changed = text.replace("return Error(value, slope, per_load)", "return Error(value, slope, 5.0e+003)")
    assert len(changed) == len(text)
    assert changed != text
    gear.write_text(changed, encoding="utf-8")
    os.utime(gear, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))  # as old and as large as before
    for stale in (gear.parent / "__pycache__").glob("gear.*.pyc"):
        stale.unlink()  # Python's own cache does go by age and size
    assert ask(tmp_path) == (5.0e3, 0)


def test_any_character_of_any_file_is_part_of_the_key(tmp_path: Path) -> None:
    for name in ("a.py", "b.py"):
        (tmp_path / name).write_text("x = 1\n", encoding="utf-8")
    keys = {text_of_the_package(tmp_path)}
    for name in ("a.py", "b.py"):
        (tmp_path / name).write_text("x = 2\n", encoding="utf-8")
        keys.add(text_of_the_package(tmp_path))
    assert len(keys) == 3
    assert all(0 <= key < 2**63 for key in keys)
