"""Winding up a locked gear: the position loop with a reference that creeps, and the shaft torque it is judged by."""

from __future__ import annotations

import math
from dataclasses import replace

from rig.control.pid import Pid
from rig.core.gains import Gains
from rig.core.procedure import Setting
from rig.core.sample import Sample, Torque

SMOOTHING = 0.02  # s, of the shaft torque: single readings of a noisy sensor must not end a ramp early
PER_TICK = 0.5  # rad: a torque comes 1.5 ticks late on the mean, 43° there, and no gains of ours have that to spare


def stiffer(gains: Gains, gain: float) -> Gains:
    """`gain` times the stiffness of the loop at the same damping; its integral may use the whole torque limit.

    With the output locked the plant is one inertia on a spring, without the load's resonance, so the loop may be
    stiffer than the gear turning freely allows. Stick-slip gets as much finer: a slip is about 2·(τ_s − τ_c)/(K_p +
    K/N²) long      [armstrong1994]
    """
    return replace(
        gains,
        Kp=gain * gains.Kp,
        Ki=gain * gains.Ki,
        Kd=math.sqrt(gain) * gains.Kd,
        integrator_limit=gains.torque_limit,  # it has to hold the wound-up spring besides friction
    )


def answers_at(setting: Setting, gain: float) -> float:
    """rad/s at which the motor swings on a loop stiffened by `gain`, and on the gear wound up behind it.

    ω = √((gain·K_p + K/N²)/J_m)
    """
    return math.sqrt((gain * setting.control.Kp + setting.stiffness / setting.ratio**2) / setting.drivetrain.J_m)


def stiffest(setting: Setting) -> float:
    """The gain with which the loop turns by PER_TICK rad a tick; inf where there is nothing to multiply."""
    omega, spring, Kp = PER_TICK / setting.period, setting.stiffness / setting.ratio**2, setting.control.Kp
    return (omega**2 * setting.drivetrain.J_m - spring) / Kp if Kp else math.inf


class Winding:
    """Takes hold of the motor where it is, with the torque it has: no jump, whatever is wound up already."""

    __slots__ = ("_keep", "_period", "_pid", "theta_ref", "torque")

    def __init__(self, setting: Setting, gain: float, sample: Sample) -> None:
        self._pid = Pid(stiffer(setting.control, gain), setting.period)
        self._pid.take_over(sample.tau_m, 0.0)
        self._period = setting.period
        self._keep = SMOOTHING / (SMOOTHING + setting.period)
        self.theta_ref = sample.theta_m  # rad
        self.torque = sample.tau_l  # N·m, smoothed

    def step(self, sample: Sample, omega: float) -> Torque:
        """The torque for this tick; the reference moves on at `omega` rad/s of the motor."""
        self.torque = sample.tau_l + (self.torque - sample.tau_l) * self._keep
        self.theta_ref += omega * self._period
        tau = self._pid.step(self.theta_ref, omega, sample.theta_m, sample.omega_m)
        return Torque(tau, self.theta_ref, omega)

    def stay(self, sample: Sample) -> None:
        """From here the reference is where the motor is: what it lagged behind is not made up for."""
        self.theta_ref = sample.theta_m
