"""hdrig simulate: what it refuses, and what it says of a guess."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from rig.cli import main
from rig.commands.simulate import beyond, describe
from rig.commands.starts import lines, run_ups, went
from rig.core.units import RPM
from rig.model.gearfile import Covered, GearFile, Parameter, write
from rig.model.simulate import at_speed
from rig.report.text.gear import breakaway_beside
from tests.closing.test_compensate import gear


@pytest.mark.parametrize("asked", [["--load", "nan"], ["--load", "inf"], ["--start", "nan"]])
def test_a_torque_that_is_no_number_is_refused_before_anything_is_said(
    asked: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "twin", *asked]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert "in N·m" in said.err


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (["--speed", "0"], "--speed 0 rpm: expected a mean speed of the motor in rpm, either way, not 0"),
        (["--speed", "120", "nan"], "--speed nan rpm: expected"),
        (["--torque", "inf"], "--torque inf: expected a torque of the motor in N·m"),
        (
            ["--torque", "1e300"],
            "at 1e+300 N·m under a load of 0 N·m: the motor would turn at 2.89e+303 rpm; expected",
        ),
        (["--speed", "1e9"], "the motor would turn at 1e+09 rpm; expected up to 100000 rpm"),
        (
            ["--load", "1e6", "--speed", "300"],
            "a load of 1e+06 N·m winds the gear up by 140 rad, its stiffness is",
        ),
        (["--load", "1e6", "--torque", "1"], "a load of 1e+06 N·m winds the gear up by 140 rad"),
        (["--load", "1e6", "--start", "1"], "expected up to 7160 N·m, which is 1 rad"),
        (["--speed", "0.001"], "at 0.001 rpm under a load of 0 N·m: the motor would come to rest"),
    ],
)
def test_a_speed_that_is_none_is_refused_in_the_unit_it_was_asked_in(
    asked: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "twin", *asked]) != 0
    said = capsys.readouterr()
    assert said.out == ""
    assert words in said.err
    assert "rad/s" not in said.err


@pytest.mark.parametrize(
    ("turns", "words"),
    [
        (0.0, "it does not start"),
        (3.1e-5, "it does not start"),
        (2.04, "it stops or sticks after 2 motor turns"),
        (float("nan"), "its motion grows beyond all numbers: "),
        (float("inf"), "its motion grows beyond all numbers: "),
    ],
)
def test_what_became_of_a_motor_that_does_not_turn_is_said_without_a_number_that_is_none(
    turns: float, words: str
) -> None:
    assert went(turns).startswith(words)


def covering(speed_rpm: tuple[float, float], load: tuple[float, float]) -> GearFile:
    return replace(gear(), covered=Covered(speed_rpm, load))


def test_speeds_and_loads_beyond_the_identified_runs_are_said_with_numbers() -> None:
    file = covering((9.6, 314.0), (-40.0, 0.0))
    assert beyond(file, [120.0, -300.0, 318.0], -40.0) == []
    assert beyond(file, [5.0, 500.0], 10.0) == [
        "  extrapolated: 5 rpm; the gear was identified from 9.6 to 314 rpm",
        "  extrapolated: 500 rpm; the gear was identified from 9.6 to 314 rpm",
        "  extrapolated: 10 N·m of load; the gear was identified from -40 to 0 N·m of load",
    ]
    assert beyond(covering((60.0, 60.0), (0.0, 0.0)), [120.0], 0.0) == [
        "  extrapolated: 120 rpm; the gear was identified from 60 rpm alone"
    ]


def test_of_a_gear_that_nobody_measured_nothing_is_said() -> None:
    assert beyond(gear(), [5000.0], 1000.0) == []


def test_a_breakaway_measured_at_rest_stands_beside_one_that_was_assumed() -> None:
    broke = Parameter(0.5, (0.45, 0.55), runs=("a", "b"))
    file = replace(gear(), characteristics={"tau_break": broke})
    (said,) = breakaway_beside(file)
    assert "broke away at 0.500 ± 0.050 N·m (2 runs)" in said.replace("\u00a0", " ")
    assert "tau_s of the model is" in said
    measured = replace(file, parameters={**file.parameters, "tau_s": Parameter(0.5, (0.4, 0.6))})
    assert breakaway_beside(measured) == []
    assert breakaway_beside(gear()) == []


def test_what_is_held_has_no_interval_and_what_is_not_has_one() -> None:
    friction = Parameter(0.3, (0.29, 0.31))
    file = replace(gear(), parameters={**gear().parameters, "tau_c": friction, "tau_s": friction})
    wave = at_speed(file.gear(), 300 * RPM, 0.0)
    for by_torque in (False, True):
        speed, torque = describe(file, [wave], 0.0, by_torque).splitlines()[:2]
        assert ("±" in speed, "±" in torque) == (by_torque, not by_torque)


def test_what_starts_goes_by_the_breakaway_that_was_measured() -> None:
    broke = Parameter(0.51, (0.504, 0.516), runs=("a", "b"))
    assumed = Parameter(0.3, origin="assumed")
    file = replace(gear(), parameters={**gear().parameters, "tau_c": Parameter(0.3), "tau_s": assumed})
    known = replace(file, characteristics={"tau_break": broke})
    for one, turns in ((file, [True, True]), (known, [False, True])):
        assert [bool(made.turning[0]) for made in run_ups(one, [0.45, 0.6], 0.0)] == turns
    said = ["".join(lines(one, [0.6], run_ups(one, [0.6], 0.0))) for one in (file, known)]
    assert "breakaway was not measured (tau_s 0.3 N·m assumed)" in said[0]
    assert "breakaway 0.5100 ± 0.0060 N·m, measured" in said[1]


UNITS = ("rpm", "N·m", "arcsec", "s")


def test_every_row_of_the_table_names_its_unit(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "twin", "--speed", "300"]) == 0
    lines = capsys.readouterr().out.splitlines()[1:-1]
    rows = [re.split(r"\s{2,}", line.strip()) for line in lines]
    assert len(rows) == 15
    assert [row for row in rows if row[0].rpartition(", ")[2] not in UNITS] == []
    assert len({row[0] for row in rows}) == len(rows)


def test_every_column_of_the_starting_table_names_its_unit(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "twin", "--start", "0.3"]) == 0
    head, row = capsys.readouterr().out.splitlines()[1:3]
    names = re.split(r"\s{2,}", head.strip())
    assert [name for name in names if name.rpartition(", ")[2] not in UNITS] == ["does it turn"]
    assert row.endswith("it does not start")


def test_a_start_that_ends_beyond_what_the_gear_was_identified_at_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "gear.toml"
    write(path, replace(gear(), covered=Covered((9.6, 314.0), (-40.0, 0.0))))
    assert main(["simulate", str(path), "--start", "0.3", "2"]) == 0
    said = capsys.readouterr().out
    assert said.count("extrapolated: ") == 1
    assert "rpm; the gear was identified from 9.6 to 314 rpm" in said
