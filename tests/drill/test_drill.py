"""The trip matrix over the wire, on virtual time: forty faults, six phases; and that a drill can fail."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import pytest

from rig.commands import drill as verb
from rig.drill import odrive_causes
from rig.drill.canopen_rig import CanopenRig
from rig.drill.cause import Cause, Expected
from rig.drill.causes import CAUSES
from rig.drill.causes import verb as strike
from rig.drill.drill import drill
from rig.drill.odrive_rig import ODriveRig
from rig.drill.phase import PHASES, Phase
from tests.some import some

TRACKING = next(p for p in PHASES if p.name == "tracking")


def matrix() -> list[Any]:
    """Every fault in every phase. At every `make test` each while tracking, and every eighth in one of the other
    phases in turn; the rest, two minutes of it, in `make long` and by `hdrig drill`."""
    others = [p for p in PHASES if p is not TRACKING]
    inner = [(TRACKING, others[k // 8 % len(others)]) if k % 8 == 0 else (TRACKING,) for k in range(len(CAUSES))]
    return [
        pytest.param(cause, phase, marks=() if phase in inner[k] else pytest.mark.long)
        for k, cause in enumerate(CAUSES)
        for phase in PHASES
    ]


MATRIX = matrix()


@pytest.mark.slow
@pytest.mark.parametrize(("cause", "phase"), MATRIX, ids=lambda x: x.name)
def test_every_fault_in_every_phase_ends_as_it_has_to(cause: Cause, phase: Phase) -> None:
    outcome = drill(cause, phase)
    assert outcome.passed, f"{outcome.wrong}: {outcome.reason}"


@pytest.mark.slow
@pytest.mark.parametrize(
    "phase", [p if p is TRACKING else pytest.param(p, marks=pytest.mark.long) for p in PHASES], ids=lambda p: p.name
)
@pytest.mark.parametrize("cause", some(odrive_causes.CAUSES, 8), ids=lambda c: c.name)
def test_every_fault_of_an_odrive_in_every_phase_ends_as_it_has_to(cause: Cause, phase: Phase) -> None:
    outcome = drill(cause, phase, ODriveRig)
    assert outcome.passed, f"{outcome.wrong}: {outcome.reason}"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["host's cable pulled", "drive trips by itself", "safe torque off"])
def test_a_fault_in_mid_run_takes_the_torque_off_in_time(name: str) -> None:
    outcome = drill(next(c for c in CAUSES if c.name == name), TRACKING)
    assert outcome.passed, outcome.wrong
    assert outcome.ended == "tripped"
    assert 0 <= outcome.reaction <= outcome.allowed
    assert outcome.rows > 900


@pytest.mark.slow
def test_a_harmless_cause_that_is_expected_to_trip_fails_the_drill() -> None:
    nothing = Cause("nothing at all", lambda rig: None, 0.001)
    outcome = drill(nothing, TRACKING)
    assert not outcome.passed
    assert "expected a trip" in outcome.wrong[0]


@pytest.mark.slow
def test_a_detection_declared_too_fast_fails_the_drill() -> None:
    lost = next(c for c in CAUSES if c.name == "encoder's frames lost")
    outcome = drill(dataclasses.replace(lost, detection=0.0), TRACKING)
    assert any("ms after the cause" in what for what in outcome.wrong)


@pytest.mark.slow
def test_a_fault_that_was_to_be_ridden_out_fails_the_drill_when_it_trips() -> None:
    trips = next(c for c in CAUSES if c.name == "drive trips by itself")
    outcome = drill(dataclasses.replace(trips, expected=Expected.GO_ON), TRACKING)
    assert "expected to go on" in outcome.wrong[0]


@pytest.mark.slow
@pytest.mark.parametrize("phase", PHASES[:2], ids=lambda p: p.name)
def test_a_drive_that_takes_its_time_to_enable_finds_its_reference_still_there(phase: Phase) -> None:
    """Four transitions of 0.2 s and more: the run began without it, and tripped at its first tick."""
    slow = Cause("SDO answers 0.2 s late", strike("slow_sdo", "drive", 0.2), 0.0, Expected.GO_ON)
    outcome = drill(slow, phase)
    assert outcome.passed, f"{outcome.wrong}: {outcome.reason}"
    assert outcome.ended == "completed", outcome.reason


@pytest.mark.slow
def test_old_targets_queued_in_a_dead_bus_never_reach_the_drive() -> None:
    rig = CanopenRig()
    heard: list[tuple[float, bytes]] = []
    rig.assembly.bus.attach("ear", lambda f, t: heard.append((t, f.data)) if f.identifier == 0x201 else None)
    struck = rig.wire.now() + 1.0
    rig.assembly.agenda.after(1.0, lambda: next(c for c in CAUSES if "queued" in c.name).strike(rig) and None)
    ending = rig.run(TRACKING.procedure)
    rig.wire.wait_until(rig.wire.now() + 0.5)
    rig.close()
    assert ending.status == "tripped"
    assert [data for t, data in heard if t > struck + 0.05 and data[:2] == b"\x0f\x00" and data[2:] != b"\0\0"] == []


@pytest.mark.slow
def test_the_verb_prints_one_line_a_fault_and_says_the_worst(capsys: pytest.CaptureFixture[str]) -> None:
    from argparse import Namespace

    assert verb.run(Namespace(only="safe torque off", phase="tracking", drive="cia402")) == 0
    told = capsys.readouterr().out
    assert told.startswith("SIMULATED")
    assert "2 drills, 0 not as expected" in told


@pytest.mark.slow
def test_a_time_nobody_promised_is_in_brackets(capsys: pytest.CaptureFixture[str]) -> None:
    from argparse import Namespace

    assert verb.run(Namespace(only="limit lowered", phase="locked", drive="cia402")) == 0
    head, row = capsys.readouterr().out.splitlines()[2:5:2]
    assert head.startswith("(ms) not seen by design")
    assert re.search(r" \(\d+\.\d\)$", row), row
