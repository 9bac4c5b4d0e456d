"""A terminal that goes away, `| head` and a full disk do not change how a run ends or what it returns."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

import rig.commands.list_
from rig.cli import main
from rig.process.plain import NAME
from rig.process.streams import Tolerant

TEN = "import sys, rig.cli; sys.exit(rig.cli.main(sys.argv[1:]))"


def test_a_stream_that_fails_once_is_silent_from_then_on() -> None:
    read, write = os.pipe()
    pipe = os.fdopen(write, "w", buffering=1)
    stream = Tolerant(pipe)
    os.close(read)
    stream.write("nobody reads this\n")
    stream.flush()
    assert stream.write("nor this\n") == 0
    assert not stream.isatty()
    assert stream.encoding == pipe.encoding  # `hdrig list | head` asks for it before every line
    pipe.close()  # what was still buffered goes nowhere


def test_a_missing_stream_swallows_everything() -> None:
    stream = Tolerant(None)
    stream.write("x")
    stream.flush()


def test_a_working_stream_is_untouched() -> None:
    text = io.StringIO()
    assert Tolerant(text).write("abc") == 3
    assert text.getvalue() == "abc"


@pytest.mark.slow
@pytest.mark.parametrize("stream", ["stdout", pytest.param("stderr", marks=pytest.mark.long)])
def test_a_run_whose_output_goes_to_a_full_disk_still_completes(stream: str, tmp_path: Path) -> None:
    short = ["--with", "cycles=0.5", "--with", "amplitude_deg=360", "--with", "frequency=0.04"]
    with open("/dev/full", "w") as full:
        streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, stream: full}
        args = [sys.executable, "-c", TEN, "run", "kinematic-error", "--out", str(tmp_path), *short]
        done = subprocess.run(args, timeout=120, **streams)  # type: ignore[call-overload]
    assert done.returncode in ((2, 6) if stream == "stdout" else (0, 6))
    assert len(list(tmp_path.glob("*/*kinematic-error*/report.html"))) == 1


@pytest.mark.slow
@pytest.mark.long
def test_a_run_whose_stderr_is_closed_runs_and_its_number_is_no_files(tmp_path: Path) -> None:
    command = '"$0" -m rig.cli run standstill --with duration=1 --out "$1" 2>&-'
    done = subprocess.run(["sh", "-c", command, sys.executable, str(tmp_path)], timeout=120, stdout=subprocess.PIPE)
    assert done.returncode == 0
    assert b"report" in done.stdout
    look = 'import os, rig.cli; rig.cli.main(["list", "."]); print(os.readlink("/proc/self/fd/2"))'
    shut = subprocess.run(["sh", "-c", '"$0" -c "$1" 2>&-', sys.executable, look], timeout=60, stdout=subprocess.PIPE)
    assert shut.stdout.splitlines()[-1] == b"/dev/null"


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["ascii", pytest.param("latin-1", marks=pytest.mark.long)])
def test_what_a_terminal_cannot_show_is_told_in_other_letters_and_no_line_is_lost(encoding: str) -> None:
    args = [sys.executable, "-c", TEN, "run", "standstill", "--dry-run"]
    shown = {
        name: subprocess.run(args, capture_output=True, timeout=120, env={**os.environ, "PYTHONIOENCODING": name})
        for name in ("utf-8", encoding)
    }
    whole = shown["utf-8"].stdout.decode()
    assert not whole.isascii()
    assert shown[encoding].stdout == whole.encode(encoding, errors=NAME)
    assert shown[encoding].returncode == shown["utf-8"].returncode == 0


@pytest.mark.slow
@pytest.mark.parametrize("args", [["--help"], ["list", "--help"], ["run", "standstill", "--dry-run"]])
def test_output_for_which_there_is_no_room_is_told_and_the_code_is_2(args: list[str]) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-c", TEN, *args], timeout=120, stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert (done.returncode, done.stderr.splitlines()[-1]) == (
        2,
        "hdrig: what was to be printed could not be written: No space left on device",
    )


def test_a_reader_who_left_is_told_nothing() -> None:
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run([sys.executable, "-c", TEN, "--help"], timeout=120, stdout=write, stderr=subprocess.PIPE)
    os.close(write)
    assert (done.returncode, done.stderr) == (0, b"")


def test_an_unforeseen_error_is_one_sentence_and_exit_70(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(args: object) -> int:
        raise ZeroDivisionError("a fault\nof ours")

    monkeypatch.setattr(rig.commands.list_, "run", broken)
    assert main(["list"]) == 70
    err = capsys.readouterr().err
    assert err.startswith("hdrig: internal error, please report it: ZeroDivisionError: a fault of ours in ")
    assert err.count("\n") == 1
