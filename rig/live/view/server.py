"""The viewer's own process: a proxy for pages, or a window. On loopback, without a word to anybody else."""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import socket
import subprocess
import time
from abc import ABC, abstractmethod
from importlib.util import find_spec
from pathlib import Path

from rig.core.errors import NotReady

LOOPBACK = "127.0.0.1"
MEMORY = "256MB"  # what the proxy keeps for a page that comes late: about 20 min at 1 kHz; then the oldest goes
WINDOW_MEMORY = "1GB"
UP_WITHIN = 10.0  # s for a process of 300 MB to listen; 0.3 s on a quiet machine
PR_SET_PDEATHSIG = 1  # prctl: the signal a child gets when its parent is gone


class Server(ABC):
    """Started again on the same port when it was killed: a page finds it where it was."""

    def __init__(self) -> None:
        self.port = free_port()
        self.starts = 0  # how often it was started
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        """Where recordings go."""
        return f"rerun+http://{LOOPBACK}:{self.port}/proxy"

    @property
    def runs(self) -> bool:
        """True while the process lives; one that is frozen lives."""
        return self._process is not None and self._process.poll() is None

    @property
    def wanted(self) -> bool:
        """False when somebody closed it on purpose: then it is not started again."""
        return self._process is None or self._process.poll() != 0

    @property
    def pid(self) -> int:
        """Of the process that serves; 0 when there is none."""
        return self._process.pid if self._process else 0

    def start(self) -> None:
        """Start it and wait until it listens. Raises NotReady."""
        self.stop()
        self.starts += 1
        self._process = launch([*self.options(), "--port", str(self.port)])
        give_up = time.monotonic() + UP_WITHIN
        while not listens(self.port):
            if not self.runs or time.monotonic() > give_up:
                self.stop()
                raise NotReady(f"the viewer does not listen on {LOOPBACK}:{self.port} after {UP_WITHIN:.0f} s")
            time.sleep(0.02)

    def stop(self) -> None:
        """End it at once, frozen or not. Idempotent."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    @abstractmethod
    def options(self) -> list[str]:
        """The viewer's command line, without the port."""


class Proxy(Server):
    """Takes recordings and hands them to every page that asks."""

    def options(self) -> list[str]:
        return ["--serve-grpc", "--bind", LOOPBACK, "--server-memory-limit", MEMORY]


class Window(Server):
    """The native viewer, which takes recordings itself."""

    def start(self) -> None:
        if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            raise NotReady("there is no screen for a window (neither DISPLAY nor WAYLAND_DISPLAY); a page works: web")
        super().start()

    def options(self) -> list[str]:
        return ["--bind", LOOPBACK, "--memory-limit", WINDOW_MEMORY]


def launch(options: list[str]) -> subprocess.Popen[bytes]:
    """The viewer's binary itself: killing the script that wraps it would leave it running. Raises NotReady."""
    try:
        return subprocess.Popen(
            [str(binary()), *options],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "XDG_CONFIG_HOME": str(quiet_home())},
            process_group=0,  # a Ctrl-C in the terminal is not meant for it
            preexec_fn=_die_with_parent,
        )
    except OSError as error:
        raise NotReady(f"the viewer cannot be started: {error.strerror}") from error


def binary() -> Path:
    """Where the viewer is. Raises NotReady."""
    package = find_spec("rerun_cli")
    for folder in (package.submodule_search_locations or []) if package else []:
        if (found := Path(folder) / "rerun").exists():
            return found
    raise NotReady("the viewer (rerun-sdk) is not installed")


def cache() -> Path:
    """A folder of the user's for what can be made again."""
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(home) / "hdrig" / "viewer"


def quiet_home() -> Path:
    """A configuration of our own in which the viewer's usage statistics are off; the user's is not touched."""
    home = cache() / "config"
    if not (home / "rerun" / "analytics.json").exists():
        home.mkdir(parents=True, exist_ok=True)
        subprocess.run(
            [str(binary()), "analytics", "disable"],
            env={**os.environ, "XDG_CONFIG_HOME": str(home)},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=UP_WITHIN,
            check=False,
        )
    return home


def free_port() -> int:
    """A port on loopback nobody has now."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        return int(probe.getsockname()[1])


def listens(port: int) -> bool:
    """True when somebody answers on loopback."""
    with contextlib.closing(socket.socket()) as probe:
        probe.settimeout(0.5)
        return probe.connect_ex((LOOPBACK, port)) == 0


def _die_with_parent() -> None:
    with contextlib.suppress(AttributeError, OSError):  # no prctl: closing the bridge properly ends it too
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
