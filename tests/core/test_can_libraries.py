"""What is not paid for before a bus is opened."""

from __future__ import annotations

import subprocess
import sys

import pytest


@pytest.mark.long
def test_a_file_format_of_python_can_is_not_imported_with_it_and_is_there_for_who_wants_it() -> None:
    pytest.importorskip("asammdf")
    code = (
        "import sys, drivers.sdo, sim.wire.inprocess\n"
        "assert 'can' in sys.modules and 'asammdf' not in sys.modules, sorted(sys.modules)\n"
        "import asammdf\n"
        "assert asammdf.MDF"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
