"""The viewer's page: from this machine, for this machine, with a policy that lets it talk to nobody else."""

from __future__ import annotations

import http.client
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.core.errors import NotReady
from rig.live.view import pages
from rig.live.view.server import Proxy, Window, free_port, listens


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[pages.Pages]:
    """Three small files in place of the viewer's."""
    for name in pages.FILES:
        (tmp_path / name).write_bytes(name.encode())
    (tmp_path / "secret").write_text("no")
    monkeypatch.setattr(pages, "files", lambda: tmp_path)
    starts = [1]
    server = pages.Pages(4711, lambda: starts[0])
    yield server
    server.close()


def answer(served: pages.Pages, path: str, host: str = "") -> tuple[int, dict[str, str], bytes]:
    where = served.url.split("/")[2]
    connection = http.client.HTTPConnection(where, timeout=5)
    connection.request("GET", path, headers={"Host": host or where})
    got = connection.getresponse()
    body = got.read()
    connection.close()
    return got.status, dict(got.getheaders()), body


def test_the_page_and_its_two_files_are_served_with_a_policy_for_this_machine_only(served: pages.Pages) -> None:
    for path in ("/", "/?url=x", "/re_viewer.js", "/re_viewer_bg.wasm"):
        status, headers, body = answer(served, path)
        assert status == 200
        assert body
        policy = headers["Content-Security-Policy"]
        assert "default-src 'self'" in policy
        assert "connect-src 'self' http://127.0.0.1:4711" in policy
        assert "https:" not in policy


@pytest.mark.parametrize("path", ["/secret", "/../secret", "/%2e%2e/secret", "//etc/passwd"])
def test_nothing_else_of_the_folder_is_served(path: str, served: pages.Pages) -> None:
    assert answer(served, path)[0] == 404


def test_a_page_of_another_name_that_points_here_gets_nothing(served: pages.Pages) -> None:
    assert answer(served, "/", host="evil.example:80")[0] == 404


def test_the_address_names_the_recordings_and_loopback(served: pages.Pages) -> None:
    assert served.url.startswith("http://127.0.0.1:")
    assert "url=rerun%2Bhttp%3A%2F%2F127.0.0.1%3A4711%2Fproxy" in served.url
    assert "persist=0" in served.url


def test_viewers_are_told_to_listen_on_loopback_and_to_hold_no_more_than_so_much() -> None:
    for server in (Proxy(), Window()):
        options = server.options()
        assert options[options.index("--bind") + 1] == "127.0.0.1"
        assert any(option.endswith("memory-limit") for option in options)


def test_a_window_without_a_screen_is_refused_with_what_works_instead(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(NotReady, match=r"no screen.*web"):
        Window().start()


@pytest.mark.slow
def test_the_proxy_listens_on_loopback_and_nowhere_else() -> None:
    server = Proxy()
    server.start()
    lines = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    bound = {
        line[1].split(":")[0] for line in lines if line[3] == "0A" and int(line[1].split(":")[1], 16) == server.port
    }
    server.stop()
    assert bound == {"0100007F"}
    assert not listens(server.port)
    assert free_port() > 0


def test_a_page_can_tell_that_its_proxy_is_another_one_and_loads_itself_anew(served: pages.Pages) -> None:
    assert answer(served, "/starts")[2] == b"1"
    assert b"location.reload()" in answer(served, "/")[2]
