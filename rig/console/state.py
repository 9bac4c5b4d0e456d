"""State: everything a page shows but samples, put together from what station, feed and gate know."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from rig.console.columns import COLUMNS
from rig.console.feed import Feed
from rig.console.gate import CONTROL, Gate
from rig.console.link import Link
from rig.console.runs import report_of
from rig.station.rules import ALWAYS, advice, allowed


def compose(link: Link, feed: Feed, gate: Gate, page: str, extra: dict[str, Any]) -> dict[str, Any]:
    """For the page with that id; `extra` is the server's own: seq, closing, viewer_url."""
    picture = link.picture
    heard = min(time.monotonic() - link.heard, feed.age_ms / 1e3)  # in a run its rows are all one hears of it
    return {
        **{key: value for key, value in picture.items() if key not in ("run", "campaign", "last_run")},
        "last_run": _last_run(link),
        "revision": gate.revision,
        "server_ns": time.time_ns(),
        "age_ms": round(feed.age_ms, 1),
        "heard_ms": round(1e3 * heard, 1),
        "station": link.alive,
        "advice": advice(picture) if link.alive else link.what_now,
        "run": _run(link, feed),
        "campaign": _campaign(link, feed),
        "events": list(link.events),
        "live": {"columns": [{"name": n, "unit": u} for n, u in COLUMNS], "age_ms": round(feed.age_ms, 1)},
        "allowed": rights(picture, gate, page),
        "controller": "this" if gate.holds(page) else "other",
        **extra,
    }


def rights(picture: dict[str, Any], gate: Gate, page: str) -> dict[str, bool | str]:
    """For every act True or why not: the rules of the state, and who holds control."""
    found = allowed(picture)
    if not gate.holds(page):
        away = "another page holds control"
        found = {act: why if act in ALWAYS and act != "hold" else away for act, why in found.items()}
    found[CONTROL] = True if not gate.holds(page) else "this page holds control"
    return found


def _run(link: Link, feed: Feed) -> dict[str, Any] | None:
    run = link.picture["run"]
    if run is None:
        return None
    figures, counted = feed.figures(), link.switches.counted
    looked = counted.p99_us > 0
    lateness = {
        "p50_us": counted.p50_us if looked else None,
        "p99_us": counted.p99_us if looked else None,
        "missed": counted.missed,
    }
    known = {key: value for key, value in run.items() if key != "ring"}
    held = link.picture["state"] == "holding"  # a held run does not go on: nothing of it is left
    left = None if held else max(run["duration"] - figures["t"], 0.0)
    return {**known, **figures, "left_s": left, "rows": counted.ticks, "lateness": lateness}


def _last_run(link: Link) -> dict[str, Any] | None:
    last: dict[str, Any] | None = link.picture["last_run"]
    if last is None or last["report"] is None:
        return last
    return {**last, "report": report_of(link.root, Path(last["folder"]))}


def _campaign(link: Link, feed: Feed) -> dict[str, Any] | None:
    campaign = link.picture["campaign"]
    if campaign is None:
        return None
    measured = link.picture["run"] is not None and campaign["measuring"]  # a check's time is not in what is left
    done = feed.figures()["t"] if measured else 0.0
    return {**campaign, "left_s": max(campaign["left_s"] - done, 0.0)}
