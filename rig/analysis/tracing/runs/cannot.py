"""What a campaign cannot tell: sensors that were not there, ways and speeds and loads it did not go."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.answered import EVEN as STEADY
from rig.analysis.tracing.runs.answered import KEPT, lowest_answered, slow_enough
from rig.analysis.tracing.runs.holdout import grouped
from rig.analysis.tracing.runs.recording import Recording, read_by_any
from rig.analysis.tracing.thresholds import BANDWIDTH
from rig.core.units import RPM, TURN

ONE_SPEED: Final = 1.5  # fastest over slowest: drag and Coulomb friction then differ by less than their own intervals
EVEN: Final = 2.0  # of the slower quarter's speed, the faster one's: a sine has 2.4
ONE_LOAD: Final = 2.0  # N·m between the least and the largest torque: less than soft wind-up and meshing need to show
ONE_WAY: Final = 0.02  # of the travel: less of it the other way round is a start or a stop, not a direction

ROWS: Final = 3.0  # a period, at least
PASSED: Final = 2.1  # standard deviations of the low-pass: there a tenth is left
ANY: Final = 1000  # order
ANGLES: Final = {"theta_m", "theta_l"}

SENSORS: Final = {
    "t": "No run has a time column: rows have no known distance, so that inertias, damping and every effect of speed, "
    "time or frequency were left out; kinematic error, stiffness and friction were read against angle and torque.",
    "theta_m": "No motor angle: it was taken from the load angle and the model, so that the kinematic error was never "
    "read, only inferred from the torque it makes; errors of the motor encoder cannot be seen.",
    "theta_l": "No load angle: it was taken from the motor angle and the model, a locked output as at rest, so that "
    "the kinematic error was never read, only inferred from the torque it makes at speed; errors of the load encoder, "
    "late readings of it and what the output does once per turn cannot be seen.",
    "tau_m": "No motor torque: friction, cogging and torque ripple of the motor side cannot be seen.",
}


WOUND: Final = (
    " In lock tests it is what the spring makes of the wind-up, which the motor has to hold: how steeply, and with "
    "what friction, is each test's own."
)


def cannot(runs: Sequence[Recording]) -> tuple[str, ...]:
    """One sentence each, from all runs of a campaign."""
    has = read_by_any(runs)
    found = [sentence for channel, sentence in SENSORS.items() if channel not in has]
    moving = [run for run in runs if run.procedure != "standstill"]
    found += _answered(moving)
    found += _no_torque(has, moving) + _unvaried(has, moving)
    found += _held_output(moving) + _held_motor(moving)
    found += _gain(moving)
    found += _late_motor(moving)
    found += _fast(moving)
    return tuple(found)


def see_little(runs: Sequence[Recording]) -> bool:
    """Whether a campaign lacks a sensor, or what it takes for most effects to show: that nothing is found in it is no
    word on what it could not show."""
    has = read_by_any(runs)
    return bool({*SENSORS, "tau_l"} - has or _unvaried(has, [run for run in runs if run.procedure != "standstill"]))


def _unvaried(has: frozenset[str], moving: Sequence[Recording]) -> list[str]:
    """What was never repeated, or was one and the same in all runs."""
    return _alone(moving) + _one_way(moving) + _one_speed(has, moving) + _one_load(moving)


def _answered(runs: Sequence[Recording]) -> list[str]:
    spent = [run for run in runs if np.isfinite(lowest_answered(run))]
    if not spent:
        return []
    side = "load" if "theta_m" in spent[0].has else "motor"
    swings = not all(run.keeps_speed(STEADY) for run in spent)
    left_out = f", rows left out where order {KEPT} is so in runs whose speed changes all along" if swings else ""
    return [
        f"Nobody read how the {side} moves, and it answers by its resonance what comes faster than "
        f"{slow_enough(spent[0]) / TURN:.2g} times a second: what orders of the motor's torque that fast are made by "
        f"cannot be told, and they are each run's own{left_out}. Slower runs, under load, tell it."
    ]


def _no_torque(has: frozenset[str], runs: Sequence[Recording]) -> list[str]:
    if "tau_l" in has or not runs:
        return []
    rubs = "is told by the angle it winds the spring up by" if has >= ANGLES else "counts as the motor's"
    return [
        f"No shaft torque: it was taken from {_loaded_by(runs[0])}; friction of the load {rubs}, "
        "a torque sensor's own errors cannot be seen, and where the motor turns back nothing is compared."
        + (WOUND if any(run.is_wound for run in runs) else "")
    ]


def _loaded_by(run: Recording) -> str:
    if run.look.inertia:
        return (
            "the weight as declared or found and an inertia of the load that nobody declared: what both do to the "
            "angles and to the motor's torque tells it and the stiffness, as well as they are told apart"
        )
    return (
        f"a load inertia of {run.pieces[0].gear.J_l:.3g} kg·m² and the weight as declared or found. Stiffness "
        "and the motor's torque balance are in proportion to them"
    )


def _alone(runs: Sequence[Recording]) -> list[str]:
    if len(runs) == 1:
        return ["One run only: what was held out is of the same run, so that nothing is known of what differs between "
                "runs, conditions or days."]  # fmt: skip
    if all(len(group) == 1 for group in grouped(runs, range(len(runs)))):
        return ["No condition was repeated: the floor is what is seen within single runs, and "
                "what changes from run to run looks like an effect."]  # fmt: skip
    return []


def one_way(runs: Sequence[Recording]) -> bool:
    """Whether the motor turned one way only in all of them."""
    forward = sum(float(np.clip(np.diff(p.theta_m), 0, None).sum()) for run in runs for p in run.pieces)
    backward = sum(float(np.clip(np.diff(p.theta_m), None, 0).sum()) for run in runs for p in run.pieces)
    return min(forward, -backward) < ONE_WAY * max(forward, -backward)


def _one_way(runs: Sequence[Recording]) -> list[str]:
    if not runs or not one_way(runs):
        return []
    return ["The motor turned one way only: constant friction and the zero of a torque cannot be told apart, and lost "
            "motion, hysteresis and presliding have nothing to show in."]  # fmt: skip


def one_speed(runs: Sequence[Recording]) -> bool:
    """Whether all runs that turn do so at about one speed, each from begin to end."""
    free = [run for run in runs if not run.locked]
    speeds = [run.turning for run in free]
    return bool(speeds) and max(speeds) < ONE_SPEED * min(speeds) and all(run.keeps_speed(EVEN) for run in free)


def highest_order(runs: Sequence[Recording]) -> int:
    """Of the motor, that the run which turns most slowly can show: a third of its row rate, and what the low-pass
    leaves a tenth of; where no run turns freely any order."""
    free = [run for run in runs if not run.locked and run.procedure != "standstill" and run.turning > 0]
    turns = [min(run.rate / ROWS, PASSED * run.smoother.sigma_hz) * 2 * np.pi / run.turning for run in free]
    return int(max(turns, default=ANY))


def _one_speed(has: frozenset[str], runs: Sequence[Recording]) -> list[str]:
    if "t" not in has or not one_speed(runs):
        return []
    speeds = [run.turning / RPM for run in runs if not run.locked]
    least, most = f"{min(speeds):.3g}", f"{max(speeds):.3g}"
    about = least if least == most else f"{least} to {most}"
    return [f"All runs turn at about {about} rpm: constant friction, damping, falling friction and drag "
            "cannot be told apart, nor a real kinematic error from an encoder's."]  # fmt: skip


def _gain(runs: Sequence[Recording]) -> list[str]:
    if not any(run.look.gain for run in runs):
        return []
    return ["Motor torque and shaft torque differ by a gain, which was fitted beside the baseline: which of the two "
            "reads wrongly these runs do not tell; a weight on a known lever does."]  # fmt: skip


def _late_motor(runs: Sequence[Recording]) -> list[str]:
    if not any(run.look.late_motor for run in runs):
        return []
    return ["The motor torque is read a fraction of a millisecond before it acts, or after, which was fitted beside "
            "the baseline: a drive tells the torque that it sets before its current follows, or an average after the "
            "cycle, and that is no missing effect."]  # fmt: skip


def _fast(runs: Sequence[Recording]) -> list[str]:
    if not any(run.look.fast for run in runs):
        return []
    most = max(run.smoother.sigma_hz for run in runs)
    return [f"A mode was looked for at fast rows: angles and shaft torque of runs that have them were compared up to "
            f"{most:.0f} Hz, {BANDWIDTH:g} Hz at first. The balance of the load is noisier there, and small friction "
            "of it is not looked for as closely."]  # fmt: skip


def _held_output(runs: Sequence[Recording]) -> list[str]:
    if not any(run.look.held_load for run in runs):
        return []
    return ["In lock tests the load angle follows the torque, and was compared by itself there. A housing that moves "
            "under the encoder and a lock that gives way look the same in it: a dial gauge on each tells them apart, "
            "and the spring is read from the runs that turn."]  # fmt: skip


def _held_motor(runs: Sequence[Recording]) -> list[str]:
    held = [run for run in runs if run.input_locked]
    if not held:
        return []
    return [f"{_these(held)}: the motor stood while the output was wound up. What such runs tell is the spring at the "
            "angle they stand at, with the zero of each run its own; kinematic error, frictions and inertias do not "
            "show in them."]  # fmt: skip


def _these(runs: Sequence[Recording]) -> str:
    return runs[0].name if len(runs) == 1 else f"{len(runs)} runs, {runs[0].name} and others"


def _one_load(runs: Sequence[Recording]) -> list[str]:
    torques = [p.torque[np.isfinite(p.torque)] for run in runs for p in run.pieces]
    torques = [t for t in torques if t.size]
    if not torques or not runs:
        return []
    low, high = (float(np.percentile(np.concatenate(torques), q)) for q in (1, 99))
    if high - low > ONE_LOAD:
        return []
    spans = f"The torque through the gear spans {high - low:.2g} N·m"
    return [f"{spans}: stiffness, its loops and gaps, and what a load does to "
            "friction and kinematic error are as good as unseen."]  # fmt: skip


def together(runs: Sequence[Recording]) -> tuple[tuple[str, ...], ...]:
    """Baseline parameters that stand before the same column, or nearly.

    B_m and B_ml, and B_l with B_ml, stand before the same speed in equations 6 and 7 whatever is run; the load's
    friction counts as the motor's where nothing is measured between them: neither a torque nor the angle it winds the
    spring up by.
    """
    moving = [run for run in runs if run.procedure != "standstill"]
    found: list[tuple[str, ...]] = [("B_m", "B_ml"), ("B_l", "B_ml")]
    has = read_by_any(runs)
    if "tau_l" not in has:
        found += [("B_m", "B_l")] + ([] if has >= ANGLES else [("tau_c", "tau_cl")])
    if moving and one_way(moving):
        found += [("tau_c", "tau_0"), ("tau_cl", "tau_l0")]
    if moving and one_speed(moving):
        found += [("tau_c", "B_m"), ("tau_cl", "B_l")]
    return tuple(found)
