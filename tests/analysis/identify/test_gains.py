"""The drive's torque and the torque sensor's, of stretches at like speeds under several loads."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.identify.gains import disagreement
from rig.analysis.identify.means import Mean, Torque
from rig.core.errors import Exit
from rig.evaluation.identification import Identification

N = 50.0


def means(gain: float, loads: dict[float, tuple[float, ...]], mu: float = 0.0) -> list[Mean]:
    """Of stretches at speeds [rad/s] under loads [N·m], a torque sensor of that gain and friction of a share `mu`."""
    rng, out = np.random.default_rng(1), []
    for omega, weights in loads.items():
        for way in (1.0, -1.0):
            for weight in weights:
                tau_l = way * (0.4 + 0.02 * omega) + weight
                friction = way * (0.2 + 3e-3 * omega + 0.3 * np.exp(-omega) + mu * abs(tau_l) / N)
                motor = friction + tau_l / N - gain * tau_l / N + 1e-4 * rng.standard_normal()
                one = [Torque(x, np.array([x])) for x in (motor, gain * tau_l - weight, friction + tau_l / N)]
                out.append(Mean("run", way * omega, 10.0, one[0], one[1], one[2], 0.0, -weight))
    return out


def test_a_sensor_in_another_unit_is_told_with_the_factor() -> None:
    said = disagreement(means(1.3558, {1.0: (0.0, 5.0), 12.0: (0.0,), 30.0: (0.0,)}), N)
    assert said.startswith("For every N·m that the torque sensor shows more the drive gives 0.74 ± 0.0")


@pytest.mark.parametrize(
    ("loads", "mu"),
    [
        ({1.0: (0.0, 5.0), 12.0: (0.0,), 30.0: (0.0,)}, 0.08),  # friction that grows with the load
        ({1.0: (5.0,), 12.0: (0.0,), 30.0: (0.0,)}, 0.0),  # a load at one speed alone is that speed's friction
        ({1.0: (0.0, 0.5)}, 0.0),
        ({}, 0.0),
    ],
)
def test_what_reads_as_it_should_or_does_not_tell_is_left_alone(
    loads: dict[float, tuple[float, ...]], mu: float
) -> None:
    assert disagreement(means(1.0, loads, mu), N) == ""


def test_a_load_at_one_speed_alone_tells_nothing_of_a_gain() -> None:
    assert disagreement(means(1.3558, {1.0: (5.0,), 12.0: (0.0,)}), N) == ""


@pytest.mark.parametrize(("open_", "doubtful"), [((), False), (("K",), False), ((), True)])
def test_it_makes_an_identification_inconclusive(open_: tuple[str, ...], doubtful: bool) -> None:
    found: Any = SimpleNamespace(undetermined=open_, doubtful=doubtful)
    none: Any = None
    done = Identification(found, none, (), (), 1, 1, simulated=True)
    assert done.exit is (Exit.INCOMPLETE if open_ or doubtful else Exit.PASS)
