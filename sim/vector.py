"""The numbers of the bench file as the kernel wants them: one vector."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from rig.model.gear import Gear
from rig.model.linear import damping_ratio, natural_frequency
from sim import kernel
from sim.effects import Effects, Friction, Hysteresis, Stiffness, lines
from sim.parameters import TwinParameters

AT_ONCE = 1e-9  # s, what a drive without delay takes: nothing on the scale of a substep
Array = npt.NDArray[np.float64]


def pack(parameters: TwinParameters, refine: float) -> Array:
    """The kernel's parameter vector; `refine` divides the substeps."""
    gear, effects = parameters.gear, parameters.effects
    a, b, n = np.asarray(gear.kinematic_error.a), np.asarray(gear.kinematic_error.b), gear.kinematic_error.orders
    series = np.stack([a, b, n * a, n * b], axis=1).ravel()
    extra = error_lines(gear, effects)
    slipping, bristling = slips(effects.hysteresis), bristles(effects.friction)
    numbers = paper(parameters, refine) | lacking(gear, effects)
    numbers |= {
        kernel.TERMS: len(n),
        kernel.TOP_ORDER: max([len(n), *extra[::3], *motor_orders(effects)]),
        kernel.SERIES_AT: kernel.PARAMETERS,
        kernel.LINES: len(extra) // 3,
        kernel.LINES_AT: kernel.PARAMETERS + len(series),
        kernel.SLIPS: len(slipping) // 2,
        kernel.SLIPS_AT: kernel.PARAMETERS + len(series) + len(extra),
        kernel.BRISTLES: len(bristling) // 2,
        kernel.BRISTLES_AT: kernel.PARAMETERS + len(series) + len(extra) + len(slipping),
    }
    head = [numbers[place] for place in range(kernel.PARAMETERS)]
    return np.concatenate([head, series, extra, slipping, bristling])


def paper(parameters: TwinParameters, refine: float) -> dict[int, float]:
    """The paper's model, friction at rest and while sliding, drive and sensor      [ghorbel2001, Eqs. 5-7]"""
    gear = parameters.gear
    assembly, presliding = parameters.effects.assembly, parameters.effects.friction.presliding
    grip = 1.0 + assembly.friction_per_mm * assembly.depth_mm
    tau_c, tau_s = grip * (gear.tau_c - presliding), grip * (gear.tau_s - presliding)
    return {
        kernel.PER_N: 1.0 / gear.ratio,
        kernel.PER_J_M: 1.0 / gear.J_m,
        kernel.PER_J_L: 1.0 / gear.J_l,
        kernel.K: gear.K,
        kernel.B_M: gear.B_m,
        kernel.B_L: gear.B_l,
        kernel.B_ML: gear.B_ml,
        kernel.B_SP: gear.B_sp,
        kernel.SIGMA: gear.sigma,
        kernel.TAU_C: tau_c,
        kernel.TAU_S: tau_s,
        kernel.PER_OMEGA_S: 1.0 / gear.omega_s,
        kernel.F_CL: gear.F_cl,
        kernel.T_DRIVE: max(parameters.tau_drive, AT_ONCE),
        kernel.T_SENSOR: 1.0 / (2.0 * math.pi * parameters.sensor_lowpass_hz),
        kernel.WANDER: parameters.friction_noise,
        kernel.T_WANDER: parameters.friction_noise_s,
        kernel.MODE_RATE: fastest_rate(gear),
        kernel.REFINE: refine,
        kernel.COLD_TAU_C: tau_c,
        kernel.COLD_TAU_S: tau_s,
        kernel.COLD_B_M: gear.B_m,
        kernel.COLD_B_ML: gear.B_ml,
    }


