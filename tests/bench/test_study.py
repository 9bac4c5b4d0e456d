"""A blind-case study spreads over cores by the standard library alone, and says the same on one and two workers.

`concurrent.futures.ProcessPoolExecutor`, as `tests.blind.generate` and `tests.blind.score` use it: a case takes
seconds, shares nothing with the others and leaves files, so what joblib adds (memory mapping of shared arrays, a cache)
has nothing to do here, and dask or ray, which add a scheduler and other machines, cost an installation and a service.
Every case carries its seed; no random state crosses from one to the next, `map` keeps the order. Those are the two
reasons why the number of workers cannot be seen in the result.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import pytest

from tests.blind import folder
from tests.blind.builder import Builder
from tests.blind.test_generate import stage, taken, tiny

SEEDS = (3, 4, 5, 6)


def one_case(job: tuple[int, Path]) -> str:
    """A short campaign of the independent plant on a rig drawn from the seed; its SHA-256 over all run folders."""
    seed, out = job
    plan = tiny()
    on = stage(plan, seed)
    return folder.write_campaign(taken(Builder(on.rig), on), out / str(seed), plan, on.rig)


@pytest.mark.slow
def test_a_study_on_two_workers_has_the_bytes_of_the_study_on_one(tmp_path: Path) -> None:
    found = []
    for workers in (1, 2):
        with ProcessPoolExecutor(workers) as pool:
            found.append(list(pool.map(one_case, [(seed, tmp_path / str(workers)) for seed in SEEDS])))
    assert found[0] == found[1]
    assert len(set(found[0])) == len(SEEDS), "every seed is another rig"
