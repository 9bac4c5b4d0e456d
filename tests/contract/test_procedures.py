"""Every procedure of the catalogue on the twin: says what it will do, does no more, ends, can be stopped anywhere."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rig.analysis.analyse import PROCEDURES as ANALYSES
from rig.analysis.findings.figure_names import GIVEN_BY, figures_of
from rig.analysis.sensors.latch_skew_words import LABEL as SKEW
from rig.bench import read
from rig.campaign.sweeps import CATALOGUE as SWEEPS
from rig.core.channels import CHANNELS
from rig.core.kinds import KINDS, OTHER, Regime, kinds_of, regime_of
from rig.core.operator import LockOutput
from rig.core.procedure import Procedure
from rig.evaluation.afterwards import AFTER
from rig.guard import Guard
from rig.loop import Ending, Loop
from rig.procedures import CATALOGUE, procedure_class
from rig.process.interrupts import Interrupts
from rig.report import words
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from tests.fakes import ListSink

COMPENSATED = "compensated"  # read by `rig.analysis.across_runs.compensation`, beside a run without
SHORTER: dict[str, dict[str, Any]] = {
    "kinematic-error": {"amplitude_deg": 360.0, "frequency": 0.04, "cycles": 1.0},
    "constant-torque": {"revolutions": 10, "settle": 1.0},
    "full-turn": {"speed_rpm": 120.0},
    "speed-convergence": {"amplitude_deg": 360.0, "speeds_rpm": "60,40,30"},
    "compensated": {"revolutions": 2, "speed_rpm": 60.0, "a": (2e-5, 1e-4), "b": (0.0, -1e-4)},
    "coast-down": {"repeats": 1, "speed_rpm": 200.0},
    "friction": {"speeds_rpm": "60,200", "seconds": 1.0, "breakaways": 1},
    "sentinel": {"revolutions": 10, "settle": 1.0},
    "standstill": {"duration": 3.0},
    "held-standstill": {"duration": 3.0},
    "skew": {"speeds_rpm": "60,120", "repeats": 2},
    "stiffness-lock": {"tau_max": 6.0, "rate": 3.0, "cycles": 1, "hold": 0.2, "rates": (1.0,)},
}


def made(name: str) -> Procedure:
    return procedure_class(name)(**SHORTER.get(name, {}))


def run(name: str, stop_at: int | None = None) -> tuple[Ending, ListSink, Procedure]:
    bench, supervisor, interrupts, sink = read("twin"), Supervisor(), Interrupts(), ListSink()
    rig, procedure, setting = bench.open("virtual"), made(name), bench.setting(lambda text: None)
    rig.connect()
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    if procedure.output_locked and rig.operator is not None:
        rig.operator.make(LockOutput())

    def watch(sample: object) -> None:
        if stop_at is not None and len(sink.rows) >= stop_at:
            interrupts.count = max(interrupts.count, 1)

    guard = Guard(bench.limits, procedure.envelope(setting), setting.ratio)
    loop = Loop(rig, supervisor, guard, sink, interrupts, LoopTiming(setting.period, virtual=True), watch)
    ending = loop.run(procedure, setting)
    rig.close()
    return ending, sink, procedure


@pytest.mark.parametrize("name", CATALOGUE)
def test_its_names_and_needs_are_those_of_the_run_format(name: str) -> None:
    procedure = made(name)
    assert procedure.name in KINDS
    assert procedure.title() == name
    assert set(procedure.needs) <= {c.name for c in CHANNELS}
    assert procedure.__class__.__doc__


@pytest.mark.parametrize("name", CATALOGUE)
def test_what_the_motor_does_is_said_once(name: str) -> None:
    """By the kind of its runs, or by itself where they are of none."""
    assert procedure_class(name).regime is Regime.OTHER or procedure_class(name).name == OTHER


@pytest.mark.parametrize("name", CATALOGUE)
def test_its_run_is_read_by_an_analysis_or_answers_itself(name: str) -> None:
    kind = procedure_class(name)
    read = kind.name in (*ANALYSES, *kinds_of(Regime.LOCKED)) or kind.label in (SKEW, COMPENSATED)
    assert read is not kind.answers


@pytest.mark.parametrize("kind", [k for k in KINDS if k != OTHER])
def test_a_kind_of_run_has_its_analysis_its_figures_and_its_word(kind: str) -> None:
    assert kind in (*ANALYSES, *kinds_of(Regime.LOCKED))
    assert figures_of(kind)
    assert KINDS[kind].title == words.kind(kind)
    assert regime_of(kind) is not Regime.OTHER


def test_only_kinds_of_run_are_analysed_and_have_figures() -> None:
    assert set(ANALYSES) <= set(KINDS)
    assert {kind for _, kinds in GIVEN_BY for kind in kinds} <= set(KINDS)


def test_every_sweep_is_followed_by_what_it_is_for() -> None:
    assert set(AFTER) == set(SWEEPS)
    assert {name.replace("-", "_") for name in SWEEPS if name.endswith("-sweep")} <= set(KINDS)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.long) if n == "speed-convergence" else n for n in CATALOGUE]
)
def test_it_completes_on_the_twin_within_what_it_announced(name: str) -> None:
    ending, sink, procedure = run(name)
    assert ending.status == "completed", ending
    envelope = procedure.envelope(read("twin").setting(lambda text: None))
    theta = np.array([row[0].theta_m for row in sink.rows])
    asked = np.array([row[1] for row in sink.rows])
    assert sink.rows[-1][0].t <= envelope.duration * 1.02 + 0.1
    assert np.max(np.abs(theta - theta[0])) <= 1.02 * envelope.travel + 0.2
    assert np.max(np.abs(asked)) <= envelope.torque + 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("stop_at", [1, 700, 3000])
def test_it_can_be_stopped_anywhere_and_leaves_no_torque(name: str, stop_at: int) -> None:
    ending, sink, procedure = run(name, stop_at)
    assert ending.status in ("stopped", "completed")
    assert sink.rows[-1][2] == 0.0
    if procedure.closes_loop:
        assert abs(sink.rows[-1][0].omega_m) < 1.0
    elif ending.status == "stopped":  # nothing is known yet to brake by: friction does it
        assert "torque off at once and no braking" in ending.reason
        assert "turns on" not in ending.reason
