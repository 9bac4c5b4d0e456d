"""The same motion without and with the kinematic error fed forward, at every speed asked for, on one session."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.across_runs.compensation import Expected, Followed, expected, followed, turned, zero_of
from rig.analysis.findings.result import Array
from rig.analysis.orders.align import Alignment
from rig.bench import Bench
from rig.closing.other_gear import refuse_other_gear
from rig.core.errors import Exit, NotReady, UsageError
from rig.core.units import ARCSEC, RPM
from rig.model.fourier import FourierSeries
from rig.model.gearfile import GearFile
from rig.model.linear import natural_frequency
from rig.model.simulate import NoSteadyState, at_speed
from rig.procedures.compensated import Compensated
from rig.refusals import refuse_beyond_limits, refuse_endless
from rig.runfile.run import Run
from rig.session import Ended, Session

STRANGE = 0.5  # of the RMS of the error: feeding such a series forward may well make it worse
HALVED = 5  # a speed is halved fewer times than that to find one that would do
DYNAMIC = 0.4  # of the error; with so much made by the gear's dynamics its series is not found in the rest
UNLIKE = 1.25  # times: by less the model is right enough, however narrow the intervals are
ORDERS = 15  # looked at for the one that is amplified most
SEED = 20011  # of the draws of the series: the same gear file gives the same prediction


@dataclass(frozen=True)
class Compared:
    """One speed: measured without and with, predicted without and with, and the run folders."""

    speed_rpm: float
    without: Followed
    with_it: Followed
    expected_without: Expected
    expected_with: Expected
    runs: tuple[str, str]

    @property
    def improvement(self) -> float:
        """RMS without over RMS with, measured."""
        return self.without.rms.value / self.with_it.rms.value

    @property
    def expected_improvement(self) -> float:
        """The same, predicted."""
        return self.expected_without.rms / self.expected_with.rms


def compensate(
    session: Session,
    gear: GearFile,
    speeds_rpm: Sequence[float],
    revolutions: int,
    say: Callable[[str], None],
    measured: Callable[[Compared], None],
) -> tuple[list[Compared], Alignment]:
    """Proof, then two runs a speed, slowest first; the encoder's zero is found from the first of them. `measured` is
    told of each speed at once: what follows may be halted.

    Raises NotReady when the series does not fit the rig, Ended when a run comes to no end, DataError.
    """
    refuse_first(session.bench, gear, speeds_rpm, revolutions)
    say("the motor is about to turn: sign-and-scale proof, one turn forth and back")
    say(f"sign and scale: {session.prove().sentence}")
    series, where, found = gear.kinematic_error.series, None, []
    for speed in sorted(speeds_rpm):
        plainly, fed_forward = motions(session.bench, gear, series, speed, revolutions)
        without, plain = _run(session, plainly, say)
        if where is None:
            where = _zero(plain, gear, speed)
            say(where.sentence)
            series = turned(series, where.shift)
            fed_forward = replace(fed_forward, a=series.a, b=series.b)
        with_it, fed = _run(session, fed_forward, say)
        before, after = expected(gear, speed, plain, np.random.default_rng(SEED))
        found.append(Compared(speed, plain, fed, before, after, (without, with_it)))
        measured(found[-1])
    assert where is not None
    return found, where


def motions(
    bench: Bench, gear: GearFile, series: FourierSeries, speed: float, revolutions: int
) -> tuple[Compensated, Compensated]:
    """The motion at `speed` rpm without and with `series` fed forward."""
    plain = Compensated(speed, revolutions, speed_filter=bench.file.loop.speed_filter)
    return plain, replace(plain, inertia=gear.parameters["J_m"].value, a=series.a, b=series.b)


def refuse_first(bench: Bench, gear: GearFile, speeds_rpm: Sequence[float], revolutions: int) -> None:
    """Raises NotReady or UsageError, before anything moves: another gear, a motion beyond the bench's limits, and a
    slowest speed at which the gear's own dynamics make so much of the error that its series is not found in it."""
    refuse_other_gear(bench, gear)
    for speed in sorted(speeds_rpm, reverse=True):
        for motion in motions(bench, gear, gear.kinematic_error.series, speed, revolutions):
            refuse_endless(bench, motion)
            refuse_beyond_limits(bench, motion, given="speed")
    slowest = min(speeds_rpm)
    if said := unlike_the_series(gear, slowest):
        raise UsageError(
            f"--speed {slowest:g}: {said}; the zero of the encoder is found at the slowest speed, from an error that "
            f"is the series: expected {_slower(gear, slowest)}"
        )


def _slower(gear: GearFile, speed_rpm: float) -> str:
    """What to ask for instead, in words: the nearest of some slower speeds at which the error is the series."""
    speeds = [speed_rpm / 2**k for k in range(1, HALVED)]
    found = next((slower for slower in speeds if not unlike_the_series(gear, slower)), None)
    if found is None:
        return f"a gear file of slow runs: down to {speeds[-1]:.3g} rpm no speed would do"
    return f"a slower one before it, as in --speed {found:.3g} {speed_rpm:g}"


