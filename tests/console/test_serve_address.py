"""What `hdrig serve` prints can be opened, wherever it listens."""

from __future__ import annotations

import socket
from pathlib import Path

import httpx
import pytest

from rig.console.access import Access, called
from tests.console.hand import Hand


@pytest.mark.slow
def test_a_server_for_everybody_prints_an_address_that_can_be_opened(tmp_path: Path) -> None:
    with Hand(tmp_path, host="0.0.0.0") as hand:
        url, _, token = hand.serving.lines[0].removeprefix("console ").partition("/#token=")
        assert url == f"http://{socket.gethostname().lower()}:{hand.port}"
        assert httpx.get(f"{url}/api/state", headers={"x-hdrig-token": token}).status_code == 200


@pytest.mark.slow
def test_a_server_for_others_says_that_tls_ends_elsewhere_and_where(tmp_path: Path) -> None:
    with Hand(tmp_path, host="0.0.0.0", names=("rig.lab.example",)) as hand:
        first, proxy, warning = hand.serving.lines
    assert "0.0.0.0" not in first
    assert proxy.startswith(f"console https://rig.lab.example/#token={hand.token} ")
    assert "TLS does not end here" in warning


def test_a_server_of_this_machine_alone_has_nothing_to_warn_of() -> None:
    assert called("127.0.0.1") == "127.0.0.1"
    here = Access("t", "0.0.0.0", 8765)
    assert here.refuse_host({"host": f"{called('::')}:8765"}) == ""
    assert "not the host" in here.refuse_host({"host": f"{called('::')}:80"})
    assert "not the host" in here.refuse_host({"host": "rebound.example:8765"})
