"""uvicorn with our own way to end: a Ctrl-C brings the motor to rest first, a second takes the torque off."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import signal
import socket
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, final

import uvicorn

from rig.console.access import Access, called, is_loopback, new_token
from rig.console.app import Console
from rig.core.errors import NotReady, UsageError
from rig.live.view.viewer import Viewer

LONGEST_STOP = 120.0  # s: a wound-up gear is let out along its ramp, then the run is closed
HIGHEST = 65535  # 16 bits
GOODBYE = 1  # s pages have to close their lines


@final
class Server(uvicorn.Server):
    """Leaves signals to us."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Not taken."""
        yield


@final
class Serving:
    """One `hdrig serve`."""

    def __init__(
        self, host: str, port: int, root: Path, offered: str, names: tuple[str, ...] = (), viewer: Viewer | None = None
    ) -> None:
        """Raises NotReady when nothing can listen there, UsageError where there is no such port."""
        self._socket = _listen(host, port)
        port = self._socket.getsockname()[1]
        self.access = Access(new_token(), host, port, names)
        self.console = Console(self.access, root, offered, viewer)
        config = uvicorn.Config(
            self.console.app, log_level="error", access_log=False, ws_ping_interval=5.0, ws_ping_timeout=10.0,
            timeout_graceful_shutdown=GOODBYE, ws_max_size=65_536, server_header=False,
            ws_per_message_deflate=False,  # a line of this machine: packing costs time, unpacking a flood memory
        )  # fmt: skip
        self._server = Server(config)
        self.console.link.lost = _tell
        self._asked = 0  # times somebody asked for the end
        self._ending: asyncio.Task[None] | None = None
        self._run: dict[str, Any] | None = None  # that which went on when the end was asked for

    @property
    def lines(self) -> list[str]:
        """What a person has to know: an address that can be opened, with the token that is printed nowhere else."""
        name, port, token = called(self.access.host), self.access.port, self.access.token
        found = [f"console http://{f'[{name}]' if ':' in name else name}:{port}/#token={token}"]
        if is_loopback(self.access.host):
            return found
        return [
            *found,
            *(f"console https://{proxy}/#token={token} by the proxy that ends TLS" for proxy in self.access.names),
            "others reach this address, and TLS does not end here: from here to a browser nothing is encrypted, the "
            "token neither. Let a reverse proxy end TLS in front of it (--name its.name), or keep to 127.0.0.1 and use "
            f"ssh -L {port}:127.0.0.1:{port}",
        ]

    async def run(self) -> None:
        """Until a signal."""
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, self.ask_end)
        loop.add_signal_handler(signal.SIGQUIT, self.ask_end, True)
        await self.serve()

    async def serve(self) -> None:
        """Until `ask_end`."""
        await self._server.serve(sockets=[self._socket])

    def ask_end(self, at_once: bool = False) -> None:
        """Once: stop (category 1), then close. Twice, or `at_once`: halt."""
        self._asked += 2 if at_once else 1
        link = self.console.link
        (link.switches.stop if self._asked == 1 else link.switches.halt)()
        if self._ending is None:
            self.console.closing = True
            self._run = link.picture["run"]
            self.console.pages.news()
            self._ending = asyncio.create_task(self._end())

    async def _end(self) -> None:
        if not await self.console.link.close(LONGEST_STOP):
            self.console.link.switches.halt()
            await self.console.link.close(GOODBYE)
        if self._run is not None:
            _tell(_ended(self._run, self.console.link.picture["last_run"]))
        self._server.should_exit = True


def _ended(run: Mapping[str, Any], last: Mapping[str, Any] | None) -> str:
    """What became of the run that went on when the end was asked for."""
    if last is None or last["uid"] != run["uid"]:
        return f"how the {run['title']} run ended was not told: use the hard-wired stop; its folder is {run['folder']}"
    return f"the {last['title']} run has ended: {last['reason']}; its folder is {last['folder']}"


def _tell(sentence: str) -> None:
    """On the terminal: the page may be looked at by nobody."""
    print(f"hdrig: {sentence}", file=sys.stderr, flush=True)


def _listen(host: str, port: int) -> socket.socket:
    if not 0 <= port <= HIGHEST:
        raise UsageError(f"nothing can listen at port {port}: ports go from 0, which finds a free one, to {HIGHEST}")
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        made = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)  # named, or asyncio leaves Nagle on
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            made.bind((host, port))
            made.listen(128)
        except OSError:
            made.close()
            raise
    except OSError as error:
        why = f"nothing can listen at {host}, port {port}: {error.strerror}"
        other = "; --port 0 finds a free one" if error.errno in (errno.EADDRINUSE, errno.EACCES) else ""
        raise NotReady(f"{why}{other}") from None
    return made
