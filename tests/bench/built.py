"""What the bench alone builds and installs, under build/bench: C floors and the peers' environment."""

from __future__ import annotations

import ctypes
import subprocess
import sys
import sysconfig
from functools import cache
from pathlib import Path

HERE = Path(__file__).parent
BUILD = HERE.parents[1] / "build" / "bench"
VENV = BUILD / "venv"
FLAGS = ("-O3", "-march=native", "-ffp-contract=fast", "-fno-math-errno")


class Unavailable(Exception):
    """A floor or a peer that cannot be had on this machine, in words."""


def built(source: str, *flags: str, kind: tuple[str, ...] = ("-shared", "-fPIC")) -> Path:
    """`floors/<source>.c` compiled. Raises Unavailable."""
    target = BUILD / "".join([source, *flags]).replace("/", "_")
    BUILD.mkdir(parents=True, exist_ok=True)
    command = ["gcc", *FLAGS, *kind, *flags, "-o", str(target), str(HERE / "floors" / f"{source}.c"), "-lm"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError as error:
        raise Unavailable("no gcc on this machine") from error
    if done.returncode:
        raise Unavailable(f"gcc refused {source}.c: {done.stderr.strip().splitlines()[0]}")
    return target


def floor(source: str, *flags: str) -> ctypes.CDLL:
    """The compiled floor as a library. Raises Unavailable."""
    return ctypes.CDLL(str(built(source, *flags)))


@cache
def peers() -> tuple[Path, str]:
    """The peers' Python, and what could not be installed, in words. Each is tried by itself: one may fail. Where there
    is no network every one does, within half a minute, and the rows that need one say so.
    """
    python, mark = VENV / "bin" / "python", VENV / "installed.txt"
    wanted = [line for line in (HERE / "requirements.txt").read_text(encoding="utf-8").splitlines() if line.strip()]
    if not python.exists() and subprocess.run([sys.executable, "-m", "venv", str(VENV)], check=False).returncode:
        return python, "no environment for peers could be made here: python -m venv failed"
    _also(VENV)
    if mark.exists() and mark.read_text(encoding="utf-8").splitlines()[:-1] == wanted:
        return python, mark.read_text(encoding="utf-8").splitlines()[-1]
    refused = [line for line in wanted if not _install(python, line)]
    words = f"could not be installed here: {', '.join(refused)}" if refused else "all peers installed"
    mark.write_text("\n".join([*wanted, words]), encoding="utf-8")
    return python, words


def _also(venv: Path) -> None:
    """What the peers' environment lacks comes from ours, behind its own packages: the readers of a run folder."""
    (own,) = venv.glob("lib/python*/site-packages")
    (own / "hdrig.pth").write_text(f"{sysconfig.get_paths()['purelib']}\n", encoding="utf-8")


def _install(python: Path, requirement: str) -> bool:
    command = [str(python), "-m", "pip", "install", "--quiet", "--retries", "1", "--timeout", "10", requirement]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0
