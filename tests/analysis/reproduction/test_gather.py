"""A campaign's runs read by one process, by two, or while it goes on: the same figures."""

from __future__ import annotations

import json
import shutil
import signal
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.catalogue import exhibits
from rig.analysis.reproduction.gather import Ahead, Entry, Pool, entries, gather

pytestmark = pytest.mark.xdist_group("gather")  # what the module makes is made once, not for every worker

SOME = ("slow_ke_1", "speed_300rpm_1", "lock_20_1")


def said(read: Campaign) -> str:
    """Every claim's ruling and words, and the gear."""
    claims = [(e.number, c.paper, c.ruling, c.words, c.numbers) for e in exhibits(read) for c in e.claims]
    assert read.model is not None
    return json.dumps([claims, {n: (p.value, p.interval) for n, p in read.model.parameters.items()}], default=str)


@pytest.fixture(scope="module")
def found(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> list[Entry]:
    folder = tmp_path_factory.mktemp("campaign")
    for name in SOME:
        (folder / name).symlink_to(shared / "cases" / "open-1" / name)
    return entries_of(folder)


def entries_of(folder: Path) -> list[Entry]:
    """As `entries`, which does not follow links."""
    return [e for name in SOME for e in entries((folder / name).resolve())]


@pytest.mark.long
def test_one_process_and_two_and_reading_ahead_give_the_same_figures(found: list[Entry]) -> None:
    one, two = (gather(found, processes=n) for n in (1, 2))
    with Ahead() as ahead:
        for entry in found:
            ahead.begin(entry.folder)
        assert len(ahead.begun) == 2, "the lock test waits for its slow run"
        third = gather(found, begun=ahead.begun)
    assert said(one) == said(two) == said(third)
    for a, b in zip(one.readings, third.readings, strict=True):
        assert a.name == b.name
        assert (a.fast is None) is (b.fast is None)
        if a.fast is not None and b.fast is not None:
            assert np.array_equal(a.fast.profile.cosine, b.fast.profile.cosine)


def test_a_process_is_deaf_to_ctrl_c_from_its_first_moment() -> None:
    """Before it comes to say so itself it inherits it; the main process hears as before."""
    with Pool(1) as pool:
        blocked = pool.submit(signal.pthread_sigmask, signal.SIG_BLOCK, ()).result()
        assert signal.SIGINT in blocked
        assert pool.submit(signal.getsignal, signal.SIGINT).result() is signal.SIG_IGN
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_a_folder_that_is_no_run_of_ours_is_left_out_and_said(tmp_path: Path, shared: Path) -> None:
    shutil.copytree(shared / "cases" / "open-1" / SOME[2], tmp_path / SOME[2])
    foreign = tmp_path / "theirs"
    foreign.mkdir()
    (foreign / "manifest.json").write_text("{}")
    (tmp_path / "lost").mkdir()
    (tmp_path / "lost" / "samples.parquet").write_bytes(b"")
    said: list[str] = []
    found = entries(tmp_path, said.append)
    assert [e.folder.name for e in found] == [SOME[2]]
    nameless, theirs = said
    assert nameless.startswith("lost: it has samples and no manifest.json; hdrig recover makes it anew")
    assert theirs == 'theirs: manifest.json has no schema, expected "hdrig.run/1"'
