"""A configuration file that cannot be read is refused with a sentence, whatever lies at its path."""

import os
from pathlib import Path

import pytest

from rig.config.text_file import load_text
from rig.core.errors import UsageError


def test_a_file_that_cannot_be_read_is_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="No such file"):
        load_text(tmp_path / "absent.toml")
    (tmp_path / "latin.toml").write_bytes(b"name = '\xe9'")
    with pytest.raises(UsageError, match="not UTF-8"):
        load_text(tmp_path / "latin.toml")


@pytest.mark.parametrize("name", ["/dev/zero", "/", "pipe", "huge.toml", "a\x00b.toml", "\ud800.toml", "a" * 5000])
def test_what_never_ends_or_is_no_file_is_not_read_as_a_bench(tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / "pipe")  # nobody ever writes: reading it would wait for ever
    with open(tmp_path / "huge.toml", "wb") as sparse:
        sparse.truncate(2**30)
    with pytest.raises(UsageError) as caught:
        load_text(tmp_path / name)
    assert len(str(caught.value).encode()) < 400 + len(str(tmp_path))
