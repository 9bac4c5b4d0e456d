"""Ctrl-C while a program is still being loaded: neither lost nor the cause of another error."""

from __future__ import annotations

import importlib
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.core.errors import UsageError
from rig.process.ctrl_c import after_imports, uninterrupted
from rig.runfile.manifest import write_atomic

SLOW = """
import os, signal
os.kill(os.getpid(), signal.SIGINT)  # Ctrl-C in the middle of an import
WHOLE = sum(range(1000))
"""


@pytest.fixture(autouse=True)
def heard() -> Iterator[None]:
    """Interrupts as a terminal has them: a job in the background of a shell inherits that they are ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def slow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of a module during whose import somebody presses Ctrl-C."""
    (tmp_path / "pressed_here.py").write_text(SLOW)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "pressed_here", raising=False)
    return "pressed_here"


def wait() -> None:
    """Until the interrupt comes, 10 s at most."""
    signal.sigtimedwait({signal.SIGUSR1}, 10.0)


def load(name: str) -> None:
    with after_imports():
        importlib.import_module(name)
        wait()


def press() -> None:
    with after_imports():
        os.kill(os.getpid(), signal.SIGINT)
        wait()


@pytest.mark.parametrize(("error", "comes_out"), [(ValueError, KeyboardInterrupt), (UsageError, UsageError)])
def test_an_interrupt_that_a_library_made_another_error_of_is_one(error: type, comes_out: type) -> None:
    """As matplotlib does, which is in the middle of a path in C; a sentence of ours is said all the same."""

    def lost() -> None:
        with after_imports():
            try:
                os.kill(os.getpid(), signal.SIGINT)
                wait()
            except KeyboardInterrupt:
                raise error("Invalid affine transformation matrix") from None

    with pytest.raises(comes_out):
        lost()
    with pytest.raises(ValueError, match="of its own"), after_imports():
        raise ValueError("of its own")


class Pressed:
    """Somebody presses Ctrl-C while it goes."""

    def __del__(self) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        wait()


def test_an_interrupt_where_python_lets_no_error_out_comes_again(capsys: pytest.CaptureFixture[str]) -> None:
    """It was told as ignored, with a traceback, and an analysis went on to its end."""

    def lost() -> None:
        with after_imports():
            Pressed()
            wait()

    before = sys.unraisablehook
    with pytest.raises(KeyboardInterrupt):
        lost()
    assert sys.unraisablehook is before
    assert capsys.readouterr().err == ""


def test_an_interrupt_in_an_import_comes_when_the_module_is_whole(slow: str) -> None:
    with pytest.raises(KeyboardInterrupt):
        load(slow)
    assert sys.modules[slow].WHOLE == 499500


def test_an_interrupt_elsewhere_comes_at_once_and_handlers_are_given_back() -> None:
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGALRM)
    with pytest.raises(KeyboardInterrupt):
        press()
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGALRM)) == before


def test_one_that_waited_goes_to_the_session_that_has_begun_meanwhile(slow: str) -> None:
    counted: list[int] = []
    with after_imports():
        importlib.import_module(slow)
        before = signal.signal(signal.SIGINT, lambda signum, frame: counted.append(signum))
        while not counted:
            signal.pause()
        signal.signal(signal.SIGINT, before)
    assert counted == [signal.SIGINT]


