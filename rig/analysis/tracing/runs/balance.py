"""A torque that the other torque and the weight rule out, be there repeats or not: a gear takes power and gives none.

Per radian of the motor, what the motor and the weight put in and did not go into speed is friction. A run in which it
is far below zero, where others agree that it is above, reads one of them with the other sign; one in which it is far
above, in another unit. A spring that is wound up pulls back, the more the further.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording, mean_way
from rig.core.rows import Array

UNIT: Final = 20.0  # times what others show: loads treble friction, and the next unit is 100 or 1000
MOST: Final = 0.8  # of the other runs: the sign they agree in is right
BELOW: Final = 0.3  # of the usual friction, below zero: further than offsets and late readings bring it
SPENT: Final = 0.3  # of the work, the most that may come from slowing down: inertias are only believed
MORE: Final = 5.0  # times N·τ_m and the weight: more than that no shaft carries in the mean
STEADY: Final = 0.8  # correlation with the wind-up: less is no winding up
FOLLOWS: Final = 0.5  # correlation of both torques in a lock test; friction is in one of them
FEWEST: Final = 2  # other runs
WEIGHT: Final = 1.0  # N·m, of a weight that counts
SHARE: Final = 0.3  # of the weight, the other way round
EVEN: Final = 0.3  # mean direction: a triangle that was cut short has a fifth
NEAR: Final = 2.0  # times: so near are runs that agree


def odd_balances(runs: Sequence[Recording]) -> dict[str, str]:
    """What is wrong with a torque of a run, by its name; nothing where nothing tells."""
    free = [r for r in runs if not r.locked and r.procedure != "standstill"]
    locked = [r for r in runs if r.locked]
    wound = {**_wound(locked, "tau_l", "τ_l"), **_wound(locked, "tau_m", "τ_m")}
    return {**_alone(locked), **wound, **_shaft(free), **_rubbed(free), **_hung(free), **_friction(free)}


def _friction(runs: Sequence[Recording]) -> dict[str, str]:
    """Runs whose motor takes power from its friction, or gives it far more than the others do."""
    known = [(run, taken) for run in runs if "tau_m" in run.has and (taken := _taken(run)) is not None]
    wrong: dict[str, str] = {}
    for run, taken in known:
        others = np.array([other for one, other in known if one is not run])
        usual = float(np.median(others)) if others.size >= FEWEST else 0.0
        if usual <= 0.0 or float(np.mean(others > 0.0)) < MOST:
            continue
        said = f"what its τ_m puts into friction is {taken:.3g} N·m, that of other runs {usual:.3g} N·m"
        if taken < -BELOW * usual:
            sign = f"{said}: it has the other sign than theirs, or what hangs on the output has"
            wrong[run.name] = _weight_in_another_unit(run) or sign
        elif taken > UNIT * usual:
            wrong[run.name] = _weight_in_another_unit(run) or f"{said}, as if in another unit"
    return wrong


def _weight_in_another_unit(run: Recording) -> str:
    """What is said of a weight that is many times what the shaft torque shows, or a small part of it; "" of others."""
    if not run.load_stated or "tau_l" not in run.has:
        return ""
    weight = float(run.pieces[0].tau_ext[0])
    shown = -float(np.nanmean(np.concatenate([piece.tau_l for piece in run.pieces])))
    if abs(weight) < WEIGHT or abs(shown) < WEIGHT or 1 / UNIT < abs(weight / shown) < UNIT:
        return ""
    return (
        f"its manifest says that {weight:.3g} N·m hang on the output, its τ_l shows {shown:.3g} N·m: one of them is in "
        "another unit"
    )


def _taken(run: Recording) -> float | None:
    """Friction at the motor, N·m: work of motor and weight less what went into speed, over the way of the motor; None
    where the weight is not known, or much of it came from slowing down."""
    if not run.load_stated and "tau_l" not in run.has:
        return None
    way = work = stored = 0.0
    for p in run.pieces:
        pulled = p.tau_ext if run.load_stated else -p.tau_l
        work += float(np.nansum(p.tau_m * p.omega_m + pulled * p.omega_l)) * p.dt
        way += float(np.nansum(np.abs(p.omega_m))) * p.dt
        stored += _kinetic(p.omega_m, p.omega_l, p.gear.J_m, p.gear.J_l)
    return (work - stored) / way if way > 0.0 and abs(stored) <= SPENT * abs(work) else None


def _kinetic(omega_m: Array, omega_l: Array, J_m: float, J_l: float) -> float:
    """What the energy of both inertias grew by, J."""
    energy = 0.5 * J_m * omega_m[[0, -1]] ** 2 + 0.5 * J_l * omega_l[[0, -1]] ** 2
    return float(energy[1] - energy[0])


def _hung(runs: Sequence[Recording]) -> dict[str, str]:
    """Runs forth and back whose shaft torque says that the weight pulls the other way."""
    wrong: dict[str, str] = {}
    for run in (r for r in runs if "tau_l" in r.has and r.load_stated and _heading(r) == 0):
        weight = float(run.pieces[0].tau_ext[0])
        mean = float(np.nanmean(np.concatenate([piece.tau_l for piece in run.pieces])))
        if abs(weight) >= WEIGHT and mean / -weight < -SHARE:
            wrong[run.name] = (
                f"its τ_l is {mean:.3g} N·m in the mean, expected {-weight:.3g} N·m against the declared weight: one "
                "of them has the other sign"
            )
    return wrong if 2 * len(wrong) < sum(abs(float(r.pieces[0].tau_ext[0])) >= WEIGHT for r in runs) else {}


def _rubbed(runs: Sequence[Recording]) -> dict[str, str]:
    """Runs whose load drives the gear by what it rubs, where all others that go the same way agree that it brakes."""
    wrong: dict[str, str] = {}
    mine = {r.name: (_heading(r), _load_taken(r)) for r in runs if "tau_l" in r.has and r.load_stated}
    for name, (heading, taken) in mine.items():
        others = [one for other, (way, one) in mine.items() if other != name and way == heading]
        usual = float(np.median(others)) if len(others) >= FEWEST else 0.0
        agree = usual > 0.0 and min(others) > usual / NEAR and max(others) < usual * NEAR
        if agree and usual / NEAR < -taken < usual * NEAR:
            wrong[name] = (
                f"its τ_l says that the load rubs with {taken:.3g} N·m, other runs that go this way say "
                f"{usual:.3g} N·m: it has the other sign"
            )
    return wrong


def _load_taken(run: Recording) -> float:
    """Friction of the load, N·m, and the sensor's zero where it turns one way."""
    x = np.concatenate([piece.tau_l + piece.tau_ext for piece in run.pieces])
    return float(np.nanmean(x * np.concatenate([piece.way for piece in run.pieces])))


