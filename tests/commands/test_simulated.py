"""Every verb that reads a run folder marks the twin's samples, though its manifest does not say whose they are."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pyarrow as pa
import pytest

from rig.cli import main
from rig.report.trace.campaign import provenance
from tests.commands.made_run import made_run, rows

MARK = re.compile(r"\bSIMULATED\b")


def twins() -> pa.Table:
    """Rows whose file says what ours say."""
    return rows().replace_schema_metadata({"schema": "hdrig.run/1", "backend": "sim", "simulated": "true"})


@pytest.fixture(params=["absent", "null", "can"])
def run(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """The twin's samples under a manifest that does not know it."""
    backend = {"backend": None if request.param == "null" else request.param}
    folder = made_run(tmp_path / "runs" / "one", backend, twins())
    if request.param == "absent":
        least = {"schema": "hdrig.run/1", "procedure": "kinematic_error", "gear": {"ratio": 50}}
        (folder / "manifest.json").write_text(json.dumps(least))
    return folder


@pytest.mark.parametrize("verb", ["verify", "list", "analyse", "export", "compare"])
def test_it_says_simulated(verb: str, run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = [str(run)] * (2 if verb == "compare" else 1)
    if verb == "compare":
        given[1] = str(made_run(run.parent / "two", {"backend": "can"}, rows(7)))
        assert main(["analyse", *given]) in (0, 1, 6)
    capsys.readouterr()
    main([verb, *given])
    told = capsys.readouterr()
    assert MARK.search(told.out + told.err)
    if verb == "analyse":
        assert MARK.search((run / "report.html").read_text())
    if verb == "export":
        (made,) = told.out.splitlines()
        assert Path(made).read_text().splitlines()[0].endswith(",SIMULATED")


@pytest.mark.parametrize("verb", ["verify", "list", "analyse", "export"])
def test_of_measured_samples_it_does_not(verb: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    measured = made_run(tmp_path / "one", {"backend": "can"})
    main([verb, str(measured)])
    told = capsys.readouterr()
    assert not MARK.search(told.out + told.err)


def test_a_list_for_programs_says_it_too(run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", str(run), "--json"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert (json.loads(line)["simulated"], json.loads(line)["origin"]) == (True, "SIMULATED")


def test_the_page_of_a_trace_knows_it_of_each_run(run: Path) -> None:
    assert provenance(run.parent, {}, "").backends == {"sim"}