def test_one_that_waits_is_not_raised_to_who_hears_after_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its alarm may go off between two handlers given back: seen twice, of a program that had come to its end."""
    heard: list[int] = []
    give_back = signal.signal

    def alarm_goes_off(number: int, handler: object) -> object:
        before = give_back(number, handler)  # type: ignore[arg-type]
        if handler == after:
            signal.raise_signal(signal.SIGALRM)
        return before

    def after(signum: int, frame: object) -> None:
        heard.append(signum)

    with after_imports(press, then=after) as ears:
        ears.hear(signal.SIGINT, None)  # outside of `press`: it waits
        monkeypatch.setattr(signal, "signal", alarm_goes_off)
    assert heard == []


def test_where_somebody_else_handles_interrupts_nothing_changes() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with after_imports():
            assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


def test_in_another_thread_nothing_changes() -> None:
    said: list[object] = []

    def look() -> None:
        with after_imports():
            said.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=look)
    thread.start()
    thread.join()
    assert said == [signal.default_int_handler]


def test_files_that_belong_together_are_all_written_before_an_interrupt_is_raised(tmp_path: Path) -> None:
    def both() -> None:
        with uninterrupted():
            write_atomic(tmp_path / "page", b"new")
            os.kill(os.getpid(), signal.SIGINT)
            write_atomic(tmp_path / "figures", b"new")

    with pytest.raises(KeyboardInterrupt):
        both()
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {"page": b"new", "figures": b"new"}
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupt_in_the_middle_of_writing_leaves_the_old_file_and_nothing_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def pressed(handle: int) -> None:
        raise KeyboardInterrupt

    (tmp_path / "page").write_bytes(b"old")
    monkeypatch.setattr(os, "fsync", pressed)
    with pytest.raises(KeyboardInterrupt):
        write_atomic(tmp_path / "page", b"new")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {"page": b"old"}


@pytest.mark.parametrize("ignored", [False, True])
def test_a_stop_of_a_service_manager_ends_in_the_same_sentence(ignored: bool) -> None:
    """Also in a job in the background, which does not hear Ctrl-C."""
    code = f"""
import os, signal, sys
import rig.cli, rig.commands.list_
if {ignored}: signal.signal(signal.SIGINT, signal.SIG_IGN)
def stopped(args):
    os.kill(os.getpid(), signal.SIGTERM)
    signal.sigtimedwait({{signal.SIGUSR1}}, 10.0)
rig.commands.list_.run = stopped
sys.exit(rig.cli.main(["list"]))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (130, "hdrig: interrupted\n")


def test_a_stop_in_an_import_comes_when_the_module_is_whole(slow: str, tmp_path: Path) -> None:
    (tmp_path / "pressed_here.py").write_text(SLOW.replace("SIGINT", "SIGTERM"))
    with pytest.raises(KeyboardInterrupt):
        load(slow)
    assert sys.modules[slow].WHOLE == 499500
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


PRESSED_AGAIN = """
import atexit, builtins, signal, sys
import rig.cli, rig.commands.list_, rig.core.way_out
def press(*args):
    signal.raise_signal(signal.SIGINT)  # in this thread, now: of a process another one may take it, and later
    signal.sigtimedwait({{signal.SIGUSR1}}, 0.1)
def after(act):
    def both(*args, **words):
        press()
        done = act(*args, **words)
        press()
        return done
    return both
rig.commands.list_.run = {verb}
rig.core.way_out.print = after(print)
rig.cli._after_output = after(rig.cli._after_output)
if {late}: atexit.register(press)
sys.argv = ["hdrig", "list"]
sys.exit(rig.cli.main())
"""


@pytest.mark.parametrize(
    ("verb", "late", "code", "said"),
    [
        ("press", False, 130, "hdrig: interrupted\n"),  # the verb is, and again while that is said, and afterwards
        ("press", True, 130, "hdrig: interrupted\n"),
        ("lambda args: 0", False, 0, ""),  # it had come to its end
        ("lambda args: 0", True, 130, ""),
        ("lambda args: 1 / 0", False, 70, "hdrig: internal error, please report it: ZeroDivisionError"),
    ],
)
def test_pressed_once_more_at_the_very_end_it_shows_no_traceback(verb: str, late: bool, code: int, said: str) -> None:
    """Also while Python itself goes: whoever presses twice hits any line there is."""
    program = PRESSED_AGAIN.format(verb=verb, late=late)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == code
    assert done.stderr.startswith(said)
    assert done.stderr.count("\n") == (1 if said else 0)
