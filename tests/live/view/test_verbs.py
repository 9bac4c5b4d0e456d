"""hdrig view, and --view of hdrig run."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from rig.commands.viewing import NoView, view
from rig.live.view.recording import NAME
from rig.runfile.process import this_process
from tests.live.view.test_recording import MANIFEST, folder

__all__ = ["folder"]  # a fixture


def hdrig(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "rig.cli", *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


def test_no_view_is_the_default_and_starts_nothing() -> None:
    with view("none") as looking_on:
        assert isinstance(looking_on, NoView)


@pytest.mark.slow
def test_starting_the_handle_of_the_view_loads_no_viewer() -> None:
    said = "import sys, rig.commands.viewing; print('rerun' in sys.modules, 'pyarrow' in sys.modules)"
    shown = subprocess.run([sys.executable, "-c", said], capture_output=True, text=True, check=True)
    assert shown.stdout.split()[0] == "False"


@pytest.mark.slow
def test_a_recording_is_made_beside_the_samples_or_where_it_is_wanted(folder: Path, tmp_path: Path) -> None:
    made = hdrig("view", str(folder))
    assert (made.returncode, made.stdout.strip()) == (0, str(folder / NAME))
    assert (folder / NAME).stat().st_size > 1000
    made = hdrig("view", str(folder), "--out", str(tmp_path / "x.rrd"))
    assert made.stdout.strip() == str(tmp_path / "x.rrd")


@pytest.mark.slow
def test_a_run_that_goes_on_is_followed_and_not_written_to_a_file(folder: Path) -> None:
    said = {**MANIFEST, "status": "running", "process": this_process()}
    (folder / "manifest.json").write_text(json.dumps(said))
    refused = hdrig("view", str(folder))
    assert refused.returncode == 2
    assert "--web" in refused.stderr


@pytest.mark.slow
def test_ctrl_c_ends_the_page_of_a_run_that_is_over_without_a_word_of_the_viewer_s(folder: Path) -> None:
    command = [sys.executable, "-m", "rig.cli", "view", str(folder), "--web"]
    # a job in the background of a shell inherits that interrupts are ignored
    heard = partial(signal.signal, signal.SIGINT, signal.default_int_handler)
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=heard) as shown:
        assert shown.stderr is not None
        for line in shown.stderr:
            if line == "Ctrl-C ends it\n":
                break
        shown.send_signal(signal.SIGINT)
        assert shown.stderr.read() == ""
        assert shown.wait(30) == 0
