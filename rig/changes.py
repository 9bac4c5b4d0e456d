"""A change by hand is believed when the sensors show it: what is asked for, what may not be, what must be seen."""

from __future__ import annotations

import math
from collections.abc import Callable

from rig.core.errors import NotReady
from rig.core.operator import Change, HangWeight, LockOutput, Rigging
from rig.core.units import RPM
from rig.instruments import Instruments
from rig.procedures.lock_check import LockProof
from rig.procedures.weigh import Weighing
from rig.supervisor import UNCONFIRMED

WEIGHT_SHARE = 0.05  # of the weight: masses, pulley radius, gain of the sensor
WEIGHT_FLOOR = 0.15  # N·m: tells 0.5 N·m from nothing and from 1 N·m
ZERO_SHARE = 0.02  # of the sensor's limit: a sensor that was tared shows less with nothing on it
STICTION = 1.5  # friction at rest over friction turning, load side
LOCKED, FREE = 0.25, 0.5  # share of the motor's turn that the load follows: below it is held, above it is not
WOUND_UP = 0.5  # share of the asked angle the motor must have turned for the check to say anything
WINDOW = 0.2  # s
QUIET = 3  # windows in a row
STILL = 0.01  # rad/s of the motor: 3 counts of an encoder with 10 000 counts a turn, in a window
PATIENCE = 30.0  # s from torque off to rest
COASTS = 5.0  # s in which any motor that nothing drives has come to rest


def wait_for_rest(instruments: Instruments, meanwhile: Callable[[], None] = lambda: None) -> None:
    """Torque off, then let time pass until neither shaft moves; `meanwhile` is called as long, and may raise. Raises
    NotReady when the drive does not confirm that it is off, and after 30 s, with the speed."""
    if not instruments.safe():
        raise NotReady(f"{UNCONFIRMED}: press the hard-wired stop before anybody touches the rig")
    clock, quiet, speed = instruments.clock, 0, math.inf
    give_up = clock.now() + PATIENCE
    before = instruments.look()
    while quiet < QUIET:
        meanwhile()
        clock.wait_until(clock.now() + WINDOW)
        sample = instruments.look()
        passed = sample.t - before.t
        speed = (sample.theta_m - before.theta_m) / passed if passed > 0.0 else math.inf  # nothing new is no rest
        quiet = quiet + 1 if abs(speed) < STILL else 0
        before = sample
        if clock.now() > give_up and math.isinf(speed):
            raise NotReady(f"the drive tells no new motor angle for {WINDOW:g} s: whether it is at rest is not known")
        if clock.now() > give_up:
            raise NotReady(
                f"the motor still turns at {speed / RPM:.1f} rpm {PATIENCE:g} s after its torque went off: "
                "does the weight drive it? Hold the output and take the weight off"
            )


def refuse_turning(instruments: Instruments, refuse_ended: Callable[[], None]) -> None:
    """Before a drive is energised: a motor that turns without torque is given time to come to rest. Raises NotReady for
    one that does not, and what `refuse_ended` raises meanwhile. One that tells no new angle is the guard's to judge,
    before the first torque.
    """
    if speed := instruments.still_turning(COASTS, refuse_ended):
        raise NotReady(
            f"the motor turns at {speed / RPM:.0f} rpm though nothing is energised, and has not come to rest in "
            f"{COASTS:g} s: does a weight drive it? Hold the output and take the weight off"
        )


def refuse_unfit(change: Change, rigging: Rigging, shaft_limit: float | None) -> None:
    """Raises NotReady for a change that no run should follow, before anybody is asked for it.

    `shaft_limit` N·m at the torque sensor.
    """
    match change:
        case HangWeight(tau_ext) if tau_ext and rigging.output_locked:
            raise NotReady(f"{tau_ext:+g} N·m on a locked output loads the lock pin, not the gear: free it first")
        case HangWeight(tau_ext) if shaft_limit is not None and abs(tau_ext) > shaft_limit:
            raise NotReady(f"{tau_ext:+g} N·m is beyond the torque sensor's limit of ±{shaft_limit:g} N·m")
        case LockOutput() if rigging.tau_ext:
            raise NotReady(f"{rigging.tau_ext:+g} N·m hang on the output: take them off before it is locked")
        case _:
            return


