"""Compiles once what is compiled, before every worker of pytest would do it for itself: numba keeps it on disk.

`python -m tests.compiled`: a minute on a fresh clone, six seconds afterwards.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

DEAD_ZONE = "twin.effects.stiffness.gap_deg=0.3"  # one effect, and the twin takes the way of them all


def rig_with_effects() -> None:
    """The twin's plant as it is where the paper's model lacks something: half of all the time."""
    _step((DEAD_ZONE,))


def others() -> None:
    """The plant of the paper's model, gears in simulation, and the plant and reader of a blind campaign."""
    from rig.bench import read, twin_parameters
    from rig.model.simulate import each_under_torque, under_torque

    _step(())
    gear, t = twin_parameters(read("twin").file).gear, np.linspace(0.0, 0.01, 11)
    under_torque(gear, t, np.full(t.size, 0.3))
    each_under_torque([gear, gear], t, np.full(t.size, 0.3))
    with tempfile.TemporaryDirectory() as folder:
        _blind(Path(folder))


def _step(overrides: Sequence[str]) -> None:
    from rig.bench import read, twin_parameters
    from sim.plant import Plant

    Plant(twin_parameters(read("twin", overrides).file)).advance(1e-3, 0.1)


def _blind(folder: Path) -> None:
    """A campaign of half a minute is made and read."""
    from rig.analysis.tracing.runs.campaign import read_campaign
    from tests.blind.builder import Builder
    from tests.blind.folder import write_campaign
    from tests.blind.test_generate import stage, taken, tiny

    on = stage(tiny())
    builder = Builder(on.rig)
    write_campaign(taken(builder, on), folder / "case", on.plan, on.rig)
    read_campaign(folder / "case")


def main() -> None:
    """Both at a time: there are two cores."""
    parts: tuple[Callable[[], None], ...] = (rig_with_effects, others)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for made in [pool.submit(part) for part in parts]:
            made.result()


if __name__ == "__main__":
    main()
