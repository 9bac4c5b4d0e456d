"""A server that says what it is told: the real page and the real gates before it, a station made up by the test."""

from __future__ import annotations

import asyncio
import json
import socket
import struct
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
import uvicorn
from fastapi import FastAPI, Request, WebSocket
from fastapi.responses import FileResponse, JSONResponse
from fastapi.staticfiles import StaticFiles
from starlette.responses import Response
from starlette.websockets import WebSocketDisconnect

from rig.console.access import Access
from rig.console.app import STATIC
from rig.console.columns import COLUMNS, HEADER, MAGIC, VERSION
from rig.console.pages import UNKNOWN
from rig.station.rules import advice, allowed
from rig.station.status import Status

TOKEN = "puppet"
STEP = 0.02  # s between two looks for something to tell
EVERY = 0.1  # s: a state at least that often
PARAMETERS = [
    {"name": "amplitude_deg", "type": "float", "unit": "deg", "default": 1440.0, "meaning": "of the motor"},
    {"name": "cycles", "type": "float", "unit": "1", "default": 2.0, "meaning": ""},
    {"name": "rates", "type": "tuple", "unit": "1", "default": [1.0, 0.3], "meaning": "shares of the rate"},
]
PROCEDURE = {"summary": "What it does", "needs_lock": False, "parameters": PARAMETERS}
OFFERED = {
    "benches": ["twin", "twin-can"],
    "procedures": [{"name": name, "title": name, **PROCEDURE} for name in ("kinematic-error", "friction")],
    "plans": [{"name": "quick", "summary": ""}],
}
BENCH = {
    "name": "twin", "source": "twin.toml", "simulated": True, "gear": "TWIN-40-50", "ratio": 50.0, "page_lost": "stop",
    "torque_sensor": True, "limits": {"speed_rpm": 600.0, "torque": 5.0, "shaft_torque": 45.0},
}  # fmt: skip
RUN = {
    "uid": "u1", "procedure": "kinematic_error", "title": "kinematic-error", "t": 50.0, "duration": 200.0,
    "left_s": 150.0, "peak_to_peak_arcsec": 93.4, "rms_following_deg": 0.142, "folder": "runs/2026-11-20/1129-ke",
    "lateness": {"p50_us": 18.0, "p99_us": 74.0, "missed": 0}, "rows": 50_000, "locked": False,
}  # fmt: skip


