"""Who may talk to the console, without any socket."""

from __future__ import annotations

import pytest

from rig.console.access import Access, is_loopback, new_token

TOKEN = new_token()
LOCAL = Access(TOKEN, "127.0.0.1", 8765)


@pytest.mark.parametrize("host", ["127.0.0.1:8765", "localhost:8765", "[::1]:8765", "127.0.0.1"])
def test_names_of_this_machine_are_ours(host: str) -> None:
    assert LOCAL.refuse_host({"host": host}) == ""


@pytest.mark.parametrize(
    "host",
    [
        "",
        "evil.example:8765",
        "127.0.0.1.evil.example:8765",
        "127.0.0.1:80",
        "localhost:x",
        "127.0.0.1:8765@evil",
        "[::1",
    ],
)
def test_a_name_that_somebody_elses_dns_could_lead_here_is_refused(host: str) -> None:
    assert "not the host" in LOCAL.refuse_host({"host": host})


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9999", "file://", "http://[::1"])
def test_pages_of_other_origins_are_refused(origin: str) -> None:
    assert "may not act here" in LOCAL.refuse_origin({"origin": origin})


def test_our_own_page_and_programs_that_are_no_page_pass() -> None:
    assert LOCAL.refuse_origin({"origin": "http://127.0.0.1:8765"}) == ""
    assert LOCAL.refuse_origin({}) == ""


def test_the_token_is_compared_whole() -> None:
    assert LOCAL.refuse_token(TOKEN) == ""
    assert "missing" in LOCAL.refuse_token(None)
    for wrong in ("", TOKEN[:-1], TOKEN + "x", TOKEN.swapcase(), "\udcff", "ä"):
        assert "wrong" in LOCAL.refuse_token(wrong)


def test_no_two_tokens_are_the_same() -> None:
    assert len({new_token() for _ in range(100)}) == 100


def test_a_server_for_others_takes_its_addresses_but_no_unknown_name() -> None:
    everywhere = Access(TOKEN, "0.0.0.0", 8765, names=("rig.lab.example",))
    assert everywhere.refuse_host({"host": "192.168.1.7:8765"}) == ""
    assert everywhere.refuse_host({"host": "rig.lab.example"}) == ""  # the proxy that ends TLS, at 443
    assert everywhere.refuse_host({"host": "rebound.example:8765"}) != ""
    assert not is_loopback("0.0.0.0")
