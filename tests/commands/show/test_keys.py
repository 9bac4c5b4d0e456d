"""Keys ask for hold, stop and halt; the terminal is as it was on every way out."""

from __future__ import annotations

import os
import pty
import signal
import sys
import termios
import time
from collections.abc import Callable, Iterator

import pytest

from rig.commands.show import keys
from rig.commands.show.keys import Keys
from rig.process.interrupts import Interrupts
from tests.commands.show.terminals import Terminal

Pressed = Callable[[str], None]


@pytest.fixture
def keyboard(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The other end of the terminal that is standard input."""
    ours, theirs = pty.openpty()
    monkeypatch.setattr(Keys, "_foreground", lambda self: self._terminal is not None)  # pytest's is another
    with open(theirs) as terminal:
        monkeypatch.setattr(sys, "stdin", terminal)
        yield ours
    os.close(ours)


def soon(true: Callable[[], bool]) -> bool:
    """Whether it becomes so; another thread does it."""
    give_up = time.monotonic() + 5.0
    while not true() and time.monotonic() < give_up:
        time.sleep(0.001)
    return true()


@pytest.mark.parametrize(("key", "count"), [("s", 1), ("sss", 1), ("x", 2), (" ", 2), ("S", 1), ("sx", 2), ("xs", 2)])
def test_a_key_asks_for_what_it_says_and_a_second_stop_is_not_a_halt(keyboard: int, key: str, count: int) -> None:
    interrupts = Interrupts()
    with Keys(interrupts, lambda: True):
        os.write(keyboard, key.encode())
        assert soon(lambda: interrupts.count == count)
        os.write(keyboard, b"h")
        assert soon(lambda: interrupts.held)
    assert interrupts.count == count


@pytest.mark.parametrize(
    "key",
    [
        "\x1b", "\r", "\n", "q", "\x04", "\x7f", "\x08", "\t", "ä", "\0", "\x11", "\x13", "\x0f", "\x16",  # to Ctrl-V
        "\x1b[3~", "\x1b[A", "\x1bOA", "\x1b[[A", "\x1bOP", "\x1b[1;2R",  # Del, up twice, F1 twice, Shift-F3
        "\x1bOS", "\x1b[1;2H", "\x1bs", "\x1bh", "\x1b[", "\x1b]", "\x1b[7$",  # F4, Home, Alt and a key
        "\x1b[?62;c ", "\x1b[I\x1b", "\x1b]11;rgb:0/0/0",  # and a space, and Esc; what never ends is no answer
    ],
)  # fmt: skip
def test_any_other_key_is_a_halt(keyboard: int, key: str) -> None:
    interrupts = Interrupts()
    with Keys(interrupts, lambda: True):
        os.write(keyboard, key.encode())
        assert soon(lambda: interrupts.count == 2)
        assert not interrupts.held


@pytest.mark.parametrize(
    "parts",
    [
        ["\x1b[?62;22;52c"], ["\x1b[>41;354;0c"], ["\x1b[?2026;2$y"], ["\x1b[?1u"], ["\x1b[0n"], ["\x1b[24;80R"],
        ["\x1b]11;rgb:0000/0000/0000\x1b\\"], ["\x1b]10;rgb:ffff/ffff/ffff\x07"], ["\x1bP>|XTerm(390)\x1b\\"],
        ["\x1b[48;24;80;480;800t"], ["\x1b[I", "\x1b[O"], ["\x1b[<35;10;20M", "\x1b[M !!", "\x1b[35;1;2M"],
        ["\x1b]11;rgb:00", "00/0000/0000\x1b", "\\\x1b[?6", "2c"],  # cut by a slow line
    ],
)  # fmt: skip
def test_what_a_terminal_sends_by_itself_is_no_key(
    keyboard: int, parts: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keys, "WHOLE", 5.0)  # this machine may be busy
    interrupts = Interrupts()
    with Keys(interrupts, lambda: True):
        for part in parts:
            os.write(keyboard, part.encode())
            time.sleep(0.01)
        os.write(keyboard, b"h")
        assert soon(lambda: interrupts.held)
    assert interrupts.count == 0


def test_a_terminal_that_is_gone_has_pressed_nothing() -> None:
    gone, other_end = os.pipe()
    os.close(other_end)
    interrupts = Interrupts()
    assert not Keys(interrupts, lambda: True)._read(gone)
    assert (interrupts.count, interrupts.held) == (0, False)
    os.close(gone)


def test_ctrl_c_after_a_stop_by_key_is_still_one_ctrl_c(keyboard: int) -> None:
    interrupts = Interrupts()
    interrupts.stop()
    interrupts.request()
    assert interrupts.count == 1
    interrupts.request()
    assert interrupts.count == 2


def test_the_terminal_is_as_it_was_after_an_exception(keyboard: int) -> None:
    before = termios.tcgetattr(sys.stdin)
    with pytest.raises(ZeroDivisionError), Keys(Interrupts(), lambda: True):
        1 / (termios.tcgetattr(sys.stdin)[3] & termios.ICANON)  # no lines: it is zero
    assert termios.tcgetattr(sys.stdin) == before


def test_handlers_of_signals_are_given_back(keyboard: int) -> None:
    signals = (signal.SIGTSTP, signal.SIGCONT, signal.SIGTTIN, signal.SIGTTOU)
    before = [signal.getsignal(s) for s in signals]
    with Keys(Interrupts(), lambda: True):
        assert [signal.getsignal(s) for s in signals] != before
    assert [signal.getsignal(s) for s in signals] == before


def test_while_a_question_is_asked_keys_are_letters_and_what_was_typed_before_is_no_answer(keyboard: int) -> None:
    interrupts = Interrupts()
    with Keys(interrupts, lambda: True) as listening:
        with listening.paused():
            assert termios.tcgetattr(sys.stdin)[3] & termios.ICANON
            os.write(keyboard, b"xs h\n")
            assert sys.stdin.readline() == "xs h\n"
        assert (interrupts.count, interrupts.held) == (0, False)
        os.write(keyboard, b" ")
        assert soon(lambda: interrupts.count == 2)


def test_ctrl_z_is_a_stop_while_the_motor_is_energised(keyboard: int) -> None:
    interrupts = Interrupts()
    with Keys(interrupts, lambda: True):
        os.kill(os.getpid(), signal.SIGTSTP)
        assert soon(lambda: interrupts.count == 1)


def test_without_a_terminal_no_key_is_heard_and_ctrl_z_is_a_stop_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Standard input from a file, started in a terminal: it slept with the torque on, until the drive gave up."""
    interrupts, before = Interrupts(), signal.getsignal(signal.SIGTSTP)
    with open(os.devnull) as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        with Keys(interrupts, lambda: True) as listening, listening.paused():
            assert listening._terminal is None
            os.kill(os.getpid(), signal.SIGTSTP)
            assert soon(lambda: interrupts.count == 1)
    assert signal.getsignal(signal.SIGTSTP) == before


SLEEPER = """
import sys
from rig.commands.show.keys import Keys
from rig.process.interrupts import Interrupts
from tests.commands.show.terminals import Terminal
interrupts = Interrupts()
with Keys(interrupts, lambda: False):
    print("ready", flush=True)
    while not interrupts.count:
        pass
print("stopped", flush=True)
"""


SHELL = """
import os, signal, subprocess, sys
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
job = subprocess.Popen([sys.executable, "-c", sys.argv[1]], process_group=0)
os.tcsetpgrp(0, job.pid)
pid, how = os.waitpid(job.pid, os.WUNTRACED)
os.tcsetpgrp(0, os.getpgrp())
print("asleep" if os.WIFSTOPPED(how) else "ended", flush=True)
sys.stdin.readline()
os.tcsetpgrp(0, job.pid)
os.killpg(job.pid, signal.SIGCONT)
print("awake", flush=True)
os.waitpid(job.pid, 0)
"""


@pytest.mark.slow
def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again() -> None:
    shell = Terminal(["-c", SHELL, SLEEPER], program=[sys.executable])
    try:
        shell.wait_for(lambda seen: "ready" in seen)
        assert soon(lambda: shell.modes != shell.before)
        shell.press("\x1a")
        shell.wait_for(lambda seen: "asleep" in seen)
        assert shell.modes == shell.before
        shell.press("\n")
        shell.wait_for(lambda seen: "awake" in seen)
        assert soon(lambda: shell.modes != shell.before)
        shell.press("s")
        assert shell.end() == 0
        assert "stopped" in shell.seen
        assert shell.modes == shell.before
    finally:
        shell.close()