class Puppet:
    """`tell` changes what the station is said to be; `acts` is what pages asked for."""

    def __init__(self) -> None:
        self.picture: dict[str, Any] = {**Status().picture(), "station": True}
        self.revision = 1
        self.silent = False  # nothing is sent to any page
        self.acts: list[dict[str, Any]] = []
        self.checked: list[dict[str, Any]] = []
        self.refusal = ""  # what every act is refused with
        self.problems: dict[str, str] = {}  # what every check finds
        self.campaigns: list[dict[str, Any]] = []  # that can be gone on with
        self.frames: list[bytes] = []  # sent to every page, once
        self.controller = "this"
        listening = socket.create_server(("127.0.0.1", 0))
        self.port: int = listening.getsockname()[1]
        self.address = f"http://127.0.0.1:{self.port}/"
        config = uvicorn.Config(self._app(), log_level="error", timeout_graceful_shutdown=1, ws_ping_interval=None)
        self.server = uvicorn.Server(config)
        self.thread = threading.Thread(target=self.server.run, args=([listening],))

    @property
    def url(self) -> str:
        """As `hdrig serve` prints it."""
        return f"{self.address}#token={TOKEN}"

    def tell(self, **changes: Any) -> None:
        """The station is like this now."""
        self.picture = {**self.picture, **changes}
        self.revision += 1

    def show(self, rows: Mapping[str, np.ndarray]) -> None:
        """Send samples: columns by name, `t` among them; what is left out was not measured."""
        t = np.asarray(rows["t"], dtype="<f8")
        columns = [np.asarray(rows.get(name, np.full(len(t), np.nan)), dtype="<f4") for name, _ in COLUMNS]
        head = struct.pack(HEADER.format, MAGIC, VERSION, len(columns), len(t), 0)
        self.frames.append(head + t.tobytes() + b"".join(column.tobytes() for column in columns))

    def state(self) -> dict[str, Any]:
        """What a page is sent."""
        live = {"columns": [{"name": n, "unit": u} for n, u in COLUMNS], "age_ms": 3.0}
        acts = {**allowed(self.picture), "take_control": "this page holds control"}
        if self.controller == "other":
            acts = {act: why if act in ("stop", "halt") else "another page has it" for act, why in acts.items()}
            acts["take_control"] = True
        extra = {"revision": self.revision, "allowed": acts, "controller": self.controller, "live": live, "seq": 1}
        said = {"advice": advice(self.picture), "closing": False, "viewer_url": None, "server_ns": time.time_ns()}
        return {**said, "events": [], **self.picture, **extra}

    def _app(self) -> FastAPI:
        app = FastAPI()
        access = Access(TOKEN, "127.0.0.1", 0)

        @app.middleware("http")
        async def gate(request: Request, following: Any) -> Response:
            needs = request.url.path.startswith("/api/")
            why = access.refuse_token(request.headers.get("x-hdrig-token")) if needs else ""
            return JSONResponse({"why": why}, 401) if why else await following(request)

        @app.get("/")
        async def page() -> Response:
            policy = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'"
            return FileResponse(STATIC / "index.html", headers={"content-security-policy": policy})

        @app.get("/api/catalogue")
        async def offered() -> Any:
            return OFFERED

        @app.get("/api/campaigns")
        async def campaigns() -> Any:
            return {"campaigns": self.campaigns}

        @app.get("/api/runs")
        async def runs() -> Any:
            return {"runs": self.picture.get("runs", [])}

        @app.post("/api/check-parameters")
        async def check(request: Request) -> Any:
            self.checked.append(await request.json())
            margin = {"what": "travel", "asked": 1440.0, "limit": 144000.0, "unit": "deg", "fraction": 0.01}
            sums = {"duration_s": 201.0, "stored_j": 0.00062, "nearest": "motor speed", "left": 0.984}
            told = {"plan": ["duration 201 s"], "margins": [margin], "sums": sums}
            return {"ok": not self.problems, "problems": self.problems, **told}

        @app.post("/api/act")
        async def act(request: Request) -> Response:
            self.acts.append(await request.json())
            if self.refusal:
                return JSONResponse({"accepted": False, "why": self.refusal}, 409)
            return JSONResponse({"accepted": True, "seen_by_loop_ms": 2.0, "revision": self.revision})

        @app.websocket("/api/live")
        async def live(line: WebSocket) -> None:
            await line.accept()
            if json.loads(await line.receive_text()).get("token") != TOKEN:
                await line.close(UNKNOWN)
                return
            try:
                await self._talk(line)
            except (WebSocketDisconnect, RuntimeError):
                return

        app.mount("/static", StaticFiles(directory=STATIC))
        return app

    async def _talk(self, line: WebSocket) -> None:
        told, at, sent = 0, 0.0, 0
        while not self.server.should_exit:
            there = len(self.frames)  # those that come later come after the state that was told before them
            if not self.silent and (told != self.revision or time.monotonic() - at > EVERY):
                told, at = self.revision, time.monotonic()
                await line.send_text(json.dumps(self.state()))
            while sent < there:
                await line.send_bytes(self.frames[sent])
                sent += 1
            await asyncio.sleep(STEP)


@contextmanager
def puppet() -> Iterator[Puppet]:
    """One that serves until the block is left."""
    made = Puppet()
    made.thread.start()
    try:
        yield made
    finally:
        made.server.should_exit = True
        made.thread.join(10)
