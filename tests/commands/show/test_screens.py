"""What is drawn: two lines at the foot of a terminal, plain lines elsewhere; nobody who looks can hold up who works."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from typing import Any

import pytest

from rig.commands.show import outlet as outlets
from rig.commands.show.enrich import Enriched
from rig.commands.show.lines import Lines
from rig.commands.show.outlet import Apart, Here
from rig.commands.show.terminal import KEYS, Terminal, keys_in

BENCH = {"event": "bench", "bench": "twin", "simulated": True, "clock": "wall", "ratio": 50.0, "gear": "G1"}
RUN = {"event": "run", "title": "kinematic-error", "duration_s": 100.0, "ring": "/nowhere", "folder": "f"}
LATE = {"lateness_p50_us": 52, "lateness_p99_us": 180, "missed": 3}


def progress(t: float, peak: float | None = 93.4) -> dict[str, Any]:
    return {"event": "progress", "t": t, "state": "running", "peak_to_peak_arcsec": peak, **LATE}


def rows(drawn: str) -> list[str]:
    """What a terminal shows of it: carriage return, cursor up and erase are obeyed."""
    screen, at = [""], 0
    for part in drawn.replace("\x1b[1A", "\x00").replace("\r\x1b[J", "\x01").split("\n"):
        for char in part:
            if char == "\x00":
                at -= 1
            elif char == "\x01":
                screen = [*screen[:at], ""]
            else:
                screen[at] += char
        screen.append("")
        at += 1
    return screen[:-1]


def test_a_run_stands_in_three_lines_with_state_progress_peak_to_peak_lateness_and_keys() -> None:
    stream = io.StringIO()
    terminal = Terminal(stream)
    for event in (BENCH, RUN, progress(10.0), progress(50.0)):
        terminal.take(event)
    *_, first, second, third = rows(stream.getvalue())
    assert first == "SIMULATED RUNNING kinematic-error ██████░░░░░░ 50.0/100.0 s, p-p 93.4 arcsec"[:79]
    assert second == "late p50 52 µs, p99 180 µs, 3 cycles missed"
    assert third == "  ".join(KEYS)
    assert len(third) < 80
    for way in ("any key: halt (torque off)", "s, Ctrl-Z: stop", "h: hold", "Ctrl-C: stop, twice: halt"):
        assert way in third


@pytest.mark.parametrize("width", [39, 30, 20, 12])
def test_a_narrow_terminal_cuts_off_no_key_and_keeps_nothing_of_the_foot(
    monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    monkeypatch.setattr("rig.commands.show.terminal._width", lambda stream: width)
    stream = io.StringIO()
    terminal = Terminal(stream)
    for event in (BENCH, RUN, progress(10.0), progress(50.0)):
        terminal.take(event)
    shown = rows(stream.getvalue())[3:]
    assert width < 26 or all(any(key in line for line in shown) for key in KEYS)
    assert "".join("".join(shown).split()) == "".join("".join(KEYS).split())
    assert all(len(line) <= width for line in shown)
    terminal.close()
    assert rows(stream.getvalue()) == ["SIMULATED: bench 'twin' is the twin, wall clock", ""]


def test_a_held_run_does_not_go_on_and_promises_no_end(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter((100.0, 110.0))
    monkeypatch.setattr("rig.commands.show.terminal.time.monotonic", lambda: next(clock))
    monkeypatch.setattr("rig.commands.show.terminal._width", lambda stream: 200)
    stream = io.StringIO()
    terminal = Terminal(stream)
    for event in (BENCH, RUN, progress(10.0), progress(20.0)):
        terminal.take(event)
    assert "80 s left" in rows(stream.getvalue())[-3]
    terminal.take({**progress(20.0), "state": "holding"})
    assert "HOLDING" in rows(stream.getvalue())[-3]
    assert "left" not in rows(stream.getvalue())[-3]


def test_what_is_said_goes_above_and_nothing_of_the_foot_stays_behind() -> None:
    stream = io.StringIO()
    terminal = Terminal(stream)
    ended = {"event": "ended", "status": "completed", "peak_to_peak_arcsec": 93.4}
    for event in (BENCH, RUN, progress(10.0), {"event": "said", "text": "look"}, progress(99.0), ended):
        terminal.take(event)
    terminal.close()
    assert rows(stream.getvalue()) == [
        "SIMULATED: bench 'twin' is the twin, wall clock",
        "look",
        "SIMULATED kinematic-error: completed after 99.0 of 100.0 s, p-p 93.4 arcsec",
        "",
    ]


def test_plain_lines_have_one_a_tenth_with_units_and_no_escapes() -> None:
    stream = io.StringIO()
    lines = Lines(stream)
    for event in (BENCH, RUN, *(progress(float(t)) for t in range(101))):
        lines.take(event)
    told = stream.getvalue().splitlines()
    assert (
        told[2]
        == "kinematic-error running:   10.0 of 100.0 s, p-p 93.4 arcsec, late p50 52 µs, p99 180 µs, 3 cycles missed"
    )
    assert len(told) == 2 + 10
    assert "\x1b" not in stream.getvalue()


def test_a_terminal_without_greek_letters_still_shows_the_numbers() -> None:
    raw = io.BytesIO()
    terminal = Terminal(io.TextIOWrapper(raw, "ascii"))
    for event in (BENCH, RUN, progress(50.0)):
        terminal.take(event)
    assert b"50.0/100.0 s" in raw.getvalue()


def test_a_run_whose_ring_is_gone_has_no_peak_to_peak() -> None:
    stream = io.StringIO()
    screen = Enriched(Lines(stream))
    for event in (BENCH, RUN, progress(50.0)):
        screen.take(dict(event))
    assert "p-p –" in stream.getvalue()


@pytest.mark.slow
def test_a_terminal_that_is_stopped_holds_up_nobody_and_nothing_grows() -> None:
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    while True:  # the terminal after Ctrl-S
        try:
            os.write(writing, b"x" * 65536)
        except BlockingIOError:
            break
    os.set_blocking(writing, True)
    apart = Apart("lines", writing)
    for k in range(20_000):
        apart.put({"event": "said", "text": f"{k} {'x' * 100}"})
        apart.put(progress(float(k)))
    assert len(apart._waiting) <= outlets.BACKLOG
    apart.close()  # gives the drawing up
    assert apart._process.returncode is not None
    os.close(reading)
    os.close(writing)


def test_whoever_draws_may_die_and_the_events_go_nowhere() -> None:
    with open(os.devnull, "wb") as nothing:
        apart = Apart("lines", nothing.fileno())
        apart._process.kill()
        apart._process.wait()
        for k in range(1000):
            apart.put(progress(float(k)))
        assert not apart._waiting
        apart.close()


def test_where_standard_error_is_no_file_it_is_drawn_at_once(monkeypatch: object) -> None:
    stream = io.StringIO()
    Here("lines", stream).put({"event": "said", "text": "here"})
    assert stream.getvalue() == "here\n"


@pytest.mark.parametrize("columns", [0, 1])
def test_a_terminal_that_does_not_know_its_width_has_the_usual_one(
    columns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a serial line, or one that a program opened: nothing of the foot may be lost, nor the painter die of it."""
    monkeypatch.setattr(os, "get_terminal_size", lambda fd: os.terminal_size((columns, 0)))
    stream = Described()
    screen = Terminal(stream)
    for event in (RUN, {"event": "progress", **progress(1.0)}):
        screen.take(event)
    assert all(line in stream.getvalue() for line in keys_in(79))


def test_keys_that_nobody_hears_are_not_promised() -> None:
    stream = Described()
    screen = Terminal(stream, keyed=False)
    for event in (RUN, {"event": "progress", **progress(1.0)}):
        screen.take(event)
    assert "any key" not in stream.getvalue()
    assert "no keys are heard here" in stream.getvalue()
    assert "Ctrl-C: stop, twice: halt" in stream.getvalue()


class Described(io.StringIO):
    """Text with the number of a file."""

    def fileno(self) -> int:
        return 1


def test_a_disk_that_takes_no_more_lines_is_said_once() -> None:
    event = b'{"event": "note", "utc": "2026-11-30T12:00:00+00:00", "text": "tared"}\n'
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "rig.commands.show.painter", "json"],
            input=3 * event,
            stdout=full,
            stderr=subprocess.PIPE,
            check=True,
        )
    assert done.stderr.decode().count("could not be written: [Errno 28]") == 1
