"""The viewer's page from our own server: its three files, and a policy under which it talks to this machine only."""

from __future__ import annotations

import contextlib
import io
import os
import threading
import time
import urllib.request
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.metadata import version
from pathlib import Path
from typing import BinaryIO
from urllib.parse import quote, urlsplit

from rig.core.errors import NotReady
from rig.live.view.server import LOOPBACK, UP_WITHIN, cache, free_port, launch, listens

FILES = {
    "index.html": "text/html; charset=utf-8",
    "re_viewer.js": "text/javascript; charset=utf-8",
    "re_viewer_bg.wasm": "application/wasm",
}
POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "connect-src 'self' http://{host}:{port}; img-src 'self' data: blob:; worker-src 'self' blob:"
)
STARTS = "starts"  # where a page asks how often the proxy was started
AGAIN = f"""<script>
let first;
setInterval(async () => {{
  const now = await fetch("{STARTS}").then(answer => answer.text(), () => first);
  first ??= now;
  if (now !== first) location.reload();
}}, 1000);
</script>"""  # the viewer never looks again for a proxy it has lost
CLOSING = 0.05  # s between looks whether it is to end
CHUNK = 1 << 20  # bytes at a time


class Pages:
    """Serves the viewer for the recordings behind `proxy_port`, on loopback, until `close`."""

    def __init__(self, proxy_port: int, starts: Callable[[], int]) -> None:
        """`starts`: how often the proxy was started; a page that is open is loaded anew when that changes.

        Raises NotReady when the viewer's files cannot be had.
        """
        self._proxy_port = proxy_port
        self._server = ThreadingHTTPServer((LOOPBACK, 0), _handler(files(), proxy_port, starts))
        self._server.daemon_threads = True
        threading.Thread(target=self._server.serve_forever, args=(CLOSING,), daemon=True, name="pages").start()

    @property
    def url(self) -> str:
        """What to open in a browser: no welcome screen, no layout of an earlier day."""
        source = quote(f"rerun+http://{LOOPBACK}:{self._proxy_port}/proxy", safe="")
        options = f"url={source}&hide_welcome_screen&persist=0&theme=dark"
        return f"http://{LOOPBACK}:{self._server.server_address[1]}/?{options}"

    def close(self) -> None:
        """No page is served any more."""
        self._server.shutdown()
        self._server.server_close()


def files() -> Path:
    """The folder with the viewer's FILES, taken from its binary once a version. Raises NotReady."""
    folder = cache() / version("rerun-sdk")
    if all((folder / name).exists() for name in FILES):
        return folder
    folder.mkdir(parents=True, exist_ok=True)
    page, proxy = free_port(), free_port()
    ports = ["--web-viewer-port", str(page), "--port", str(proxy)]
    process = launch(["--serve-web", "--bind", LOOPBACK, *ports])
    try:
        give_up = time.monotonic() + UP_WITHIN
        while not listens(page):
            if process.poll() is not None or time.monotonic() > give_up:
                raise NotReady(f"the viewer does not give its page on {LOOPBACK}:{page} after {UP_WITHIN:.0f} s")
            time.sleep(0.02)
        for name in FILES:
            _take(f"http://{LOOPBACK}:{page}/{name}", folder / name)
    finally:
        process.kill()
        process.wait()
    return folder


def _take(url: str, path: Path) -> None:
    """One file, there whole or not at all. Raises NotReady."""
    part = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        with urllib.request.urlopen(url, timeout=UP_WITHIN) as answer, open(part, "wb") as file:
            while piece := answer.read(CHUNK):
                file.write(piece)
    except OSError as error:
        raise NotReady(f"the viewer does not give {path.name}: {error}") from error
    os.replace(part, path)


def _handler(folder: Path, proxy_port: int, starts: Callable[[], int]) -> type[BaseHTTPRequestHandler]:
    page = (folder / "index.html").read_text(encoding="utf-8") + AGAIN
    policy = POLICY.format(host=LOOPBACK, port=proxy_port)

    class Handler(BaseHTTPRequestHandler):
        """GET of one of FILES, by this machine's name only."""

        def do_GET(self) -> None:  # http.server's name
            """The page, its two files, or how often the proxy was started; 404 for anything else."""
            name = urlsplit(self.path).path.lstrip("/") or "index.html"
            host = (self.headers.get("Host") or "").rpartition(":")[0]
            if host not in (LOOPBACK, "localhost"):  # another name would be another's page
                self.send_error(404)
            elif name == STARTS:
                self._send("text/plain", io.BytesIO(str(starts()).encode()))
            elif name == "index.html":
                self._send(FILES[name], io.BytesIO(page.encode()))
            elif name in FILES:
                with open(folder / name, "rb") as file:
                    self._send(FILES[name], file)
            else:
                self.send_error(404)

        def _send(self, kind: str, body: BinaryIO) -> None:
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(body.seek(0, io.SEEK_END)))
            self.send_header("Content-Security-Policy", policy)
            self.send_header("Cache-Control", "no-cache")
            self.end_headers()
            body.seek(0)
            with contextlib.suppress(ConnectionError):  # a page that was closed in the middle
                while piece := body.read(CHUNK):
                    self.wfile.write(piece)

        def log_message(self, format: str, *args: object) -> None:
            """Nothing on the operator's terminal."""

    return Handler
