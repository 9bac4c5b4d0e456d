"""The pages there are: who is connected, who gave a sign of life, what each is sent."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections import Counter
from collections.abc import Callable
from typing import Any, final

from starlette.websockets import WebSocket, WebSocketDisconnect

from rig.console.access import Access
from rig.console.desk import ActDesk
from rig.console.feed import Feed

FIRST_WORD = 5.0  # s a page has to say who it is
STEP = 0.05  # s: samples 20 times a second
STATE_EVERY = 0.2  # s: State at least five times a second
GRACE = 5.0  # s a page that was in control may take to come back: a reload
UNKNOWN = 4401  # websocket close code: no token, or a wrong one
LONGEST_WORD = 4096  # characters
PACE = 0.01  # s between two words of a page, which has twenty a second to say: one that floods waits at its own end


@final
class Pages:
    """All websockets. `state(page, seq)` composes what one of them is shown."""

    def __init__(self, access: Access, desk: ActDesk, feed: Feed, state: Callable[[str, int], dict[str, Any]]) -> None:
        self._access, self._desk, self._feed, self._state = access, desk, feed, state
        self._open: Counter[str] = Counter()
        self._news = 0  # counts what every page has to be told at once

    def news(self) -> None:
        """Something changed."""
        self._news += 1

    async def serve(self, socket: WebSocket) -> None:
        """One page, until it goes."""
        await socket.accept()
        page = await self._who(socket)
        if page is None:
            with contextlib.suppress(RuntimeError):
                await socket.close(UNKNOWN, "the token is missing or wrong")
            return
        self._come(page)
        writer = asyncio.create_task(self._write(socket, page))
        try:
            await self._hear(socket)
        finally:
            writer.cancel()
            with contextlib.suppress(asyncio.CancelledError, RuntimeError, WebSocketDisconnect):
                await writer
            self._go(page)

    async def _who(self, socket: WebSocket) -> str | None:
        try:
            said = json.loads(await asyncio.wait_for(socket.receive_text(), FIRST_WORD))
        except (TimeoutError, ValueError, RecursionError, KeyError, WebSocketDisconnect):
            return None
        if not isinstance(said, dict) or self._access.refuse_token(str(said.get("token"))):
            return None
        return str(said.get("page") or "")[:64]

    def _come(self, page: str) -> None:
        self._open[page] += 1
        self._desk.link.switches.page_alive()
        if self._desk.gate.controller is None:
            self._desk.gate.take(page)
        self.news()

    def _go(self, page: str) -> None:
        self._open[page] -= 1
        if not self._open[page]:
            del self._open[page]
            asyncio.get_running_loop().call_later(GRACE, self._forget, page)

    def _forget(self, page: str) -> None:
        if page not in self._open:
            self._desk.gate.release(page)
            self.news()

    async def _hear(self, socket: WebSocket) -> None:
        """Every word a page says is a sign of life; nothing else is asked by this way."""
        # RuntimeError: the writer found out first that the page is gone
        with contextlib.suppress(WebSocketDisconnect, RuntimeError, KeyError):
            while True:
                if len(await socket.receive_text()) <= LONGEST_WORD:
                    self._desk.link.switches.page_alive()
                await asyncio.sleep(PACE)

    async def _write(self, socket: WebSocket, page: str) -> None:
        """A page that is slow waits here alone: samples it has no time for fall out of its queue."""
        loop, queue, seq, news, due = asyncio.get_running_loop(), self._feed.join(), 0, -1, 0.0
        try:
            while True:
                now = loop.time()
                if news != self._news or now >= due:
                    seq, news, due = seq + 1, self._news, now + STATE_EVERY
                    await socket.send_text(json.dumps(self._state(page, seq), ensure_ascii=False))
                while queue:
                    await socket.send_bytes(queue.popleft())
                await asyncio.sleep(STEP)
        finally:
            self._feed.leave(queue)
