"""The twin of the bench file, for tests: read straight from TOML, so that they do not wait on the bench."""

from __future__ import annotations

import dataclasses
import importlib
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
import numpy as np
import pytest

import rig
import sim.kernel
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from sim.effects import Effects
from sim.parameters import TwinParameters

BENCH = Path(rig.__file__).parent / "benches" / "twin.toml"
OUTPUTS = {"flexspline": 1, "circular_spline": 0}  # sigma


def bare(section: dict[str, Any]) -> dict[str, Any]:
    """Values without units and provenance."""
    return {k: v["value"] if isinstance(v, dict) and "value" in v else v for k, v in section.items()}


def read_twin() -> TwinParameters:
    """The twin's parameters as the bench file states them."""
    bench = tomllib.loads(BENCH.read_text(encoding="utf-8"))
    gear, twin = bare(bench["gear"]), bare(bench["twin"])
    error = twin.pop("kinematic_error")
    twin.pop("seed")
    sections = {name: bare(section) for name, section in twin.pop("effects").items()}
    series = FourierSeries.from_polar(np.radians(error["C_deg"]), np.radians(error["psi_deg"]))
    friction = {name: twin.pop(name) for name in ("tau_c", "tau_s", "omega_s", "F_cl")}
    numbers = {name: gear[name] for name in ("J_m", "J_l", "K", "B_m", "B_l", "B_ml", "B_sp")}
    return TwinParameters(
        gear=Gear(ratio=gear["N"], kinematic_error=series, sigma=OUTPUTS[gear["output"]], **numbers, **friction),
        torque_limit=bare(bench["motor"])["torque_limit"],
        motor_counts_per_turn=bare(bench["motor"])["counts_per_turn"],
        load_counts_per_turn=bare(bench["load_encoder"])["counts_per_turn"],
        sensor_range=bare(bench["torque_sensor"])["range"],
        effects=Effects.of(sections),
        **twin,
    )


def with_gear(parameters: TwinParameters, **changes: Any) -> TwinParameters:
    """The same twin with another gear."""
    return dataclasses.replace(parameters, gear=dataclasses.replace(parameters.gear, **changes))


@pytest.fixture
def plain() -> Iterator[ModuleType]:
    """sim/kernel once more, read while numba is switched off."""
    compiled = sim.kernel
    with pytest.MonkeyPatch.context() as patch:
        for name in [name for name in sys.modules if name.split(".")[:2] == ["sim", "kernel"]]:
            patch.delitem(sys.modules, name)
        with pytest.MonkeyPatch.context() as off:  # no longer: the other one may have to be compiled yet
            off.setattr(numba.config, "DISABLE_JIT", True)
            found = importlib.import_module("sim.kernel")
        yield found
    sim.kernel = compiled


FRICTIONLESS: dict[str, float] = {"tau_c": 0.0, "tau_s": 0.0, "F_cl": 0.0}


@pytest.fixture(scope="session")
def twin() -> TwinParameters:
    """The rig of the bench file."""
    return read_twin()


@pytest.fixture(scope="session")
def calm(twin: TwinParameters) -> TwinParameters:
    """The same without wander of its friction."""
    return dataclasses.replace(twin, friction_noise=0.0)
