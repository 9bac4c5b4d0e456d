"""What the tests of importing share: write a foreign file, import it, or see it refused with nothing written."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rig.core.errors import Exit, UsageError
from rig.runfile.importing import import_file
from rig.runfile.run import Run

from .formats import MAPPING, WRITERS, Columns, columns

REPOSITORY = Path(__file__).parents[3]


class Foreign:
    """A folder with a foreign file in it, and a root for run folders that does not exist yet."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.out = folder, folder / "runs"

    def file(self, data: Columns | None = None, name: str = "run.csv", **how: Any) -> Path:
        path = self.folder / name
        WRITERS[name](path, columns() if data is None else data, **how)
        return path

    def bytes(self, content: bytes, name: str = "run.csv") -> Path:
        path = self.folder / name
        path.write_bytes(content)
        return path

    def imported(self, path: Path, mapping: str = MAPPING) -> Run:
        return Run.open(import_file(path, self.mapping(mapping), self.out))

    def refused(self, path: Path, mapping: str = MAPPING) -> str:
        with pytest.raises(UsageError) as caught:
            import_file(path, self.mapping(mapping), self.out)
        said = str(caught.value)
        assert caught.value.exit == Exit.USAGE == 2
        assert "\n" not in said
        assert not self.out.exists(), "a refusal writes nothing"
        return said

    def mapping(self, text: str) -> Path:
        path = self.folder / "map.toml"
        path.write_text(text, encoding="utf-8")
        return path


@pytest.fixture
def foreign(tmp_path: Path) -> Foreign:
    return Foreign(tmp_path)


@pytest.fixture
def shared() -> Path:
    """The folder all developers share; HDRIG_SHARED says where, else beside the repository."""
    folder = Path(os.environ.get("HDRIG_SHARED", REPOSITORY.parent / "shared"))
    if not folder.is_dir():
        pytest.skip(f"no shared data in {folder}")
    return folder


def with_column(name: str, change: Callable[[np.ndarray[Any, Any]], np.ndarray[Any, Any]]) -> Columns:
    """The little run with one column changed."""
    data = columns()
    data[name] = change(data[name].copy())
    return data
