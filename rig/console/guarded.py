"""Around every request: wrong host or origin is turned away, and every answer says what its page may load."""

from __future__ import annotations

from typing import Any, final
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rig.console.access import POLICY, REPORT_POLICY, TOKEN_HEADER, Access

REFUSED = 4403  # websocket close code
FIXED = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}


@final
class Guarded:
    """ASGI middleware. Static files need no token: there is nothing in them that is not in the repository."""

    def __init__(self, app: ASGIApp, access: Access, viewer: str = "") -> None:
        self._app, self._access = app, access
        self._policy = POLICY.format(viewer=viewer).strip()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Checked before anything is read."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        status, why = self._refused(scope, headers)
        if why and scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": REFUSED, "reason": why[:120]})
            return
        if why:
            await JSONResponse({"accepted": False, "why": why}, status)(scope, receive, self._sealed(scope, send))
            return
        await self._app(scope, receive, send if scope["type"] == "websocket" else self._sealed(scope, send))

    def _refused(self, scope: Scope, headers: Headers) -> tuple[int, str]:
        why = self._access.refuse_host(headers) or self._access.refuse_origin(headers)
        if why:
            return 403, why
        path = scope["path"]
        if scope["type"] == "http" and (path.startswith(("/api/", "/runs/")) or scope["method"] not in ("GET", "HEAD")):
            return 401, self._access.refuse_token(self._token(scope, headers))
        return 200, ""

    def _token(self, scope: Scope, headers: Headers) -> str | None:
        """In a header; for a report, which is opened by a link, in the query."""
        said = headers.get(TOKEN_HEADER)
        if said is None and scope["method"] == "GET" and scope["path"].startswith("/runs/"):
            found = parse_qs(scope["query_string"].decode("latin-1")).get("token")
            said = found[0] if found else None
        return said

    def _sealed(self, scope: Scope, send: Send) -> Send:
        policy = REPORT_POLICY if scope["path"].startswith("/runs/") else self._policy

        async def sealed(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers: Any = MutableHeaders(scope=message)
                for name, value in FIXED.items():
                    headers[name] = value
                headers["content-security-policy"] = policy
            await send(message)

        return sealed
