"""The same motion without and with the kinematic error fed forward, at every speed asked for, on one session."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.align import Alignment
from rig.analysis.compensation import Expected, Followed, expected, followed, turned, zero_of
from rig.analysis.result import Array
from rig.core.errors import Exit, NotReady
from rig.model.fourier import FourierSeries
from rig.model.gearfile import GearFile
from rig.procedures.compensated import Compensated
from rig.runfile.run import Run
from rig.session import Ended, Session

STRANGE = 0.5  # of the RMS of the error: feeding such a series forward may well make it worse
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
    session: Session, gear: GearFile, speeds_rpm: Sequence[float], revolutions: int, say: Callable[[str], None]
) -> tuple[list[Compared], Alignment]:
    """Proof, then two runs a speed, slowest first; the encoder's zero is found from the first of them.

    Raises NotReady when the series does not fit the rig, Ended when a run comes to no end, DataError.
    """
    say(f"sign and scale: {session.prove().sentence}")
    series, where, found = gear.kinematic_error.series, None, []
    filtered = session.bench.file.loop.speed_filter
    for speed in sorted(speeds_rpm):
        without, plain = _run(session, Compensated(speed, revolutions, speed_filter=filtered), say)
        if where is None:
            where = _zero(plain, series)
            say(where.sentence)
            series = turned(series, where.shift)
        fed_forward = replace(
            Compensated(speed, revolutions, inertia=gear.parameters["J_m"].value, speed_filter=filtered),
            a=series.a, b=series.b,
        )  # fmt: skip
        with_it, fed = _run(session, fed_forward, say)
        before, after = expected(gear, speed, plain, np.random.default_rng(SEED))
        found.append(Compared(speed, plain, fed, before, after, (without, with_it)))
        say(sentence(found[-1]))
    assert where is not None
    return found, where


def _run(session: Session, procedure: Compensated, say: Callable[[str], None]) -> tuple[str, Followed]:
    fed = "with" if procedure.a else "without"
    say(f"{procedure.speed_rpm:g} rpm {fed} compensation")
    done = session.run(procedure)
    if done.ending.exit is not Exit.PASS:
        raise Ended(f"the run {fed} compensation came to no end: {done.ending.reason}", done.ending.exit)
    return done.folder.name, followed(Run.open(done.folder))


def _zero(plain: Followed, series: FourierSeries) -> Alignment:
    """Raises NotReady when the rig shows another error than the series."""
    where = zero_of(plain, series)
    if where is None:
        raise NotReady("the rig shows no kinematic error above its noise: there is nothing to compensate")
    rest = plain.error.mean(0) - plain.tracking.mean(0) + turned(series, where.shift).value(_grid(plain))
    left = float(np.std(rest) / np.std(plain.error.mean(0) - plain.tracking.mean(0)))
    if left > STRANGE:
        raise NotReady(
            f"the series given leaves {100 * left:.0f} % of the kinematic error this rig shows, wherever the encoder's "
            f"zero is put; expected below {100 * STRANGE:.0f} %: it is another gear's, or another assembly's"
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
        f"the model said {eb.rms:.2f} and {ea.rms:.2f} arcsec, {c.expected_improvement:.1f} times less"
    )
