"""Which software made a run, version, commit, whether the tree had changes; and who was at the keyboard."""

from __future__ import annotations

import contextlib
import getpass
import platform
import subprocess
from pathlib import Path
from typing import Any

from rig import __version__


def software() -> dict[str, Any]:
    """Version, commit and whether the tree had changes, of the code that made the run."""
    here = Path(__file__).parent

    def git(*args: str) -> str | None:
        with contextlib.suppress(OSError, subprocess.SubprocessError):
            done = subprocess.run(["git", *args], cwd=here, capture_output=True, text=True, timeout=5, check=True)
            return done.stdout.strip()
        return None

    inside = git("ls-files", "software.py") == "software.py"  # else hdrig lies in somebody else's repository
    commit = git("rev-parse", "HEAD") if inside else None
    dirty = bool(git("status", "--porcelain", "--untracked-files=no")) if commit else None
    return {"version": __version__, "commit": commit, "dirty": dirty, "python": platform.python_version()}


def operator() -> str | None:
    """Who is logged in."""
    with contextlib.suppress(OSError, KeyError):
        return getpass.getuser()
    return None
