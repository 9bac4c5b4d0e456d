"""The identified gear against its own runs: θ̃ at speed as recorded, and as equations 6-7 make it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.identify.recording import Plateau, Recording, plateaus
from rig.analysis.identify.slow import SLOW
from rig.analysis.kinematic_error.profile import combine
from rig.analysis.motion.strokes import Stroke
from rig.analysis.orders.revolutions import analyse_stroke
from rig.core.units import ARCSEC, RPM, TURN
from rig.model.gear import Gear
from rig.model.gearfile import GearFile
from rig.model.simulate import NoSteadyState, Waveform, at_speed
from rig.model.simulate.spread import drawn_gears, half_widths

FEWEST = 6  # revolutions
GRID = 512  # points a turn
# RMS over half the interval of peak to peak: of gears as modelled 0.9, of one whose mesh was taken not to drag 2.4
MISSED = 2.5


@dataclass(frozen=True)
class Prediction:
    """One unloaded run at speed: peak to peak of its orders, arcsec; `rms` of measured less predicted profile."""

    run: str
    speed_rpm: float
    measured: float
    interval: tuple[float, float]
    predicted: float  # NaN where the gear does not turn steadily
    half: float  # of its 95 % interval, from what is not known of the gear; NaN where nothing was measured of it
    pure: float  # peak to peak of θ̃_p: what speed adds is the rest
    rms: float

    @property
    def missed(self) -> float:
        """`rms` over half the interval; 0 where nothing was predicted."""
        half = 0.5 * (self.interval[1] - self.interval[0])
        return self.rms / half if half > 0 and np.isfinite(self.rms) else 0.0


def misfit(made: Sequence[Prediction]) -> str:
    """What it says of the numbers that θ̃ at speed is not what they make it; "" where it is."""
    off = [p for p in made if p.missed > MISSED]
    if not off:
        return ""
    worst = max(off, key=lambda p: p.missed)
    return (
        f"θ̃ at speed is not what these numbers make it in {len(off)} of {len(made)} runs: between measured and "
        f"predicted lie {worst.rms:.1f} arcsec RMS in {worst.run} at {worst.speed_rpm:+.0f} rpm, {worst.missed:.1f} "
        "times half the interval of what was measured. Something acts that the model lacks, and numbers that go by the "
        "error at speed (J_m, J_l, K, B_sp, θ̃_p) may be off by far more than their intervals; hdrig trace looks for it."
    )


def predictions(runs: Sequence[Recording], file: GearFile, terms: int) -> list[Prediction]:
    """One for every unloaded run at speed under no loop, slowest first."""
    gear, may_be = file.gear(), drawn_gears(file)
    made = [p for r in runs if not r.locked and r.tau_ext == 0.0 and (p := _of(r, gear, may_be, terms)) is not None]
    return sorted(made, key=lambda p: abs(p.speed_rpm))


def _of(run: Recording, gear: Gear, may_be: list[Gear], terms: int) -> Prediction | None:
    # a loop that holds the speed bends the waveform: only what runs free is what the equations say
    level = [p for p in plateaus(run) if abs(p.omega) / RPM > SLOW and not p.followed]
    if not level:
        return None
    best = max(level, key=lambda p: p.duration)
    stroke = _stroke(best)
    if stroke.revolutions < FEWEST or int(np.min(np.diff(stroke.edges))) < 4 * terms:
        return None
    strokes, rpm = [analyse_stroke(run.motion, stroke, terms)], best.omega / RPM
    profile = combine(strokes, np.zeros(terms))
    value, interval = profile.peak_to_peak()
    try:
        wave = at_speed(gear, rpm * RPM)
    except NoSteadyState:
        return Prediction(run.name, rpm, value, interval, *[float("nan")] * 4)
    made = wave.orders(wave.kinematic_error, terms) / ARCSEC
    off = np.hypot(profile.cosine - made.real, profile.sine - made.imag)
    rms = float(np.sqrt(0.5 * np.sum(off**2)))
    half = half_widths(may_be, lambda drawn: np.array([_swing(at_speed(drawn, rpm * RPM), terms)]))
    pure = gear.kinematic_error.peak_to_peak() / ARCSEC
    return Prediction(
        run.name, rpm, value, interval, _swing(wave, terms), float(half[0]) if half.size else np.nan, pure, rms
    )


def _stroke(plateau: Plateau) -> Stroke:
    """The plateau cut at whole turns."""
    theta = plateau.run.theta_m[plateau.lo : plateau.hi + 1]
    progress = np.maximum.accumulate(plateau.way * (theta - theta[0]))
    turns = round(float(progress[-1]) / TURN)
    edges = plateau.lo + np.searchsorted(progress, TURN * np.arange(turns + 1))
    return Stroke(int(plateau.way), plateau.lo, plateau.hi, np.minimum(edges, plateau.hi).astype(np.int64))


def _swing(wave: Waveform, terms: int) -> float:
    """Peak to peak of the first `terms` orders of θ̃, arcsec: what the fitted profile holds of it."""
    c = np.zeros(GRID // 2 + 1, dtype=np.complex128)
    c[1 : terms + 1] = np.conj(wave.orders(wave.kinematic_error, terms))
    return float(np.ptp(np.fft.irfft(c, GRID) * (GRID / 2))) / ARCSEC
