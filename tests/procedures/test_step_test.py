"""The step test on the twin: no blow against an output that somebody has locked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rig.bench import read
from rig.cli import main
from rig.core.errors import NotReady
from rig.guard import Guard
from rig.loop import Loop
from rig.procedures.step_test import StepTest
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from tests.fakes import ListSink

MOST = 20.0  # N·m at the shaft: 5° of the motor against 7160 N·m/rad are 12.5, and it runs on a little


def steps(prepare: Callable[[Any], None], torque: float = 1.25) -> ListSink:
    """Rows of a step test on the twin after `prepare` has been at its world; those before a refusal are in its args."""
    bench, supervisor, sink = read("twin"), Supervisor(), ListSink()
    rig, setting, procedure = bench.open("virtual"), bench.setting(lambda text: None), StepTest(torque=torque)
    rig.connect()
    prepare(rig.clock)
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    guard, timing = Guard(bench.limits, procedure.envelope(setting), setting.ratio), LoopTiming(0.001, virtual=True)
    loop = Loop(rig, supervisor, guard, sink, Interrupts(), timing)
    try:
        assert loop.run(procedure, setting).status == "completed"
    except NotReady as why:
        why.args = (*why.args, sink)
        raise
    finally:
        rig.close()
    return sink


def test_a_locked_output_is_found_before_a_step_could_wind_it_up() -> None:
    with pytest.raises(NotReady, match="is the output locked") as refusal:
        steps(lambda world: world.lock_output())
    sink = refusal.value.args[1]
    assert 3.0 < max(abs(sample.tau_l) for sample, *_ in sink.rows) < MOST


def test_a_torque_that_friction_eats_is_refused_with_that_torque() -> None:
    with pytest.raises(NotReady, match=r"did not turn 5° with up to 0\.30 N·m"):
        steps(lambda world: None, torque=0.3)


def test_a_free_output_gets_its_steps_both_ways() -> None:
    asked = {tau for _, tau, *_ in steps(lambda world: None).rows}
    assert {1.25, -1.25, 0.0} <= asked


@pytest.mark.slow
def test_it_is_announced_before_the_motor_turns_and_so_is_the_first_of_tune(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With how far and how hard, as every other run that turns the motor; at rest nothing is announced."""
    assert main(["run", "step-test", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().err
    told = "the motor is about to turn: step-test, at most 5.5 turns either way and 1.25 N·m\n"
    assert 0 <= said.index(told) < said.index("step-test: at most")
    assert main(["tune", "--set", "limits.twist_deg=0.012", "--out", str(tmp_path)]) == 5  # ends at the first trial
    assert told in capsys.readouterr().err
    assert main(["run", "standstill", "--with", "duration=0.5", "--out", str(tmp_path)]) in (0, 6)
    assert "about to turn" not in capsys.readouterr().err
