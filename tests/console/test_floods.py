"""Pages that shout, do not listen, or vanish: each waits at its own end, the others and the terminal notice nothing."""

from __future__ import annotations

import contextlib
import json
import logging
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from rig.console.server import Serving
from tests.console.hand import PATIENCE, Hand

pytestmark = pytest.mark.slow
WORD = "x" * 4000
MOST = 32_000_000  # characters: many times what the buffers of a socket hold
QUIET = 0.5  # s in which nothing more is taken from a page that shouts


@pytest.fixture(scope="module")
def hand(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hand]:
    with Hand(tmp_path_factory.mktemp("floods")) as made:
        yield made


@contextlib.contextmanager
def page(hand: Hand, name: str) -> Iterator[ClientConnection]:
    with hand.listen() as line:
        line.send(json.dumps({"token": hand.token, "page": name}))
        line.recv()
        yield line


def test_a_page_that_shouts_waits_at_its_own_end_and_the_others_are_answered(hand: Hand) -> None:
    said = [0]

    def shout(line: ClientConnection) -> None:
        with contextlib.suppress(ConnectionClosed, OSError):
            while said[0] < MOST:
                line.send(WORD)
                said[0] += len(WORD)

    with page(hand, "loud") as loud, page(hand, "quiet") as quiet:
        shouting = threading.Thread(target=shout, args=(loud,))
        shouting.start()
        end, before = time.monotonic() + PATIENCE, -1
        while said[0] != before:  # until nothing more is taken
            assert time.monotonic() < end
            before = said[0]
            time.sleep(QUIET)
        assert said[0] < MOST, "everything it said was read"
        first = json.loads(next(m for m in quiet if isinstance(m, str)))["seq"]
        assert json.loads(next(m for m in quiet if isinstance(m, str)))["seq"] > first
        assert hand.ask("halt")[0] == 200
        loud.socket.shutdown(socket.SHUT_RDWR)  # gone without a word
    shouting.join(PATIENCE)


def test_a_page_that_does_not_listen_loses_samples_and_keeps_nobody_waiting(hand: Hand) -> None:
    hand.do("take_control")
    hand.connect(clock="wall")
    with page(hand, "deaf"), page(hand, "other") as other:
        heard = [other.recv() for _ in range(60)]
        assert sum(isinstance(message, bytes) for message in heard) > 20
        queues = hand.serving.console.feed._pages
        assert all(len(queue) <= (queue.maxlen or 0) for queue in queues)
    hand.finish("disconnect")


def test_pages_that_vanish_in_the_middle_of_a_word_leave_no_trace_on_the_terminal(
    hand: Hand, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.ERROR, logger="uvicorn.error"):
        logging.getLogger("uvicorn.error").addHandler(caplog.handler)
        for name in ("a", "b", "c"):
            with page(hand, name) as line:
                for _ in range(200):
                    line.send(WORD)
                line.socket.shutdown(socket.SHUT_RDWR)
        hand.until(lambda state: not {"a", "b", "c"} & set(hand.serving.console.pages._open))
        logging.getLogger("uvicorn.error").removeHandler(caplog.handler)
    assert caplog.text == ""


def test_an_answer_is_not_kept_back_until_the_last_one_is_acknowledged(tmp_path: Path) -> None:
    """Nagle's wait: 40 ms on each answer that is sent in two parts."""
    serving = Serving("127.0.0.1", 0, tmp_path, "twin")
    with serving._socket as listening:
        assert listening.proto == socket.IPPROTO_TCP  # what asyncio goes by
