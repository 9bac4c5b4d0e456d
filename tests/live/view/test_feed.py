"""A run that is going on, as it comes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.core.ring import Ring
from rig.core.sample import Sample
from rig.live.view.feed import EventTail, Feed
from rig.live.view.scene import DRAWN, Scene
from tests.live.view.kept import Kept
from tests.live.view.test_recording import MANIFEST


def put(ring: Ring, rows: range) -> None:
    """Rows of a gear that turns once a second."""
    for i in rows:
        theta = i * 2e-3 * 3.14159
        assert ring.put(Sample(i * 1e-3, theta, theta / 50, 6.28, 0.1, 1.0, 1e-4, i, i, 1, ""), 0.1, 0.1, theta)
        ring.tell_acked(i + 1)


def say(folder: Path, **more: object) -> None:
    """The manifest as it stands."""
    (folder / "manifest.json").write_text(json.dumps({**MANIFEST, "status": "running", **more}))


@pytest.fixture
def ring() -> Iterator[Ring]:
    ring = Ring.create(4096)
    yield ring
    ring.unlink()
    ring.close()


def test_a_line_that_is_not_whole_yet_is_read_when_it_is(tmp_path: Path) -> None:
    tail, path = EventTail(tmp_path), tmp_path / "events.jsonl"
    assert tail.read() == []
    path.write_text('{"kind": "state", "text": "a"}\n{"kind": "no')
    assert [event["text"] for event in tail.read()] == ["a"]
    with path.open("a") as file:
        file.write('te", "text": "b"}\nnot json\n[1]\n')
    assert [event["text"] for event in tail.read()] == ["b"]


def test_a_run_is_ready_when_its_ring_is_and_over_when_its_last_row_was_read(tmp_path: Path, ring: Ring) -> None:
    feed = Feed(tmp_path)
    assert not feed.ready  # no manifest
    say(tmp_path)
    assert not feed.ready  # no ring
    say(tmp_path, ring=str(ring.path))
    assert feed.ready
    put(ring, range(30))
    ring.finish()
    assert not feed.over
    assert len(feed.rows(4096)) == 30
    assert feed.over


def test_a_run_that_was_over_before_anybody_looked_is_over(tmp_path: Path) -> None:
    say(tmp_path, status="completed", ring=None)
    feed = Feed(tmp_path)
    assert not feed.ready
    assert feed.over


def test_what_nobody_hears_is_left_out_and_the_picture_stands_again_on_a_new_canvas(tmp_path: Path, ring: Ring) -> None:
    say(tmp_path, ring=str(ring.path))
    canvases = [Kept(), Kept()]
    given = iter(canvases)
    scene = Scene(Feed(tmp_path), lambda about: next(given))
    for k in range(6 * DRAWN):
        put(ring, range(k * 500, k * 500 + 500))
        scene.step(heard=k % 2 == 0)
    heard = sum(len(t) for path, t, _ in canvases[0].sent if path == "/curves/angle")
    assert 0 < heard < 6 * DRAWN * 500
    scene.renew()
    assert canvases[1].shown["/folded/forward/words"][0].startswith("forward, mean of")


def test_rows_are_drawn_in_at_most_so_many_pieces_a_second(tmp_path: Path, ring: Ring) -> None:
    say(tmp_path, ring=str(ring.path))
    canvas = Kept()
    scene = Scene(Feed(tmp_path), lambda about: canvas)
    scene.step(heard=True)
    for k in range(20):  # a second of beats
        put(ring, range(k * 50, k * 50 + 50))
        scene.step(heard=True)
    assert len([t for path, t, _ in canvas.sent if path == "/curves/shaft"]) == 20
    assert sum(len(t) for path, t, _ in canvas.sent if path == "/curves/shaft") <= 520  # of 1000 rows, the extremes
