"""What a command loads is what it makes a person wait for: told by the list of modules, not by a clock."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest


def loaded(statement: str) -> set[str]:
    """Top-level modules after `statement` in a fresh interpreter."""
    told = subprocess.run(
        [sys.executable, "-c", f"{statement}\nimport sys; print(*{{m.partition('.')[0] for m in sys.modules}})"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return set(told.stdout.splitlines()[-1].split())


@pytest.mark.slow
def test_an_analysis_and_its_report_load_no_scipy_and_no_compiler() -> None:
    parts = (
        "friction.coast_down turning.constant_torque at_speed.decomposition_words friction.run turning.full_turn "
        "at_speed.convergence sensors.standstill stiffness"
    )
    each = [f"rig.analysis.{part}" for part in parts.split()]
    statement = ", ".join(["import rig.commands.analyse, rig.analysis.analyse, rig.report.page", *each])
    assert not loaded(statement) & {"scipy", "numba"}


@pytest.mark.slow
def test_an_analysis_loads_no_other_procedure_s() -> None:
    told = subprocess.run(
        [sys.executable, "-c", "import rig.analysis.analyse, sys; print('rig.analysis.stiffness' in sys.modules)"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert told.stdout == "False\n"


@pytest.mark.slow
def test_the_overview_of_verbs_loads_nothing_heavier_than_argparse() -> None:
    heavy = {"numpy", "pyarrow", "scipy", "numba", "matplotlib", "pydantic", "can", "rich"}
    statement = "import contextlib\nfrom rig.cli import main\nwith contextlib.suppress(SystemExit): main(['--help'])"
    assert not loaded(statement) & heavy


@pytest.mark.slow
def test_rows_are_written_and_read_without_a_look_for_pandas(tmp_path: Path) -> None:
    statement = (
        "import numpy as np, pyarrow as pa, rig.recorder.__main__, pathlib\n"
        "from rig.core.channels import CHANNELS\n"
        "from rig.runfile.columns import as_float, columns_of_rows, schema\n"
        "from rig.runfile.journal import JournalReader, JournalWriter\n"
        "kinds = {'float64': 'f8', 'int64': 'i8', 'uint32': 'i8'}\n"
        "rows = np.zeros(3, [(c.name, kinds[c.dtype]) for c in CHANNELS])\n"
        "rows['tau_l'][1], rows['theta_ref'] = np.nan, np.nan\n"
        f"folder = pathlib.Path({str(tmp_path)!r})\n"
        "journal = JournalWriter(folder, schema('sim'), first=0)\n"
        "journal.append(columns_of_rows(rows))\n"
        "journal.close()\n"
        "table = pa.Table.from_batches(JournalReader(folder))\n"
        "[as_float(table.column(c.name)) for c in CHANNELS]"
    )
    assert "pandas" not in loaded(statement)
