"""The two ends of the wire know nothing of each other: or one mistake would sit on both and cancel."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow
ENDS = [("sim.wire.process", "drivers"), ("drivers.unixbus", "sim")]


def test_neither_end_of_the_wire_loads_the_other() -> None:
    for module, other in ENDS:
        code = f"import sys, {module}; sys.exit(any(m.split('.')[0] == '{other}' for m in sys.modules))"
        assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0, f"{module} loads {other}"


def test_the_twin_speaks_can_and_serial_without_the_libraries_its_hosts_use() -> None:
    code = "import sys, sim.wire.process; sys.exit(any(m in sys.modules for m in ('can', 'canopen', 'serial')))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
