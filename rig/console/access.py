"""Who may talk to the console: the right Host, the right Origin, the token. Looked at before anything else."""

from __future__ import annotations

import ipaddress
import secrets
import socket
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

TOKEN_HEADER = "x-hdrig-token"
PAGE_HEADER = "x-hdrig-page"
EVERYWHERE = ("0.0.0.0", "::")  # listened at, never opened
LOOPBACK = ("127.0.0.1", "localhost", "::1")
POLICY = "; ".join((
    "default-src 'none'", "script-src 'self'", "style-src 'self'", "img-src 'self' data:", "connect-src 'self'",
    "font-src 'self'", "manifest-src 'self'", "frame-src 'self' {viewer}", "base-uri 'none'", "form-action 'none'",
    "frame-ancestors 'none'",
))  # fmt: skip
# a report is one file with its style and drawings in it; it may run nothing and talk to nobody
REPORT_POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; font-src data:; sandbox"


def new_token() -> str:
    """128 bits, fit for a URL."""
    return secrets.token_urlsafe(16)


def is_loopback(host: str) -> bool:
    """True for names and addresses that only this machine reaches."""
    if host in LOOPBACK:
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def called(host: str) -> str:
    """What a browser opens to reach a server at `host`: of one that listens everywhere this machine's name."""
    return socket.gethostname().lower() if host in EVERYWHERE else host


@dataclass(frozen=True)
class Access:
    """The rules of one server. `host` is what it listens on, `names` further names it may be called by."""

    token: str
    host: str
    port: int
    names: tuple[str, ...] = ()

    def refuse_host(self, headers: Mapping[str, str]) -> str:
        """Why a request with these headers is for somebody else (DNS rebinding), or ""."""
        said = headers.get("host", "")
        return "" if self._ours(said) else f"this is not the host '{said[:100]}'"

    def refuse_origin(self, headers: Mapping[str, str]) -> str:
        """Why a request was made by a page that is not ours, or "". No Origin: no page made it."""
        said = headers.get("origin")
        if said is None:
            return ""
        scheme, _, rest = said.partition("://")
        ours = scheme in ("http", "https") and self._ours(rest)
        return "" if ours else f"a page from '{said[:100]}' may not act here"

    def refuse_token(self, given: str | None) -> str:
        """Why `given` is not the token, or ""."""
        if given is None:
            return (
                f"the token is missing: open the address that hdrig serve printed; a program sends it as {TOKEN_HEADER}"
            )
        same = secrets.compare_digest(given.encode(errors="replace"), self.token.encode())
        return "" if same else "the token is wrong: open the address that hdrig serve printed"

    def _ours(self, netloc: str) -> bool:
        """Whether a Host header, or an origin's, names this server."""
        try:
            parts = urlsplit(f"//{netloc}")
            name, port = parts.hostname or "", parts.port
        except ValueError:
            return False
        if parts.username is not None or parts.path:
            return False
        if name in self.names:
            return True  # behind a proxy that ends TLS, on whatever port
        if port not in (self.port, None):
            return False
        if is_loopback(self.host):
            return is_loopback(name)
        # bound to every address: this machine's name and any address, but no name somebody else's DNS could make ours
        return name == called(self.host) or (self.host in EVERYWHERE and _is_address(name)) or is_loopback(name)


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
