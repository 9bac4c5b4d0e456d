"""What cannot be compensated is said before the motor turns."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from rig.bench import read
from rig.cli import main
from rig.closing.compensate import compensate, refuse_first, unlike_the_series
from rig.core.errors import Exit, HdrigError, NotReady, UsageError
from rig.model.gearfile import GearFile, dumps
from rig.process.interrupts import Interrupts
from rig.session import Session
from tests.closing.test_compensate import gear

REFUSED = {
    (700.0,): "asks for up to 735 rpm of motor speed, the bench allows 600 rpm",
    (9.6, 700.0): "asks for up to 735 rpm of motor speed",
    (5000.0,): "asks for up to 5250 rpm of motor speed, .*: limits.speed_rpm$",
    (380.0,): r"--speed 380: by the gear file \d\d % of the error there is the gear's dynamics, .* \(order 4 is \d+",
}


@pytest.mark.parametrize("speeds", REFUSED)
def test_a_speed_beyond_the_bench_or_on_a_resonance_is_refused_with_numbers(speeds: tuple[float, ...]) -> None:
    with pytest.raises((NotReady, UsageError), match=REFUSED[speeds]):
        refuse_first(read("twin"), gear(), speeds, 3)


def test_a_slow_speed_first_makes_a_resonant_one_possible() -> None:
    refuse_first(read("twin"), gear(), (380.0, 9.6), 3)


def test_the_slower_speed_that_is_advised_is_one_that_would_do() -> None:
    with pytest.raises(UsageError, match=r"expected a slower one before it, as in --speed \S+ 380") as refused:
        refuse_first(read("twin"), gear(), (380.0,), 3)
    refuse_first(read("twin"), gear(), (380.0, float(str(refused.value).split()[-2])), 3)


def test_where_no_speed_would_do_none_is_advised(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rig.closing.compensate.unlike_the_series", lambda gear, speed: "all of it is something else")
    with pytest.raises(UsageError, match=r"--speed 9\.6: .*: expected a gear file of slow runs: down to 0\.6 rpm"):
        refuse_first(read("twin"), gear(), (9.6,), 3)


def of(serial: str, ratio: float) -> GearFile:
    known = gear()
    N = replace(known.parameters["N"], value=ratio)
    return replace(known, serial=serial, parameters={**known.parameters, "N": N})


@pytest.mark.parametrize(("serial", "ratio"), [("X-1", 50.0), ("TWIN-40-50", 100.0), ("", 100.0)])
def test_the_file_of_another_gear_is_refused_with_both_ratios_and_serials(serial: str, ratio: float) -> None:
    with pytest.raises(UsageError) as refused:
        refuse_first(read("twin"), of(serial, ratio), (9.6,), 3)
    for said in (f"gear {serial or 'without serial'}, ratio {ratio:g}", "gear TWIN-40-50, ratio 50"):
        assert said in str(refused.value)


@pytest.mark.parametrize("serial", ["", "TWIN-40-50"])
def test_a_file_that_names_no_serial_is_taken_by_its_ratio(serial: str) -> None:
    refuse_first(read("twin"), of(serial, 50.0), (9.6,), 3)


@pytest.mark.parametrize("option", ["--gear", "--campaign"])
def test_nothing_is_made_of_another_gear_by_either_option(
    option: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "gear.toml").write_text(dumps(of("X-1", 100.0)), encoding="utf-8")
    monkeypatch.setattr("rig.commands.compensate.gear_of", lambda folders, terms, say: of("X-1", 100.0))
    monkeypatch.setattr("rig.commands.compensate.expand", lambda paths: paths)
    out = tmp_path / "out"
    assert main(["compensate", option, str(tmp_path / "gear.toml"), "--out", str(out)]) == Exit.USAGE
    assert "gear X-1, ratio 100" in capsys.readouterr().err
    assert not out.exists() or not list(out.iterdir())


def test_at_a_slow_speed_the_error_is_the_series() -> None:
    assert unlike_the_series(gear(), 9.6) == ""


def test_nothing_moves_before_the_refusal(tmp_path: Path) -> None:
    with Session(read("twin"), "virtual", tmp_path, Interrupts()) as session, pytest.raises(HdrigError):
        compensate(session, gear(), [700.0], 3, lambda text: None, lambda one: None)
    assert session.proof is None
    assert list(tmp_path.iterdir()) == []