def lacking(gear: Gear, effects: Effects) -> dict[int, float]:
    """What the paper's model lacks."""
    s, c, e, f = effects.stiffness, effects.creep, effects.load_dependent_error, effects.friction
    m, load = effects.motor, effects.load
    return breaks(gear.K, s) | {
        kernel.CUBIC: s.cubic,
        kernel.KAPPA: s.by_angle * gear.K,
        kernel.KAPPA_ORDER: s.by_angle_order,
        kernel.KAPPA_PHASE: math.radians(s.by_angle_deg),
        kernel.CREEP_K_1: c.stiffness_1,
        kernel.CREEP_PER_T_1: 1.0 / c.time_1,
        kernel.CREEP_K_2: c.stiffness_2,
        kernel.CREEP_PER_T_2: 1.0 / c.time_2,
        kernel.A_INF: e.A_inf,
        kernel.A_0: unloaded(effects),
        kernel.PER_T_C: 1.0 / e.T_c,
        kernel.PER_T_LOAD: 1.0 / e.filter,
        kernel.MU: f.by_load,
        kernel.UNEVEN: f.by_angle,
        kernel.UNEVEN_ORDER: f.by_angle_order,
        kernel.UNEVEN_PHASE: math.radians(f.by_angle_deg),
        kernel.DRAG_2: f.quadratic_drag,
        kernel.DRAG_23: f.two_thirds_drag,
        kernel.BETA: f.thermal_beta,
        kernel.WARMING: f.thermal_rise,
        kernel.PER_T_WARM: 1.0 / f.thermal_time,
        kernel.COGGING: m.cogging,
        kernel.COGGING_ORDER: m.cogging_order,
        kernel.COGGING_PHASE: math.radians(m.cogging_phase_deg),
        kernel.RIPPLE: m.ripple,
        kernel.RIPPLE_ORDER: m.ripple_order,
        kernel.RIPPLE_PHASE: math.radians(m.ripple_phase_deg),
        kernel.UNBALANCE: load.unbalance,
        kernel.UNBALANCE_PHASE: math.radians(load.unbalance_phase_deg),
        kernel.SHAKE: load.vibration,
        kernel.SHAKE_RATE: 2.0 * math.pi * load.vibration_hz if load.vibration else 0.0,
        kernel.SHAKE_PHASE: math.radians(load.vibration_phase_deg),
    }


def breaks(K: float, s: Stiffness) -> dict[int, float]:
    """Where the pieces of the spring's law end; without T1 the first has no end."""
    gap = math.radians(s.gap_deg)
    first = gap + s.T1 / K if s.T1 else math.inf
    second = first + (s.T2 - s.T1) / s.K2 if s.T1 else math.inf
    return {
        kernel.GAP: gap,
        kernel.BREAK_1: first,
        kernel.BREAK_2: second,
        kernel.TORQUE_1: s.T1,
        kernel.TORQUE_2: s.T2,
        kernel.K_2: s.K2,
        kernel.K_3: s.K3,
    }


def unloaded(effects: Effects) -> float:
    """A_0 at the depth the wave generator has: falls with depth, never below the plateau      [ghorbel2001, Fig. 10]"""
    assembly, plateau = effects.assembly, effects.load_dependent_error.A_inf
    return max(1.0 - assembly.error_per_mm * assembly.depth_mm, plateau)


def slips(h: Hysteresis) -> list[float]:
    """(k_i, s_i) of the hysteresis."""
    return evenly(h.torque, math.radians(h.twist_deg), h.elements)


def bristles(f: Friction) -> list[float]:
    """(k_i, s_i) of friction before it slides."""
    return evenly(f.presliding, math.radians(f.presliding_deg), f.presliding_elements)


def evenly(torque: float, widest: float, count: int) -> list[float]:
    """(k_i, s_i) [N·m/rad, rad]: s_i evenly spaced up to `widest`, one stiffness, Σ k_i·s_i = `torque`."""
    if torque == 0.0:
        return []
    s = [widest * (i + 1) / count for i in range(count)]
    k = torque / sum(s)
    return [x for s_i in s for x in (k, s_i)]


def error_lines(gear: Gear, effects: Effects) -> list[float]:
    """(order, a, b) [rad] of each line."""
    found = []
    for order, amplitude_deg, phase_deg in lines(effects.error_lines, gear.ratio, gear.sigma):
        amplitude, phase = math.radians(amplitude_deg), math.radians(phase_deg)
        found += [order, amplitude * math.cos(phase), amplitude * math.sin(phase)]
    return found


def motor_orders(effects: Effects) -> list[float]:
    """Orders at which something acts on the motor."""
    s, f, m = effects.stiffness, effects.friction, effects.motor
    table = (
        (s.by_angle, s.by_angle_order),
        (f.by_angle, f.by_angle_order),
        (m.cogging, m.cogging_order),
        (m.ripple, m.ripple_order),
    )
    return [order for size, order in table if size]


def fastest_rate(gear: Gear) -> float:
    """The fastest linear rate [1/s]: the torsional mode's frequency, its damping, the drag of either side."""
    damping = 2.0 * damping_ratio(gear) * natural_frequency(gear)
    return max(natural_frequency(gear), damping, (gear.B_m + gear.B_ml) / gear.J_m, (gear.B_l + gear.B_ml) / gear.J_l)
