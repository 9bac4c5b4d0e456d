"""Lines in order that need not fit into the memory."""

from __future__ import annotations

import tempfile
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.core import in_order as module
from rig.core.errors import DataError
from rig.core.in_order import Keyed, in_order


@pytest.mark.slow
@given(st.lists(st.integers(0, 4), max_size=40), st.booleans())
def test_the_order_is_that_of_a_sort_in_memory_equal_keys_in_the_order_they_came(
    keys: list[int], reverse: bool
) -> None:
    found = [((key,), f"{i} \ud800\n") for i, key in enumerate(keys)]
    wanted = [line for _, line in sorted(found, key=lambda pair: pair[0], reverse=reverse)]
    with pytest.MonkeyPatch.context() as short:
        short.setattr(module, "PIECE", 5)
        short.setattr(module, "BACK", 2)
        assert list(in_order(iter(found), reverse)) == wanted


@pytest.mark.slow
def test_ten_times_as_many_lines_take_little_more_memory() -> None:
    def lines(count: int) -> Iterator[Keyed]:
        return ((k * 7919 % count, f"{k:0200d}") for k in range(count))

    def most(count: int) -> int:
        tracemalloc.start()
        assert sum(len(line) for line in in_order(lines(count))) == 200 * count
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    assert most(20 * module.PIECE) < 1.5 * most(2 * module.PIECE)


def test_no_folder_for_temporary_files_is_said_and_few_lines_need_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    monkeypatch.setattr(module, "PIECE", 5)
    assert list(in_order([(2, "b"), (1, "a")])) == ["a", "b"]
    with pytest.raises(DataError, match=rf"long list among the temporary files in {tmp_path}/gone \(No such file"):
        list(in_order((k, "") for k in range(5)))