def refuse_driving(tau_ext: float, ratio: float, drag: float) -> None:
    """Raises NotReady for a weight that would keep turning a motor whose torque was taken off while it turned.

    `drag` N·m at the motor is what friction takes from it while it turns slowly, unloaded; at rest it holds more.
    """
    if abs(tau_ext) >= drag * ratio:
        raise NotReady(
            f"{tau_ext:+g} N·m on the output are {abs(tau_ext) / ratio:.2f} N·m at the motor, and friction takes "
            f"{drag:.2f} N·m from it: halted while it turns it would not stop. Hang less than {drag * ratio:.1f} N·m"
        )


def band_at_rest(tau_ext: float, friction: float) -> float:
    """How far [N·m] the sensor at rest may be from −τ_ext: what friction may hold, and the weight's tolerance."""
    return STICTION * friction + tolerance(tau_ext)


def tolerance(tau_ext: float) -> float:
    """How far [N·m] a weight may be from what it is said to be."""
    return WEIGHT_SHARE * abs(tau_ext) + WEIGHT_FLOOR


def judge_tare(found: Weighing, shaft_limit: float) -> str:
    """What the unloaded sensor shows is its zero, if it is little. Raises NotReady."""
    most = ZERO_SHARE * shaft_limit
    if not abs(found.torque) <= most:
        raise NotReady(
            f"the torque sensor shows {found.torque:+.2f} N·m with nothing hung on the output, expected at most "
            f"±{most:.2f} N·m: tare it, or take off what hangs there"
        )
    return f"zero of the torque sensor {found.torque:+.3f} ± {2 * found.error:.3f} N·m ({found.sentence})"


def judge_weight(found: Weighing, tau_ext: float, zero: float) -> str:
    """The weight is the one that was asked for. Raises NotReady with what hangs there instead."""
    measured, allowed = zero - found.torque, tolerance(tau_ext) + 2 * found.error
    if abs(measured - tau_ext) <= allowed:
        hung = f"{_signed(measured, '.2f')} N·m on the output, {_signed(tau_ext, 'g')} N·m were asked for"
        return f"{hung} ({found.sentence})"
    what = f"expected {_signed(tau_ext, 'g')} N·m within {allowed:.2f} N·m"
    if tau_ext and abs(measured + tau_ext) <= allowed:
        raise NotReady(f"{_signed(measured, '.2f')} N·m hang on the output, {what}: the weight pulls the wrong way")
    if abs(measured) <= WEIGHT_FLOOR + 2 * found.error:
        raise NotReady(f"{_signed(measured, '.2f')} N·m hang on the output, {what}: the weight is not there")
    raise NotReady(f"{_signed(measured, '.2f')} N·m hang on the output, {what}: it is another weight")


def _signed(value: float, digits: str) -> str:
    """With its sign, and without one where it is shown as nothing."""
    shown = f"{value:+{digits}}"
    return shown if float(shown) else shown[1:]


def judge_free(found: LockProof) -> str:
    """The load follows the motor. Raises NotReady when it does not."""
    if not found.follows > FREE:
        raise NotReady(f"the output is not free: {found.sentence}, expected at least {100 * FREE:.0f} %")
    return f"the output is free: {found.sentence}"


def judge_lock(found: LockProof, angle: float) -> str:
    """The pin holds the output. Raises NotReady when the load followed, or the motor hardly turned.

    `angle` rad is what the motor was asked to turn.
    """
    if not abs(found.motor) >= WOUND_UP * abs(angle):
        raise NotReady(
            f"the lock pin could not be checked: {found.sentence}, {math.degrees(angle):.1f}° were asked for"
        )
    if found.follows > FREE:
        raise NotReady(
            f"the output is not locked: {found.sentence}, expected less than {100 * LOCKED:.0f} %: fit the lock pin"
        )
    if not abs(found.follows) < LOCKED:
        raise NotReady(f"the lock pin has play or gives way: {found.sentence}, expected less than {100 * LOCKED:.0f} %")
    return f"the output is locked: {found.sentence}"
