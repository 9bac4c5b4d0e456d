"""Numbers that cannot be a gear's: a unit read wrongly, an angle the wrong way round, a ratio that is another gear's.

The bands are wide; what is outside is nearly always a factor of 1000, 180/π or 4, or a sign. Each check has a name,
under which [accept] in the mapping may waive it with a reason.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rig.core.errors import UsageError
from rig.core.plausible import PERIOD, TORQUE
from rig.runfile.importing.convert import Converted
from rig.runfile.importing.mapping import Mapping
from rig.runfile.importing.timing import EPOCH_END

Array = npt.NDArray[Any]

SPAN = 3.2e7  # s: a year; one wrong stamp at the end of a run is not a gap
ANGLE = 1e9  # rad: beyond it a float64 no longer holds a fiftieth of an arcsec
SPEED = 20_000.0  # rpm: above the input speed of any strain-wave gear on sale (14 000 rpm, size 5)
OTHER = 2.0  # times: a speed that was stated is another one when nearly all rows turn so much faster or slower
WINDOW = 50  # rows over which a speed is taken: stamps jitter, so two neighbours say little
BALANCE = 100.0  # tau_l over N·tau_m, both rms, of a turning gear: a lossless one has 1
STIFFNESS = (50.0, 5e6)  # N·m/rad: half the softest (size 5) to several times the stiffest (size 100)
CLEAR = 0.9  # correlation of torque and wind-up from which their slope is a stiffness
LEAST, USUAL, ALONE = 20, 95.0, 100.0  # rows; per cent of the steps; times those: what nobody turns there and back
RATE = 0.1  # share by which a speed channel may differ from what its angle does: filters and lags of a drive
RATIO = 0.003  # share by which the measured ratio may differ once the angles span much
WIND_UP = np.radians(0.3)  # rad of load angle that torsion and errors may add over the span: 18 arcmin were measured
HINTS = ((57.2958, "180/π: one angle is in deg, the other in rad"), (6.28319, "2π: one is in turns, the other in rad"),
         (360.0, "360: one is in deg, the other in turns"), (4.0, "4: counts of one are taken before quadrature"),
         (60.0, "60: one is in arcmin, the other in deg"), (1000.0, "1000: a prefix is missing"))  # fmt: skip

RATES = ((9.5493, "30/π: one is in rpm, the other in rad/s"), (57.2958, "180/π: one is in deg/s, the other in rad/s"),
         (6.0, "6: one is in rpm, the other in deg/s"), (6.28319, "2π: one is in turns/s, the other in rad/s"),
         (60.0, "60: one is a minute's, the other a second's"))  # fmt: skip


def check(run: Converted, mapping: Mapping, file: str) -> None:
    """Raises UsageError for the first thing that cannot be; adds to `run.notes` what was measured or waived."""
    checks = {  # the first to complain is heard: the ratio says more of what is wrong than a speed does
        "epoch": _epoch,
        "period": _period,
        "angle": _angle,
        "ratio": _ratio,
        "speed": _speed,
        "torque": _torque,
        "stiffness": _stiffness,
    }
    for name, one in checks.items():
        if complaint := one(run, mapping):
            if name not in mapping.accept:
                raise UsageError(f"{file}: {complaint}")
            run.notes.append(f"accepted ({mapping.accept[name]}): {complaint}")
    run.notes += _stated(run, mapping)


def _epoch(run: Converted, mapping: Mapping) -> str:
    first = run.time.get("first", 0.0)
    if first < EPOCH_END:
        return ""
    unit = mapping.channels["t"].unit
    return (
        f"time starts at {first:.6g} s, {first / 31_556_952:.4g} years after zero; expected less than {EPOCH_END:g} s: "
        f"channels.t.unit = '{unit}' is probably too large by 1000 or a million"
    )


def _period(run: Converted, mapping: Mapping) -> str:
    period = run.time.get("period_median")
    if run.time.get("span", 0.0) > SPAN:
        return f"t spans {run.time['span']:.4g} s; expected less than a year ({SPAN:g} s)"
    if period is None or PERIOD[0] < period < PERIOD[1]:
        return ""
    return (
        f"the median sample period is {period:.4g} s with channels.t.unit = '{mapping.channels['t'].unit}'; "
        f"expected {PERIOD[0]:g} to {PERIOD[1]:g} s (another unit of time?)"
    )


def _angle(run: Converted, mapping: Mapping) -> str:
    """An angle beyond reason, or one that stands where the experiment moves it: a dead encoder, or the wrong column."""
    locked = mapping.conditions.get("output_locked", False)
    for name in ("theta_m", "theta_l"):
        values = run.values(name)
        if values is not None and (peak := float(np.abs(values).max())) > ANGLE:
            return f"{name} reaches {peak:.4g} rad; expected below {ANGLE:g} rad (what wraps or overflows there?)"
        if values is None or np.ptp(values) > 0 or mapping.procedure == "standstill" or (locked and name == "theta_l"):
            continue
        mend = "conditions.output_locked = true" if name == "theta_l" else "procedure = 'standstill'"
        return (
            f"{name} stands at {values[0]:.6g} rad in all {len(values)} rows, though procedure = '{mapping.procedure}' "
            f"moves it; expected another column, or {mend}"
        )
    return ""


def _stated(run: Converted, mapping: Mapping) -> list[str]:
    """A motor speed that was stated and is none the run turns at for long: runs are grouped by it."""
    said, t = mapping.conditions.get("speed_rpm"), run.values("t")
    angles = ((run.values(name), gear) for name, gear in (("theta_m", 1.0), ("theta_l", mapping.gear["ratio"])))
    theta, gear = next(((theta, gear) for theta, gear in angles if theta is not None), (None, 1.0))
    if not said or t is None or theta is None:
        return []
    slow, usual, fast = np.quantile(_rpm(theta, t, min(WINDOW, len(t) - 1)) * gear, (0.05, 0.5, 0.95))
    if slow <= OTHER * abs(said) and fast >= abs(said) / OTHER:
        return []
    return [
        f"conditions.speed_rpm = {said:g} rpm was stated, and the motor turns at {usual:.4g} rpm in the median: is it "
        "the output's speed, or another run's?"
    ]


def _rpm(theta: Array, t: Array, window: int) -> Array:
    """How fast an angle turns over so many rows, either way."""
    return np.asarray(np.abs((theta[window:] - theta[:-window]) / (t[window:] - t[:-window])) * 60 / (2 * np.pi))


def _speed(run: Converted, mapping: Mapping) -> str:
    t = run.values("t")
    for name, gear in (("theta_m", 1.0), ("theta_l", mapping.gear["ratio"])):
        theta = run.values(name)
        if t is None or theta is None:
            continue
        window = min(WINDOW, len(t) - 1)
        rpm = _rpm(theta, t, window) * gear
        if rpm.max() > SPEED:
            row = int(np.argmax(rpm))
            return (
                f"{name} and t make a motor speed of {rpm.max():.4g} rpm over rows {row + 1} to {row + 1 + window}; "
                f"expected below {SPEED:g} rpm (a unit of angle or time, counts_per_turn, or a wrap)"
            )
    return _rate(run, mapping)


def _rate(run: Converted, mapping: Mapping) -> str:
    """omega_m against what theta_m does in time, by least squares: right unit, right sign, the right shaft."""
    t, theta, omega = (run.values(name) for name in ("t", "theta_m", "omega_m"))
    if t is None or theta is None or omega is None or np.ptp(theta) < 2 * np.pi:
        return ""
    window = min(WINDOW, len(t) - 1)
    seen = (theta[window:] - theta[:-window]) / (t[window:] - t[:-window])
    told = np.convolve(omega, np.full(window, 1 / window), "valid")[: len(seen)]
    known = np.isfinite(told)
    slope = float(told[known] @ seen[known] / max(seen[known] @ seen[known], 1e-300)) if known.any() else 1.0
    if abs(slope - 1) <= RATE:
        return ""
    said = f"omega_m is {slope:.4g} times what theta_m does in time; expected 1 ({_unit(mapping, 'omega_m')})"
    factor = max(abs(slope), 1 / max(abs(slope), 1e-300))
    known_factors = (*RATES, (mapping.gear["ratio"], "gear.ratio: it is the other shaft's"))
    nearest, word = min(known_factors, key=lambda one: abs(np.log(factor / one[0])))  # 6 and 2π are 5 % apart
    hint = f": about {word}" if abs(factor / nearest - 1) < RATE / 2 else ""
    sign = -mapping.channels["omega_m"].sign
    return said + hint + (f"; set channels.omega_m.sign = {sign}" if slope < 0 else "")


def _ratio(run: Converted, mapping: Mapping) -> str:
    """theta_m per theta_l, by least squares, against gear.ratio: right unit, right counts, right sign, right gear."""
    theta_m, theta_l = run.values("theta_m"), run.values("theta_l")
    if theta_m is None or theta_l is None or mapping.conditions.get("output_locked", False):
        return ""
    declared = mapping.gear["ratio"]
    span = max(float(np.ptp(theta_l)), float(np.ptp(theta_m)) / declared)
    if span <= WIND_UP:
        run.notes.append(f"gear.ratio was not checked: the load turns only {np.degrees(span):.3g} deg")
        return ""
    dl = theta_l - theta_l.mean()
    measured = float(dl @ (theta_m - theta_m.mean()) / (dl @ dl)) if np.ptp(theta_l) > 0 else 0.0
    said = f"theta_m turns {measured:.6g} times as far as theta_l (over {np.degrees(np.ptp(theta_l)):.4g} deg of load)"
    if abs(measured / declared - 1) <= RATIO + WIND_UP / span:
        run.notes.append(f"{said}; gear.ratio = {declared:g}")
        return ""
    if alone := _alone(run):
        return f"{said}; expected {declared:g} (gear.ratio): {alone}"
    factor = max(abs(measured) / declared, declared / max(abs(measured), 1e-300))
    fits = factor < 1 + RATIO + WIND_UP / span
    if measured < 0 and fits:
        sign = mapping.channels["theta_l"].sign
        said += f", so one angle runs the wrong way: set channels.theta_l.sign = {-sign} (it must follow the motor)"
    near = {abs(factor / f - 1): text for f, text in HINTS}
    hint = f"; they differ by about {near[min(near)]}" if min(near) < 0.05 else ""
    return said + ("" if measured < 0 and fits else f"; gear.ratio = {declared:g} does not fit") + hint


def _alone(run: Converted) -> str:
    """Which reading of an angle is far off those before and behind it, and makes a ratio of its own; "" without one."""
    for name in ("theta_m", "theta_l"):
        theta = run.values(name)
        step = np.diff(theta) if theta is not None else np.zeros(0)
        if step.size < LEAST:
            continue
        there_and_back = np.where(step[:-1] * step[1:] < 0, np.minimum(np.abs(step[:-1]), np.abs(step[1:])), 0.0)
        at = int(np.argmax(there_and_back))
        if there_and_back[at] > ALONE * float(np.percentile(np.abs(step), USUAL)):
            return f"row {at + 2} of {name} lies {step[at]:+.4g} rad off the row before it, and the next one is back"
    return ""


def _torque(run: Converted, mapping: Mapping) -> str:
    for name, limit in TORQUE.items():
        tau = run.values(name)
        if tau is not None and np.isfinite(tau).any() and (peak := float(np.nanmax(np.abs(tau)))) > limit:
            return f"{name} reaches {peak:.5g} N·m; expected below {limit:g} N·m ({_unit(mapping, name)})"
    m, tau_m, tau_l = run.values("theta_m"), run.values("tau_m"), run.values("tau_l")
    if m is None or tau_m is None or tau_l is None or np.ptp(m) < 2 * np.pi:
        return ""
    at_load, sensor = mapping.gear["ratio"] * _rms(tau_m), _rms(tau_l)
    if at_load > 0 and sensor > BALANCE * at_load:
        return (
            f"tau_l is {sensor:.4g} N·m rms, but gear.ratio·tau_m only {at_load:.4g} N·m; expected less than "
            f"{BALANCE:g} times as much ({_unit(mapping, 'tau_l')}, {_unit(mapping, 'tau_m')})"
        )
    return ""


def _stiffness(run: Converted, mapping: Mapping) -> str:
    """The slope of torque over wind-up where there clearly is one: its size tells the unit, its sign the sign."""
    theta_m, theta_l, tau = (run.values(name) for name in ("theta_m", "theta_l", "tau_l"))
    if theta_m is None or theta_l is None or tau is None:
        return ""
    known = np.isfinite(tau)
    wind_up, tau = (theta_m / mapping.gear["ratio"] - theta_l)[known], tau[known]
    if len(tau) < WINDOW or np.ptp(wind_up) < np.radians(1 / 60) or np.ptp(tau) == 0:
        return ""  # less than an arcmin is within the error of encoders
    r = float(np.corrcoef(wind_up, tau)[0, 1])
    if abs(r) < CLEAR:
        return ""
    slope = float(np.std(tau) / np.std(wind_up) / r)  # wind-up regressed on torque, the quieter of the two
    said = f"wind-up theta_m/{mapping.gear['ratio']:g} − theta_l against tau_l is a stiffness of {slope:.4g} N·m/rad"
    if r < 0:
        sign = -mapping.channels["tau_l"].sign
        return f"{said}; expected a positive one: set channels.tau_l.sign = {sign} (positive drives the load forward)"
    if STIFFNESS[0] < slope < STIFFNESS[1]:
        run.notes.append(said)
        return ""
    return f"{said}; expected {STIFFNESS[0]:g} to {STIFFNESS[1]:g} N·m/rad ({_unit(mapping, 'tau_l')})"


def _unit(mapping: Mapping, name: str) -> str:
    return f"channels.{name}.unit = '{mapping.channels[name].unit}'" if name in mapping.channels else f"unit of {name}"


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if known.size else 0.0
