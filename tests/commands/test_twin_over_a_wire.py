"""SIMULATED is said of the twin over a wire, where only the devices can know; a rig in fault is said to be so first."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.cli import main
from rig.core.errors import Exit
from tests.drivers.virtual import Wired, wired


@pytest.fixture
def rig(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Wired]:
    """Every bench that is opened is this one."""
    made = wired()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(type(made.bench), "open", lambda bench, clock: made.instruments)
    yield made
    made.instruments.close()


def in_fault(rig: Wired) -> None:
    rig.twin.drive.fault(0x3210)
    rig.wire.wait_until(rig.wire.now() + 0.01)


@pytest.mark.slow
@pytest.mark.long
def test_the_doctor_says_so_of_every_device_and_of_the_bench(rig: Wired, capsys: pytest.CaptureFixture[str]) -> None:
    main(["doctor", "--bench", "twin-can"])
    said = capsys.readouterr().out
    for device in ("drive", "load_encoder", "torque_sensor"):
        assert f"{device} (SIMULATED): " in said
    assert "twin-can (SIMULATED): " in said


@pytest.mark.parametrize("fault", [False, True])
def test_a_reset_says_so(rig: Wired, capsys: pytest.CaptureFixture[str], fault: bool) -> None:
    if fault:
        in_fault(rig)
    assert main(["reset", "--bench", "twin-can"]) == Exit.PASS
    assert all("twin-can (SIMULATED)" in line for line in capsys.readouterr().out.splitlines())


@pytest.mark.slow
def test_a_safe_torque_off_that_stands_is_named_by_the_reset_and_by_the_run_it_refuses(
    rig: Wired, capsys: pytest.CaptureFixture[str]
) -> None:
    rig.twin.drive.sto(True, fault=False)
    rig.wire.wait_until(rig.wire.now() + 0.01)
    assert main(["reset", "--bench", "twin-can"]) == Exit.PASS
    said = capsys.readouterr().out
    assert "nothing to reset" in said
    assert "no voltage at its power stage" in said
    assert main(["run", "jog", "--bench", "twin-can"]) == Exit.NOT_READY
    assert "stays in 'switch on disabled'" in (told := capsys.readouterr().err)
    assert "safe torque off, a hard-wired stop or a missing supply keeps a drive there" in told


def test_a_run_on_a_rig_in_fault_says_both_before_anything_is_announced(
    rig: Wired, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    in_fault(rig)
    assert main(["run", "jog", "--bench", "twin-can"]) == Exit.NOT_READY
    said = capsys.readouterr().err
    assert "SIMULATED: the devices of bench 'twin-can' say that they are the twin's, over the wire" in said
    assert "the rig is in fault: " in said
    assert "about to turn" not in said
    assert list(tmp_path.iterdir()) == []
