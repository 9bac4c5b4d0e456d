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
from rig.streams import Tolerant

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
@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_run_whose_output_goes_to_a_full_disk_still_completes(stream: str, tmp_path: Path) -> None:
    short = ["--with", "cycles=0.5", "--with", "amplitude_deg=360", "--with", "frequency=0.04"]
    with open("/dev/full", "w") as full:
        streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, stream: full}
        args = [sys.executable, "-c", TEN, "run", "kinematic-error", "--out", str(tmp_path), *short]
        done = subprocess.run(args, timeout=120, **streams)  # type: ignore[call-overload]
    assert done.returncode in (0, 6)
    assert len(list(tmp_path.glob("*/*kinematic-error*/report.html"))) == 1


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
