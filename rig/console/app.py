"""The console's routes. No device is opened here; what moves anything is handed to the station."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from fastapi import FastAPI, Request, WebSocket
from fastapi.responses import FileResponse, JSONResponse
from fastapi.staticfiles import StaticFiles
from starlette.responses import Response

from rig.console.access import PAGE_HEADER, Access
from rig.console.campaigns import add_campaigns
from rig.console.described import catalogue
from rig.console.desk import ActDesk
from rig.console.feed import Feed
from rig.console.gate import Gate
from rig.console.guarded import Guarded
from rig.console.link import Link
from rig.console.pages import STEP, Pages
from rig.console.runs import add_runs
from rig.console.state import compose
from rig.live.view.viewer import Viewer

STATIC = Path(__file__).parent / "static"
LONGEST = 65_536  # bytes of a POST


class Console:
    """One server's parts: `app` is what uvicorn serves."""

    def __init__(self, access: Access, root: Path, offered: str, viewer: Viewer | None = None) -> None:
        self.link, self.gate = Link(root), Gate()
        self.desk = ActDesk(self.link, self.gate, offered)
        self.feed = Feed(self.link)
        self.pages = Pages(access, self.desk, self.feed, self.state)
        self.closing = False
        self.viewer, self._shown = viewer, ""
        self.link.changed = self._changed
        self.app = FastAPI(lifespan=self._lifespan, docs_url=None, redoc_url=None, openapi_url=None)
        self.app.add_middleware(Guarded, access=access, viewer=_origin(viewer.url) if viewer else "")
        self._routes()

    def state(self, page: str, seq: int = 0) -> dict[str, Any]:
        """State as `page` is shown it."""
        extra = {"seq": seq, "closing": self.closing, "viewer_url": self.viewer.url if self.viewer else None}
        return compose(self.link, self.feed, self.gate, page, extra)

    def _changed(self) -> None:
        run = self.link.picture["run"]
        if self.viewer is not None and run is not None and run["folder"] != self._shown:
            self._shown = run["folder"]
            self.viewer.follow(Path(self._shown))
        self.desk.look()
        self.pages.news()

    @contextlib.asynccontextmanager
    async def _lifespan(self, app: FastAPI) -> AsyncIterator[None]:
        self.link.start()
        feeding = asyncio.create_task(self._feed())
        try:
            yield
        finally:
            feeding.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await feeding
            self.link.release()

    async def _feed(self) -> None:
        while True:
            self.feed.step()
            await asyncio.sleep(STEP)

    def _routes(self) -> None:
        app = self.app

        @app.get("/")
        async def page() -> Response:
            return FileResponse(STATIC / "index.html")

        @app.get("/api/state")
        async def state(request: Request) -> Response:
            return JSONResponse(self.state(_page(request)))

        @app.get("/api/catalogue")
        async def offered() -> Response:
            return JSONResponse(await asyncio.to_thread(catalogue, self.desk.offered))

        @app.post("/api/check-parameters")
        async def check_parameters(request: Request) -> Response:
            asked = await _body(request)
            if isinstance(asked, Response):
                return asked
            return JSONResponse(await asyncio.to_thread(self.desk.check, asked))

        @app.post("/api/act")
        async def act(request: Request) -> Response:
            asked = await _body(request)
            if isinstance(asked, Response):
                return asked
            self.link.switches.page_alive()
            answer = await self.desk.act(asked, _page(request))
            return JSONResponse(answer.body, answer.status)

        @app.websocket("/api/live")
        async def live(socket: WebSocket) -> None:
            await self.pages.serve(socket)

        add_runs(app, self.link.root)
        add_campaigns(app, self.link.root)
        app.mount("/static", StaticFiles(directory=STATIC), name="static")


def _origin(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}"


def _page(request: Request) -> str:
    return request.headers.get(PAGE_HEADER, "")[:64]


async def _body(request: Request) -> dict[str, Any] | Response:
    """A JSON object, or the refusal: 413 too long, 400 no JSON, no text, or something else than an object."""
    taken = b""
    async for part in request.stream():
        taken += part
        if len(taken) > LONGEST:
            return _no_object(413)
    try:
        found = json.loads(taken)
        json.dumps(found, ensure_ascii=False).encode()  # half a character could be neither written down nor sent on
    except (ValueError, RecursionError):
        return _no_object(400)
    return found if isinstance(found, dict) else _no_object(400)


def _no_object(status: int) -> Response:
    why = f"expected a JSON object of at most {LONGEST} bytes of whole characters"
    return JSONResponse({"accepted": False, "why": why}, status)
