"""Figures and report of a finished run, made by a process of its own: the station goes on reading its instruments."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, final

from rig.core.errors import Exit
from rig.runfile.manifest import parse

ANALYSE = ("rig.evaluation", "run")
AFTERWARDS = ("rig.evaluation", "campaign")  # of one that is complete
TOLD = (Exit.PASS, Exit.OUT_OF_LIMITS, Exit.INCOMPLETE)  # there is a report


@final
class Analysis:
    """One process, begun when made. A loop that runs meanwhile is scheduled before it."""

    def __init__(self, folder: Path, what: tuple[str, ...]) -> None:
        """`what`: ANALYSE a run, or AFTERWARDS for a campaign."""
        self.folder = folder
        command = [sys.executable, "-m", *what, str(folder)]
        self._said = tempfile.TemporaryFile()  # noqa: SIM115 - a pipe that nobody reads would hold it up once full
        self._process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self._said
        )

    @property
    def done(self) -> bool:
        """True when it has ended."""
        return self._process.poll() is not None

    def found(self) -> dict[str, Any]:
        """Of a done one: `report` path, `verdict`, `sentence`; without a report the sentence says why."""
        said = self._last_words()
        if self._process.returncode not in TOLD:
            why = said.strip().splitlines()[-1] if said.strip() else f"exit code {self._process.returncode}"
            return {"report": None, "verdict": None, "sentence": f"not analysed: {why.removeprefix('hdrig: ')}"}
        if not (self.folder / "result.json").exists():
            return {"report": None, "verdict": None, "sentence": ""}  # nothing follows this campaign
        try:
            result = parse((self.folder / "result.json").read_bytes())
        except (OSError, ValueError) as error:
            return {"report": None, "verdict": None, "sentence": f"result.json cannot be read: {error}"}
        return {
            "report": str(self.folder / "report.html"),
            "verdict": result.get("verdict"),
            "sentence": result.get("sentence"),
        }

    def _last_words(self) -> str:
        self._process.wait()
        self._said.seek(0)
        said = self._said.read().decode(errors="replace")
        self._said.close()
        return said

    def end(self) -> None:
        """Leave it unfinished."""
        self._process.kill()
        self._process.wait()
        self._said.close()
