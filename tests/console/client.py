"""A page without a browser: it calls, and listens and gives signs of life on its websocket until it leaves."""

from __future__ import annotations

import json
import threading
import time
import uuid
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

PATIENCE = 90.0  # s of wall time: a loaded machine takes seconds to start a process


class Client:
    """`url` is what hdrig serve printed, with the token."""

    def __init__(self, url: str) -> None:
        address, _, self.token = url.partition("/#token=")
        self.client = httpx.Client(base_url=address, headers={"x-hdrig-token": self.token}, timeout=PATIENCE)
        self.frames = 0  # binary ones heard so far
        self._here = True
        self._page = threading.Thread(target=self._live, args=(address.replace("http", "ws"),), daemon=True)
        self._page.start()
        self.until(lambda state: not state["job"])

    def _live(self, address: str) -> None:
        with connect(f"{address}/api/live") as page:
            page.send(json.dumps({"token": self.token, "page": ""}))
            with suppress(OSError, ConnectionClosed):  # the server is gone, while it was heard or answered
                while self._here:
                    message = page.recv()
                    if isinstance(message, str):
                        page.send(json.dumps({"seen": json.loads(message)["seq"]}))
                    else:
                        self.frames += 1

    def leave(self) -> None:
        """The page is closed; calls can still be made."""
        self._here = False
        self._page.join(PATIENCE)

    def close(self) -> None:
        """Nobody is there any more."""
        self.leave()
        self.client.close()

    def state(self) -> dict[str, Any]:
        """State as this page sees it."""
        return dict(self.client.get("/api/state").json())

    def ask(self, act: str, **more: Any) -> httpx.Response:
        """POST an act on the present revision."""
        body = {"id": str(uuid.uuid4()), "based_on": self.state()["revision"], "act": act, **more}
        return self.client.post("/api/act", json=body)

    def do(self, act: str, **more: Any) -> None:
        """An act that has to be accepted."""
        said = self.ask(act, **more)
        assert said.status_code == 200, said.text

    def halt(self) -> tuple[float, dict[str, Any]]:
        """When it was posted [s, monotonic], and the answer."""
        body = {"id": str(uuid.uuid4()), "act": "halt"}
        began = time.monotonic()
        return began, dict(self.client.post("/api/act", json=body).json())

    def until(self, seen: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        """State once `seen` holds of it."""
        found: dict[str, Any] = until(self.state, seen)
        return found

    def finish(self, act: str, **more: Any) -> dict[str, Any]:
        """An act, and State when it is over."""
        self.do(act, **more)
        return self.until(lambda state: not state["job"])

    def start(self, procedure: str, **parameters: float) -> Path:
        """The folder of a run that has gone on for half a second, or is over."""
        self.do("start", procedure=procedure, parameters=parameters)
        state = self.until(
            lambda s: (s["run"] and s["run"]["title"] == procedure and s["run"]["t"] > 0.5) or not s["job"]
        )
        found = state["run"] or state["last_run"]
        assert found["title"] == procedure, state["events"][-3:]
        return Path(found["folder"])


def until(look: Callable[[], Any], seen: Callable[[Any], Any]) -> Any:
    """What is looked at, once `seen` holds of it."""
    give_up = time.monotonic() + PATIENCE
    while not seen(found := look()):
        assert time.monotonic() < give_up, found
        time.sleep(0.02)
    return found
