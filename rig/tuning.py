"""Gains that turn the motor smoothly at the slow speed, found on the rig at hand.

Method, step based: (1) torque steps give inertia and friction at the motor; (2) the poles of the loop are placed,
the speed pole at β and the others well below; (3) short slow triangles are tried with β rising until the motor turns
smoothly with margin. The lowest β that does is kept: more would only make the torque noisier.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from rig.bench import Bench, override
from rig.config.bench_file import read_bench
from rig.core.errors import Exit, NotReady
from rig.evaluation.step_test import response_of
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.step_test import StepTest
from rig.refusals import swings_up
from rig.session import Ended, Session

if TYPE_CHECKING:
    from rig.analysis.friction.step_response import StepResponse
    from rig.analysis.smoothness.measure import Smoothness
    from rig.core.gains import Gains

Say = Callable[[str], None]
BANDWIDTHS = (60.0, 90.0, 130.0, 180.0, 250.0, 350.0)  # rad/s of the speed loop, tried from the gentlest
MARGIN = 0.5  # of the limits of a good run: a trial is short, the real run is long
TRIAL = KinematicError(amplitude_deg=540.0, frequency=4 / 150, cycles=1.0)  # 9.6 rpm like the slow run, 37.5 s
CLEARLY = 0.8  # of the speed scatter there was: short trials differ by less without any change of gains
BREAKAWAY = 1.6  # times the measured friction: what the proportional part must give within the following limit


def find_gains(session: Session, bench: Bench, say: Say, note: Say) -> tuple[Bench, Smoothness] | None:
    """The bench with gains that pass, and how evenly the motor turned with them; None when no bandwidth does.

    `say` is told what was measured, `note` of the proof, and that the motor will turn before it does. Raises NotReady
    when no gain can break the motor loose, Ended when a run comes to no end.
    """
    steps = StepTest(torque=0.25 * bench.gains.torque_limit)
    session.check(steps)
    note(steps.announcement(bench.setting(lambda text: None)))
    step = torque_steps(session, steps)  # open loop, so that gains too weak to move anything cannot stand in the way
    say(f"step test: {step.sentence}")
    candidates = candidates_of(bench, step)
    session.rewire(candidates[0])
    note(f"sign and scale: {session.prove().sentence}")
    return _search(session, candidates, say)


def candidates_of(bench: Bench, step: StepResponse) -> list[Bench]:
    """The bench with the gains of each bandwidth that breaks loose before it trips on the following error."""
    from rig.control.placement import place_poles, speed_filter

    limit, viscous = bench.gains.torque_limit, bench.file.control.feedforward
    allowed = bench.limits.following + bench.limits.following_time * TRIAL.reference.speed
    found = []
    for bandwidth in BANDWIDTHS:
        gains = place_poles(step.inertia, bandwidth, limit, step.friction, viscous)
        if gains.Kp * allowed >= BREAKAWAY * step.friction:
            found.append(with_gains(bench, gains, speed_filter(bandwidth)))
    if not found:
        raise NotReady(
            f"friction of {step.friction:.2f} N·m cannot be overcome within the following limit of "
            f"{bench.file.limits.following_deg:g}° at any bandwidth up to {BANDWIDTHS[-1]:g} rad/s"
        )
    return found


def _search(session: Session, candidates: list[Bench], say: Say) -> tuple[Bench, Smoothness] | None:
    """The first bandwidth that passes with margin; says every trial. Raises Ended when one is stopped or trips."""
    for candidate in candidates:
        smooth = _trial(session, candidate)
        say(f"trial: {describe(candidate, smooth)}")
        if not isinstance(smooth, str) and smooth.within(MARGIN):
            return candidate, smooth
    return None


def _trial(session: Session, bench: Bench) -> Smoothness | str:
    """A short slow triangle with these gains; a sentence where it tells nothing of smoothness. Raises Ended when it
    was stopped or tripped: nothing enables a tripped drive again by itself.
    """
    from rig.analysis.smoothness.trial import smoothness_of
    from rig.runfile.run import Run

    session.rewire(bench)
    done = session.run(TRIAL)
    if done.ending.exit is not Exit.PASS:
        raise Ended(f"the trial was ended: {done.ending.reason}", done.ending.exit)
    return smoothness_of(Run.open(done.folder)) or "the motor made no whole turn"


def no_better(before: Smoothness | str, after: Smoothness) -> bool:
    """Whether gains that pass as well turned the motor as evenly, within what one short trial each tells."""
    return not isinstance(before, str) and before.within(MARGIN) and after.sigma > CLEARLY * before.sigma


def as_it_was(session: Session, bench: Bench) -> Smoothness | str:
    """The gains there were. They come last: if they trip the guard, nothing is left that a trip would prevent."""
    if swings_up(bench, TRIAL):
        return "not tried, the loop would swing up by itself on the declared gear"
    try:
        return _trial(session, bench)
    except Ended as end:
        if end.exit is not Exit.TRIPPED:
            raise
        return str(end)


def torque_steps(session: Session, steps: StepTest) -> StepResponse:
    """Inertia and friction at the motor, open loop. Raises Ended when the steps are stopped or trip."""
    done = session.run(steps)
    if done.ending.exit is not Exit.PASS:
        raise Ended(f"tuning was ended: {done.ending.reason}", done.ending.exit)
    return response_of(done.folder)


def with_gains(bench: Bench, gains: Gains, filter_time: float) -> Bench:
    """The bench with other gains, said to be measured."""
    values = {
        "control.Kp": gains.Kp,
        "control.Ki": gains.Ki,
        "control.Kd": gains.Kd,
        "control.integrator_limit": gains.integrator_limit,
        "loop.speed_filter": filter_time,
    }
    text = override(
        bench.text, [f"{key}={float(f'{value:.4g}')!r}" for key, value in values.items()], bench.source, "measured"
    )
    return replace(bench, text=text, file=read_bench(text, bench.source))


def describe(bench: Bench, smooth: Smoothness | str) -> str:
    """Gains and how evenly the motor turned with them."""
    c = bench.file.control
    gains = f"Kp {c.Kp:.4g} N·m/rad, Ki {c.Ki:.4g} N·m/(rad·s), Kd {c.Kd:.4g} N·m·s/rad"
    if isinstance(smooth, str):
        return f"{gains}: {smooth}"
    hunting = f", hunting at {smooth.hunting_hz:.1f} Hz" if smooth.hunts else ""
    return f"{gains}: stuck {100 * smooth.stuck:.1f} %, speed scatter {100 * smooth.sigma:.1f} %{hunting}"
