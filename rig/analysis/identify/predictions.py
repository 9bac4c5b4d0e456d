"""The identified gear against its own runs: θ̃ at speed as recorded, and as equations 6-7 make it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.angle import ARCSEC, RPM
from rig.analysis.identify.recording import Recording
from rig.analysis.identify.slow import SLOW
from rig.analysis.kinematic_error import groups_by_speed
from rig.analysis.profile import combine
from rig.analysis.revolutions import analyse_stroke
from rig.analysis.strokes import find_strokes
from rig.model.gear import Gear
from rig.model.simulate import NoSteadyState, Waveform, at_speed

FEWEST = 6  # revolutions
GRID = 512  # points a turn


@dataclass(frozen=True)
class Prediction:
    """One unloaded run at speed: peak to peak of its orders, arcsec; `rms` of measured less predicted profile."""

    run: str
    speed_rpm: float
    measured: float
    interval: tuple[float, float]
    predicted: float  # NaN where the gear does not turn steadily
    pure: float  # peak to peak of θ̃_p: what speed adds is the rest
    rms: float


def predictions(runs: Sequence[Recording], gear: Gear, terms: int) -> list[Prediction]:
    """One for every unloaded run at speed, slowest first."""
    made = [p for r in runs if not r.locked and r.tau_ext == 0.0 and (p := _of(r, gear, terms)) is not None]
    return sorted(made, key=lambda p: abs(p.speed_rpm))


def _of(run: Recording, gear: Gear, terms: int) -> Prediction | None:
    groups = groups_by_speed(run.motion, find_strokes(run.motion))
    if not groups:
        return None
    main = max(groups, key=lambda g: sum(s.revolutions for s in g))
    if sum(s.revolutions for s in main) < FEWEST or min(int(np.min(np.diff(s.edges))) for s in main) < 4 * terms:
        return None
    strokes = [analyse_stroke(run.motion, s, terms) for s in main]
    speeds = np.concatenate([s.speed_rpm for s in strokes])
    rpm = float(np.mean(np.abs(speeds))) * float(np.sign(strokes[0].direction))
    if not abs(rpm) > SLOW or len({s.direction for s in strokes}) > 1:
        return None
    profile = combine(strokes, np.zeros(terms))
    value, interval = profile.peak_to_peak()
    try:
        wave = at_speed(gear, rpm / RPM)
    except NoSteadyState:
        return Prediction(run.name, rpm, value, interval, float("nan"), float("nan"), float("nan"))
    made = wave.orders(wave.kinematic_error, terms) * ARCSEC
    off = np.hypot(profile.cosine - made.real, profile.sine - made.imag)
    rms = float(np.sqrt(0.5 * np.sum(off**2)))
    return Prediction(
        run.name, rpm, value, interval, _swing(wave, terms), gear.kinematic_error.peak_to_peak() * ARCSEC, rms
    )


def _swing(wave: Waveform, terms: int) -> float:
    """Peak to peak of the first `terms` orders of θ̃, arcsec: what the fitted profile holds of it."""
    c = np.zeros(GRID // 2 + 1, dtype=np.complex128)
    c[1 : terms + 1] = np.conj(wave.orders(wave.kinematic_error, terms))
    return float(np.ptp(np.fft.irfft(c, GRID) * (GRID / 2))) * ARCSEC