def _heading(run: Recording) -> int:
    """1 or −1 of a run that turns mostly one way, else 0."""
    way = mean_way(run)
    return 0 if abs(way) < EVEN else int(np.sign(way))


def _alone(runs: Sequence[Recording]) -> dict[str, str]:
    """The only lock test, where its two torques contradict each other."""
    if len(runs) != 1 or not {"tau_m", "tau_l"} <= runs[0].has:
        return {}
    run = runs[0]
    x, y = (np.concatenate([getattr(p, name) for p in run.pieces]) for name in ("tau_m", "tau_l"))
    x, y = run.ratio * (x - x.mean()), y - y.mean()
    if abs(float(x @ y)) < FOLLOWS * float(np.sqrt((x @ x) * (y @ y))):
        return {}
    share = float(x @ y) / float(x @ x)
    if 1 / UNIT < share < MORE:
        return {}
    return {
        run.name: f"its τ_l goes {share:.3g} of N·τ_m, expected {1 / UNIT:g} to {MORE:g}: one of them is in another "
        "unit or has the other sign"
    }


def _shaft(runs: Sequence[Recording]) -> dict[str, str]:
    """Runs whose shaft carries in the mean far more than motor and weight can."""
    read = {run.name: _mean(run, "tau_l") for run in runs if "tau_l" in run.has}
    wrong: dict[str, str] = {}
    for run in (r for r in runs if {"tau_l", "tau_m"} <= r.has):
        others = [size for name, size in read.items() if name != run.name]
        usual = float(np.median(others)) if len(others) >= FEWEST else np.inf
        weight = float(np.max(np.abs(run.pieces[0].tau_ext)))
        can = run.ratio * _mean(run, "tau_m") + weight
        if read[run.name] > max(UNIT * (usual if run.load_stated else np.inf), MORE * can):
            wrong[run.name] = (
                f"its τ_l is {read[run.name]:.3g} N·m in the mean, N·τ_m and the weight come to {can:.3g} N·m, and "
                f"other runs have {usual:.3g} N·m: as if in another unit"
            )
    return wrong


def _mean(run: Recording, channel: str) -> float:
    """Size of a torque without what swings: of its mean, or of its mean along the way of the motor, N·m."""
    x = np.concatenate([getattr(piece, channel) for piece in run.pieces])
    way = np.concatenate([piece.way for piece in run.pieces])
    return max(abs(float(np.nanmean(x))), abs(float(np.nanmean(x * way))))


def _wound(runs: Sequence[Recording], channel: str, words: str) -> dict[str, str]:
    """Lock tests whose torque falls as the gear is wound up, or rises so much faster than that of the others."""
    known = {run.name: slope for run in runs if channel in run.has and (slope := _slope(run, channel)) is not None}
    wrong: dict[str, str] = {}
    for name, slope in known.items():
        others = np.array([other for one, other in known.items() if one != name])
        if not others.size or float(np.mean(others > 0.0)) < MOST:
            continue
        usual = float(np.median(others))
        said = f"its {words} grows by {slope:.3g} N·m/rad of the motor, that of other lock tests by {usual:.3g} N·m/rad"
        if slope < 0.0:
            wrong[name] = f"{said}: it has the other sign"
        elif others.size >= FEWEST and (slope > UNIT * np.max(others) or slope < np.min(others) / UNIT):
            wrong[name] = f"{said}, as if in another unit"
    return wrong


def _slope(run: Recording, channel: str) -> float | None:
    """N·m of `channel` per rad of the motor; None where the one does not follow the other."""
    x = np.concatenate([getattr(piece, channel) for piece in run.pieces])
    theta = np.concatenate([piece.theta_m for piece in run.pieces])
    x, theta = x - x.mean(), theta - theta.mean()
    spread = float(np.sqrt((x @ x) * (theta @ theta)))
    if not spread > 0.0 or abs(float(x @ theta)) < STEADY * spread:
        return None
    return float(x @ theta) / float(theta @ theta)
