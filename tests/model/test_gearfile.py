"""The gear file: what is written is read again bit by bit, and what is wrong in it is said with key and expectation."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rig.bench import read as read_bench
from rig.bench import twin_parameters
from rig.core.errors import UsageError
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.gearfile import Covered, GearFile, MeasuredSeries, Parameter, declared, dumps, loads, read, write


def made() -> GearFile:
    gear: Gear = twin_parameters(read_bench("twin").file).gear
    file = declared(gear, serial="TWIN-40-50", simulated=True)
    K = Parameter(7159.123456789, (7150.1, 7168.2), "measured", ("lock_1", "speed_300"), "whole path")
    series = FourierSeries((1e-5, -2.5e-4, 1 / 3), (math.pi, 0.0, -1e-9))
    root = np.random.default_rng(1).standard_normal((6, 6))
    measured = MeasuredSeries(series, root @ root.T, "measured", ("slow_1",))
    return replace(
        file, parameters={**file.parameters, "K": K}, kinematic_error=measured, made="today", cannot=("B_m and B_ml",)
    )


def test_what_is_written_is_read_again_bit_by_bit(tmp_path: Path) -> None:
    file = made()
    write(tmp_path / "gear.toml", file)
    again = read(tmp_path / "gear.toml")
    assert again.parameters["K"] == file.parameters["K"]
    assert again.kinematic_error.series == file.kinematic_error.series
    assert np.array_equal(again.kinematic_error.covariance, file.kinematic_error.covariance)
    assert (again.output, again.serial, again.simulated, again.made, again.cannot) == (
        "flexspline", "TWIN-40-50", True, "today", ("B_m and B_ml",),
    )  # fmt: skip
    assert again.gear() == file.gear()


def test_what_was_measured_beside_the_parameters_is_kept_with_its_unit() -> None:
    loss = Parameter(1.6e-4, (1.5e-4, 1.7e-4), "measured", ("lock_1",), "gap at zero torque")
    text = dumps(replace(made(), characteristics={"hysteresis_loss": loss}))
    assert dict(loads(text, "gear.toml").characteristics) == {"hysteresis_loss": loss}
    assert dict(loads(dumps(made()), "gear.toml").characteristics) == {}
    with pytest.raises(UsageError, match="expected 'rad'; units are never converted"):
        loads(
            text.replace(
                'hysteresis_loss = {value = 0.00016, low = 0.00015, high = 0.00017, unit = "rad"',
                'hysteresis_loss = {value = 0.00016, unit = "arcmin"',
            ),
            "gear.toml",
        )
    with pytest.raises(UsageError, match="unknown key 'hysteresis_los' in characteristics; did you mean"):
        loads(text.replace("hysteresis_loss =", "hysteresis_los ="), "gear.toml")


def test_the_range_it_was_identified_in_is_kept_and_a_wrong_one_is_said() -> None:
    file = replace(made(), covered=Covered((9.6, 314.1), (-40.0, 0.0)))
    text = dumps(file)
    assert loads(text, "gear.toml").covered == file.covered
    assert loads(dumps(made()), "gear.toml").covered is None
    with pytest.raises(UsageError, match=r"covered.speed_rpm = .*: expected the least and the largest, rpm"):
        loads(text.replace("[9.6, 314.1]", "[314.1, 9.6]"), "gear.toml")
    with pytest.raises(UsageError, match=r"covered.load = 3.0: expected the least and the largest, N·m"):
        loads(text.replace("[-40.0, 0.0]", "3.0"), "gear.toml")


def test_a_parameter_nobody_measured_has_no_interval() -> None:
    again = loads(dumps(made()), "gear.toml")
    assert math.isnan(again.parameters["J_m"].half)
    assert again.parameters["J_m"].origin == "declared"
    assert again.parameters["K"].half == pytest.approx(9.05)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('schema = "hdrig.gear/1"', 'schema = "hdrig.bench/1"', "no gear file"),
        ("J_m = {", "Jm = {", "unknown key 'Jm' in parameters; did you mean 'J_m'"),
        ('unit = "kg·m²"', 'unit = "g·m²"', "expected 'kg·m²'; units are never converted"),
        ('from = "measured", runs = ["lock_1"', 'from = "guessed", runs = ["lock_1"', "measured, declared, assumed"),
        ("low = 7150.1", "low = 7160.1", "lies outside its own interval"),
        ("value = 7159.123456789", "value = -1.0", "expected more than 0"),
        ("value = 50.0", "value = -50.0", "parameters.N.value = -50: expected more than 0"),
        ("value = 7159.123456789", "value = nan", "expected a finite number"),
        ('output = "flexspline"', 'output = "wave_generator"', "expected flexspline or circular_spline"),
        ('unit = "rad"', 'unit = "arcsec"', "expected 'rad' at the output"),
        ("simulated = true", "simulated = 1", "expected true or false"),
    ],
)
def test_what_is_wrong_is_one_sentence_with_key_and_expectation(old: str, new: str, said: str) -> None:
    text = dumps(made())
    assert old in text
    with pytest.raises(UsageError, match=r"^gear\.toml: ") as caught:
        loads(text.replace(old, new, 1), "gear.toml")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_parameter_is_named_with_its_unit() -> None:
    lines = [line for line in dumps(made()).splitlines() if not line.startswith("B_sp")]
    with pytest.raises(UsageError, match=r"'parameters\.B_sp' is missing; expected a table with a value in N·m·s/rad"):
        loads("\n".join(lines), "gear.toml")


def test_a_file_that_is_not_there_or_no_toml_is_said(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot read"):
        read(tmp_path / "none.toml")
    (tmp_path / "bad.toml").write_text("= 3")
    with pytest.raises(UsageError, match="not valid TOML"):
        read(tmp_path / "bad.toml")
