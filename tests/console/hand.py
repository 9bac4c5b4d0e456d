"""A hand on the console's buttons: what a page would send, without a browser."""

from __future__ import annotations

import asyncio
import threading
import time
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
from websockets.sync.client import ClientConnection, connect

from rig.console.server import Serving

PATIENCE = 90.0  # s of wall time: a loaded machine takes seconds to start a process
GOES_ON = ["console.page_lost=continue"]  # these hands send no signs of life
SHORT = {"amplitude_deg": 360.0, "frequency": 0.1, "cycles": 1.0}  # 24 rpm, 11 s of rig time
FOREVER = {"amplitude_deg": 3600.0, "frequency": 0.001, "cycles": 1.0}  # 1000 s of rig time: somebody has to end it


class Hand:
    """One page's calls. Use as a context manager: the station lives as long."""

    def __init__(self, root: Path, host: str = "127.0.0.1", names: tuple[str, ...] = ()) -> None:
        self.serving = Serving(host, 0, root, "twin", names)
        self.token, self.port = self.serving.access.token, self.serving.access.port
        headers = {"x-hdrig-token": self.token, "x-hdrig-page": "first"}
        self.client = httpx.Client(base_url=f"http://127.0.0.1:{self.port}", headers=headers, timeout=PATIENCE)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._serve)

    def __enter__(self) -> Hand:
        self._thread.start()
        self.until(lambda state: not state["job"])
        return self

    def __exit__(self, *error: object) -> None:
        self._loop.call_soon_threadsafe(self.serving.ask_end)
        self._thread.join(PATIENCE)
        self.client.close()
        self._loop.close()

    def _serve(self) -> None:
        self._loop.run_until_complete(self.serving.serve())

    def listen(self) -> ClientConnection:
        """A websocket that has not said who it is."""
        return connect(f"ws://127.0.0.1:{self.port}/api/live")

    def state(self) -> dict[str, Any]:
        """State as this page sees it."""
        found: dict[str, Any] = self.client.get("/api/state").json()
        return found

    def ask(self, act: str, page: str = "first", **more: Any) -> tuple[int, dict[str, Any]]:
        """POST an act on the present revision, with an id of its own; status and answer."""
        body = {"id": str(uuid.uuid4()), "based_on": self.state()["revision"], "act": act, **more}
        said = self.client.post("/api/act", json=body, headers={"x-hdrig-page": page})
        return said.status_code, said.json()

    def do(self, act: str, **more: Any) -> None:
        """An act that has to be accepted."""
        status, said = self.ask(act, **more)
        assert status == 200, said

    def until(self, seen: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        """State once `seen` holds of it."""
        give_up = time.monotonic() + PATIENCE
        while not seen(state := self.state()):
            assert time.monotonic() < give_up, state
            time.sleep(0.02)
        return state

    def finish(self, act: str, **more: Any) -> dict[str, Any]:
        """An act, and State when it is over."""
        self.do(act, **more)
        return self.until(lambda state: not state["job"])

    def connect(self, clock: str = "virtual", overrides: tuple[str, ...] = (), bench: str = "twin") -> dict[str, Any]:
        """The twin, whose runs go on without a page."""
        return self.finish("connect", bench=bench, clock=clock, overrides=[*GOES_ON, *overrides])

    def prove(self) -> None:
        """What every run needs first."""
        assert self.finish("prove")["proof"]

    def prompt(self, text: str = "") -> dict[str, Any]:
        """The open prompt that asks for `text`: the one answered last stays in State until the station has gone on."""
        asked: dict[str, Any] = self.until(lambda s: s["prompt"] and text in s["prompt"]["text"])["prompt"]
        return asked

    def made(self, text: str) -> None:
        """The change that is asked for in `text` is said to be made."""
        self.do("answer", prompt_id=self.prompt(text)["id"], done=True)

    def told(self, kind: str) -> list[str]:
        """Events of that kind, as sentences."""
        return [event["text"] for event in self.state()["events"] if event["kind"] == kind]
