"""Work shared with a forked copy: the same results in the same order, whoever made them."""

import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from rig.process import workers
from rig.process.workers import each, first_that, meanwhile


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a command: where tests run beside each other their processes have a thread of their own."""
    monkeypatch.setattr(threading, "active_count", lambda: 1)


def made(n: int) -> dict[str, object]:
    time.sleep(0.01)  # long enough for both to get some
    rows = np.arange(3.0 * n).reshape(3, n)
    return {"pid": os.getpid(), "rows": rows, "columns": rows.T, "some": rows[:, ::2], "words": f"{n}"}


def test_results_stand_in_the_order_of_the_items_and_two_processes_made_them() -> None:
    found = each(made, range(40))
    assert [f["words"] for f in found] == [f"{n}" for n in range(40)]
    assert len({f["pid"] for f in found}) == 2
    for n, f in enumerate(found):
        rows = np.arange(3.0 * n).reshape(3, n)
        assert np.array_equal(f["rows"], rows)
        assert np.array_equal(f["columns"], rows.T)
        assert np.array_equal(f["some"], rows[:, ::2])


def test_arrays_of_the_copy_may_be_changed_and_outlive_it() -> None:
    for f in each(made, range(1, 20)):
        f["rows"] += 1.0
        assert f["rows"].min() == 1.0


def test_one_process_makes_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    two = each(lambda n: np.sin(n), range(10))
    monkeypatch.setattr(workers, "WORKERS", 1)
    assert each(lambda n: np.sin(n), range(10)) == two
    assert {f["pid"] for f in each(made, range(5))} == {os.getpid()}


def test_beside_another_thread_there_is_no_copy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threading, "active_count", lambda: 2)
    assert {f["pid"] for f in each(made, range(5))} == {os.getpid()}
    with meanwhile(os.getpid) as found:
        assert found() == os.getpid()


def test_what_the_copy_did_not_bring_is_made_here() -> None:
    here = os.getpid()

    def dies(n: int) -> int:
        time.sleep(0.01)
        if os.getpid() != here:
            os._exit(3)
        return n

    assert each(dies, range(8)) == list(range(8))
    with meanwhile(lambda: dies(7)) as found:
        assert found() == 7


def test_an_error_is_raised_as_if_there_were_no_copy() -> None:
    def wrong(n: int) -> int:
        raise ValueError(f"item {n}")

    with pytest.raises(ValueError, match="item"):
        each(wrong, range(8))
    with meanwhile(lambda: wrong(3)) as found, pytest.raises(ValueError, match="item 3"):
        found()


def test_meanwhile_is_made_by_the_copy_while_the_block_runs(tmp_path: Path) -> None:
    mark = tmp_path / "begun"

    def waits() -> int:
        while not mark.exists():
            time.sleep(0.001)
        return os.getpid()

    with meanwhile(waits) as found:
        mark.touch()
        assert found() != os.getpid()


@pytest.mark.parametrize("processes", [1, 2])
def test_the_first_that_makes_something_counts_whoever_tried_it(
    processes: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(workers, "WORKERS", processes)

    def of(n: int) -> str | None:
        with (tmp_path / f"{n}").open("a") as file:
            file.write(f"{os.getpid()}\n")
        return f"{n} by {os.getpid()}" if n in (3, 4, 6) else None

    def tried(n: int) -> set[int]:
        return {int(pid) for pid in (tmp_path / f"{n}").read_text().split()}

    assert first_that(of, [0, 1, 2, 3, 4, 5]) == f"3 by {os.getpid()}"  # a copy found it, and it is made here
    assert [len(tried(n)) for n in range(4)] == [1, 1, 1, processes]
    assert tried(0) == tried(2) == {os.getpid()}
    assert (tried(1) == {os.getpid()}) is (processes == 1)
    assert not (tmp_path / "4").exists()
    assert first_that(of, [6, 7]) == f"6 by {os.getpid()}"
    assert first_that(of, [8]) is None
    assert first_that(of, []) is None


def test_a_block_that_raises_leaves_no_copy_behind(tmp_path: Path) -> None:
    mark = tmp_path / "copy"

    def sleeps() -> None:
        mark.write_text(str(os.getpid()))
        time.sleep(60)

    def error() -> None:
        with meanwhile(sleeps):
            while not (mark.exists() and mark.read_text()):
                time.sleep(0.001)
            raise ValueError("block")

    with pytest.raises(ValueError, match="block"):
        error()
    assert int(mark.read_text()) != os.getpid()
    with pytest.raises(ProcessLookupError):
        os.kill(int(mark.read_text()), 0)


def test_a_copy_is_deaf_to_ctrl_c_from_its_first_moment() -> None:
    """Between the fork and its work an interrupt unwound in it what stood behind the fork in the main process."""

    def heard(n: int) -> tuple[int, bool]:
        time.sleep(0.05)  # so that either takes some
        return os.getpid(), signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())

    found = set(each(heard, range(8)))
    assert len(found) == 2
    assert {hears for who, hears in found if who == os.getpid()} == {True}
    assert {hears for who, hears in found if who != os.getpid()} == {False}
