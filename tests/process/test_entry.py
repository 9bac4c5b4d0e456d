"""A Ctrl-C while the program is still being imported ends it in a line, without a traceback."""

from __future__ import annotations

import subprocess
import sys

import pytest

AT = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell that runs tests behind it has it ignored
import rig.entry

class Now:
    def find_spec(self, name, path, target=None):
        if name == {name!r}:
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Now())
sys.argv = ["hdrig", "list", "--help"]
sys.exit(rig.entry.main())
"""


@pytest.mark.parametrize("name", ["rig.cli", "argparse", "rig.process.ctrl_c"])
def test_an_interrupted_import_ends_in_a_line(name: str) -> None:
    done = subprocess.run([sys.executable, "-c", AT.format(name=name)], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (130, "hdrig: interrupted\n")
