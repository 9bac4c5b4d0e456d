"""hdrig run at a terminal and without one: states, keys, lines, JSON lines; the terminal as it was on every way out."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.commands.show import show
from tests.commands.show.terminals import HDRIG, Terminal

RUN = ["run", "kinematic-error", "--with", "cycles=1", "--clock", "virtual"]
pytestmark = pytest.mark.slow


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Terminal]:
    """hdrig run on the twin, the motor turning."""
    found = Terminal([*RUN, "--out", str(tmp_path)])
    try:
        found.wait_for(lambda seen: "RUNNING kinematic-error" in seen)
        yield found
    finally:
        found.close()


@pytest.mark.long
def test_what_a_procedure_found_is_said_once(tmp_path: Path) -> None:
    command = [*HDRIG, "run", "step-test", "--clock", "virtual", "--out", str(tmp_path)]
    made = subprocess.run(command, capture_output=True, text=True, timeout=100)
    assert made.stdout.count("inertia at the motor") == 1
    assert "inertia at the motor" not in made.stderr


@pytest.mark.long
def test_hold_then_stop_by_key(terminal: Terminal) -> None:
    terminal.press("h")
    terminal.wait_for(lambda seen: "HOLDING kinematic-error" in seen)
    terminal.press("s")
    assert terminal.end() == 4
    assert "stopped by the operator" in terminal.seen
    assert terminal.modes == terminal.before


def test_halt_by_escape(terminal: Terminal) -> None:
    assert "any key: halt (torque off)  s, Ctrl-Z: stop  h: hold  Ctrl-C: stop, twice: halt" in terminal.seen
    assert "SIMULATED RUNNING kinematic-error" in terminal.seen
    terminal.press("\x1b")
    assert terminal.end() == 130
    assert "halted by the operator: torque off at once; the drive confirms it, the rig is ready" in terminal.seen
    assert "ready: halted" not in terminal.seen
    assert terminal.modes == terminal.before


def test_ctrl_z_while_the_motor_turns_is_a_stop(terminal: Terminal) -> None:
    terminal.press("\x1a")
    assert terminal.end() == 4
    assert terminal.modes == terminal.before


def test_a_killed_program_leaves_a_terminal_with_echo(terminal: Terminal) -> None:
    assert terminal.modes != terminal.before
    os.kill(terminal.process.pid, signal.SIGKILL)
    give_up = time.monotonic() + 10.0
    while terminal.modes != terminal.before and time.monotonic() < give_up:
        time.sleep(0.05)
    assert terminal.modes == terminal.before


def test_json_puts_every_event_on_stdout_as_the_table_says_and_nothing_else(tmp_path: Path) -> None:
    command = [*HDRIG, *RUN, "--json", "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    events = [json.loads(line) for line in done.stdout.splitlines()]
    table = {}
    for names, keys in re.findall(r"^\| ([a-z, ]+) \| ([^|]+) \|", show.__doc__ or "", re.MULTILINE):
        table |= {name: {key.strip() for key in keys.split(",")} for name in names.split(", ")}
    assert {e["event"] for e in events} >= {"bench", "said", "state", "run", "progress", "ended", "result", "exit"}
    for event in events:
        assert set(event) >= table[event["event"]] | {"event", "utc"}, event
    assert events[0]["event"] == "bench"
    assert events[-1] == events[-1] | {"event": "exit", "code": 0, "error": None}
    assert next(e for e in events if e["event"] == "result")["result"]["estimates"]
    peaks = [e["peak_to_peak_arcsec"] for e in events if e["event"] == "ended"]
    assert peaks[-1] == pytest.approx(93.4, rel=0.1)  # the twin's, by the full analysis


def test_json_says_why_it_was_refused(tmp_path: Path) -> None:
    command = [*HDRIG, "run", "kinematic-error", "--json", "--out", str(tmp_path), "--set", "limits.speed_rpm=1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    last = json.loads(done.stdout.splitlines()[-1])
    assert last["code"] == done.returncode != 0
    assert last["error"] in done.stderr
