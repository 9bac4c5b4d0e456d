"""hdrig tune: gains that turn the motor smoothly at the slow speed, found on the rig at hand.

Method, step based: (1) torque steps give inertia and friction at the motor; (2) the three poles of the position loop
are placed on one spot λ; (3) short slow triangles are tried with λ rising until the motor turns smoothly with margin.
The lowest λ that does is kept: more would only make the torque noisier.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rig.bench import Bench, override
from rig.commands.options import bench_arguments, open_bench
from rig.core.errors import Exit, UsageError
from rig.interrupts import Interrupts
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.step_test import StepTest
from rig.session import Session

if TYPE_CHECKING:
    from rig.analysis.smoothness import Smoothness
    from rig.analysis.step_response import StepResponse
    from rig.control.pid import Gains

BANDWIDTHS = (15.0, 25.0, 40.0, 60.0, 90.0, 130.0)  # rad/s, tried from the gentlest
MARGIN = 0.5  # of the limits of a good run: a trial is short, the real run is long
TRIAL = KinematicError(amplitude_deg=360.0, frequency=0.04, cycles=1.0)  # 9.6 rpm like the slow run, 25 s


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig tune`."""
    bench_arguments(parser)
    parser.add_argument("--write", type=Path, metavar="FILE", help="new bench file with the gains found")


def run(args: argparse.Namespace) -> int:
    """Steps, trials, before and after; exit 1 when no gains pass."""
    bench, clock = open_bench(args)
    if args.write is not None and args.write.exists():
        raise UsageError(f"{args.write} exists already; give the name of a new file")
    if bench.simulated:
        print(f"SIMULATED: bench '{bench.file.name}' is the twin, {clock} clock", file=sys.stderr)
    with Interrupts() as interrupts, Session(bench, clock, args.out, interrupts, "tuning") as session:
        print(f"sign and scale: {session.prove().sentence}", file=sys.stderr)
        step = _step(session)
        print(
            f"step test: inertia at the motor {step.inertia * 1e3:.3f} ± {step.inertia_scatter * 1e3:.3f} g·m², "
            f"friction {step.friction:.3f} ± {step.friction_scatter:.3f} N·m (1 sigma of one step, {step.steps} steps)"
        )
        print(table_row("before", bench, before := _trial(session, bench)))
        best = _search(session, bench, step)
    if best is None:
        print(f"FAIL: no bandwidth up to {BANDWIDTHS[-1]:g} rad/s turns the motor smoothly; {before.advice}")
        return int(Exit.OUT_OF_LIMITS)
    if args.write is not None:
        args.write.write_text(best.text, encoding="utf-8")
        print(f"gains written to {args.write}: use it with --bench {args.write}")
    return int(Exit.PASS)


def _step(session: Session) -> StepResponse:
    from rig.analysis.step_response import step_response
    from rig.runfile.run import Run

    limit = session.bench.gains.torque_limit
    done = session.run(StepTest(torque=0.25 * limit))
    run = Run.open(done.folder)
    return step_response(run.need("t"), run.need("theta_m"), run.need("tau_applied"))


def _search(session: Session, bench: Bench, step: StepResponse) -> Bench | None:
    """The first bandwidth that passes with margin; prints every trial."""
    from rig.control.placement import place_poles, speed_filter

    for bandwidth in BANDWIDTHS:
        gains = place_poles(
            step.inertia, bandwidth, bench.gains.torque_limit, step.friction, bench.file.control.feedforward
        )
        candidate = with_gains(bench, gains, speed_filter(bandwidth))
        smooth = _trial(session, candidate)
        print(table_row(f"{bandwidth:g} rad/s", candidate, smooth))
        if smooth.within(MARGIN):
            return candidate
    return None


def _trial(session: Session, bench: Bench) -> Smoothness:
    """A short slow triangle with these gains."""
    from rig.analysis.smoothness import smoothness
    from rig.runfile.run import Run

    session.rewire(bench)
    return smoothness(Run.open(session.run(TRIAL).folder))


def with_gains(bench: Bench, gains: Gains, filter_time: float) -> Bench:
    """The bench with other gains, said to be measured."""
    from rig.config import read_bench

    values = {
        "control.Kp": gains.Kp,
        "control.Ki": gains.Ki,
        "control.Kd": gains.Kd,
        "control.integrator_limit": gains.integrator_limit,
        "loop.speed_filter": filter_time,
    }
    text = override(bench.text, [f"{key}={float(f'{value:.4g}')!r}" for key, value in values.items()], bench.source)
    return replace(bench, text=text, file=read_bench(text, bench.source))


def table_row(name: str, bench: Bench, smooth: Smoothness) -> str:
    """One line of before and after."""
    c = bench.file.control
    return f"{name:>10s}: Kp {c.Kp:.3g} Ki {c.Ki:.4g} Kd {c.Kd:.3g}, {smooth.sentence}"