def unlike_the_series(gear: GearFile, speed_rpm: float) -> str:
    """What the model says beside the series makes most of the error at that speed, in words; "" below DYNAMIC of it."""
    try:
        wave = at_speed(gear.gear(), speed_rpm * RPM)
    except NoSteadyState:  # without a loop it would stick; the rig has one
        return ""
    other = wave.kinematic_error - wave.pure
    share = float(np.std(other) / np.std(wave.kinematic_error))
    if share < DYNAMIC:
        return ""
    total, pure = (np.abs(wave.orders(x, ORDERS)) / ARCSEC for x in (wave.kinematic_error, wave.pure))
    n = int(np.argmax(np.abs(wave.orders(other, ORDERS)))) + 1
    at = natural_frequency(gear.gear()) / n / RPM
    return (
        f"by the gear file {100 * share:.0f} % of the error there is the gear's dynamics, not its kinematic error "
        f"(order {n} is {total[n - 1]:.3g} arcsec instead of {pure[n - 1]:.3g}, it meets the torsional resonance at "
        f"{at:.0f} rpm)"
    )


def _run(session: Session, procedure: Compensated, say: Callable[[str], None]) -> tuple[str, Followed]:
    fed = "with" if procedure.a else "without"
    lasts = procedure.envelope(session.bench.setting(lambda text: None)).duration
    say(
        f"{procedure.speed_rpm:g} rpm {fed} compensation: {procedure.revolutions} turns of the motor forth and back, "
        f"{lasts:.0f} s"
    )
    done = session.run(procedure)
    if done.ending.exit is not Exit.PASS:
        raise Ended(f"the run {fed} compensation came to no end: {done.ending.reason}", done.ending.exit)
    return done.folder.name, followed(Run.open(done.folder))


def _zero(plain: Followed, gear: GearFile, speed: float) -> Alignment:
    """Raises NotReady when the rig shows another error than the series."""
    series = gear.kinematic_error.series
    where = zero_of(plain, series)
    if where is None:
        raise NotReady("the rig shows no kinematic error above its noise: there is nothing to compensate")
    rest = plain.error.mean(0) - plain.tracking.mean(0) + turned(series, where.shift).value(_grid(plain))
    left = float(np.std(rest) / np.std(plain.error.mean(0) - plain.tracking.mean(0)))
    if left > STRANGE:
        raise NotReady(
            f"the series given leaves {100 * left:.0f} % of the kinematic error this rig shows at {speed:g} rpm, "
            f"wherever the encoder's zero is put; expected below {100 * STRANGE:.0f} %: it is another gear's, or "
            "another assembly's, or the gear's dynamics at this speed are not those of the gear file"
        )
    return where


def _grid(plain: Followed) -> Array:
    bins = plain.error.shape[1]
    return np.asarray((np.arange(bins) + 0.5) / bins * 2 * np.pi)


def sentence(c: Compared) -> str:
    """One speed in a sentence."""
    b, a, eb, ea = c.without, c.with_it, c.expected_without, c.expected_with
    return (
        f"at {c.speed_rpm:g} rpm the load left its reference by {b.rms.value:.2f} arcsec RMS ({b.rms.low:.2f} to "
        f"{b.rms.high:.2f}), {b.peak_to_peak.value:.1f} peak to peak without compensation, and by {a.rms.value:.2f} "
        f"({a.rms.low:.2f} to {a.rms.high:.2f}), {a.peak_to_peak.value:.1f} with it: {c.improvement:.1f} times less; "
        f"the model said {_said(eb)} and {_said(ea)} arcsec, {c.expected_improvement:.1f} times less"
        + "".join(f"; {said}" for said in unlike_the_model(c))
    )


def unlike_the_model(c: Compared) -> list[str]:
    """Where what was measured is not what the model said: neither interval reaches the other, by UNLIKE at least."""
    pairs = (("without", c.without.rms, c.expected_without), ("with", c.with_it.rms, c.expected_with))
    return [
        f"{which} compensation the error is {_times(m.value / e.rms)} what the model said, beyond both intervals: at "
        "this speed the motor's loop leaves another error than was taken, or the gear is not as the gear file has it"
        for which, m, e in pairs
        if (m.low > e.rms_ci95[1] or m.high < e.rms_ci95[0]) and abs(np.log(m.value / e.rms)) > np.log(UNLIKE)
    ]


def _times(ratio: float) -> str:
    return f"{ratio:.2g} times" if ratio >= 1 else f"1/{1 / ratio:.2g} of"


def _said(e: Expected) -> str:
    return f"{e.rms:.2f} ({e.rms_ci95[0]:.2f} to {e.rms_ci95[1]:.2f})"
