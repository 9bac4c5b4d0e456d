"""Which number of trace.json answers to which number of the truth, where both mean the same thing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

Numbers = Mapping[str, float]
Key = tuple[str, str]  # effect, form

# (effect, form) → parameter of trace.json → the true value from the truth's parameters and its rig
SAME: dict[Key, dict[str, Callable[[Numbers, Numbers], float]]] = {
    ("stribeck_friction", "gaussian"): {
        "tau_s_minus_tau_c": lambda p, r: p["rise_Nm"],
        "omega_s": lambda p, r: p["stribeck_speed_rad_s"],
    },
    ("stribeck_friction", "exponential"): {
        "tau_s_minus_tau_c": lambda p, r: p["rise_Nm"],
        "omega_s": lambda p, r: p["stribeck_speed_rad_s"],
    },
    ("load_dependent_friction", "linear"): {"mu_L": lambda p, r: p["mu"]},
    ("load_dependent_kinematic_error", "exponential"): {
        "A_inf": lambda p, r: p["A_inf"],
        "T_c": lambda p, r: p["torque_scale_Nm"],
    },
    ("lost_motion", "sharp"): {"gap": lambda p, r: 2 * p["half_gap_rad"]},
    ("channel_time_skew", "load_late"): {"skew_theta_l": lambda p, r: p["late_s"]},
    ("quadratic_drag", "square"): {"drag_at_10_rad_s": lambda p, r: 100 * p["drag_Nms2_per_rad2"]},
    ("thermal_friction_drift", "one_constant"): {
        "t_w": lambda p, r: p["tau_s"],
        "tau_cold": lambda p, r: p["dry_share"] * r["T_c"],
        "B_cold": lambda p, r: p["viscous_share"] * r["B_m"],
    },
    ("gravity_unbalance", "sine"): {"unbalance_amplitude": lambda p, r: p["torque_Nm"]},
    ("output_once_per_rev", "eccentric"): {"order_1_amplitude": lambda p, r: p["amplitude_rad"]},
    ("output_once_per_rev", "runout"): {"order_1_amplitude": lambda p, r: p["amplitude_rad"]},
    ("motor_encoder_eccentricity", "sine"): {"eccentricity_amplitude": lambda p, r: p["amplitude_rad"]},
    ("torque_sensor_crosstalk", "once"): {"order_1_amplitude": lambda p, r: p["torque_1_Nm"]},
    ("angle_dependent_stiffness", "order_two"): {"kappa_order_2_amplitude": lambda p, r: p["share_2"]},
    ("position_dependent_friction", "order_two"): {"order_2_amplitude": lambda p, r: p["share_2"] * r["T_c"]},
    ("flexspline_frame_error", "order_2p04"): {"order_2.04_amplitude": lambda p, r: p["amplitude_2.04_rad"]},
    ("tooth_mesh_error", "order_102"): {"order_102_amplitude": lambda p, r: p["amplitude_102_rad"]},
    ("support_compliance", "sprung"): {"frequency": lambda p, r: p["frequency_hz"]},
    # the truth's is that of both halves free, the trace's that of the spring and the inertia that hangs on it
    ("torsional_mode", "disc"): {"frequency": lambda p, r: p["frequency_hz"] * (1 - p["share_of_J_l"]) ** 0.5},
    ("external_vibration", "sine"): {"frequency": lambda p, r: p["frequency_hz"]},
}


@dataclass(frozen=True)
class Compared:
    """One estimate beside the truth."""

    name: str
    true: float
    value: float
    covered: bool

    @property
    def relative_error(self) -> float:
        return abs(self.value - self.true) / abs(self.true)


def compare(hidden: Mapping[str, object], rig: Numbers, answer: Mapping[str, object]) -> list[Compared]:
    """Estimates of trace.json (`effects` → effect → parameters) that have a true value, beside it."""
    effect, form = str(hidden["effect"]), str(hidden["form"])
    given = answer.get("effects", {}).get(effect, {}).get("parameters", {})  # type: ignore[attr-defined]
    wanted = dict(SAME.get((effect, form), {}))
    own: Numbers = hidden["parameters"]  # type: ignore[assignment]
    if "order" in own and form == "one_order":  # cogging and ripple: the order is part of the parameter's name
        size = own.get("torque_Nm", own.get("share", 0.0))
        wanted[f"order_{own['order']:g}_amplitude"] = lambda p, r: size
    out = []
    for name, true in wanted.items():
        if name in given:
            low, high = given[name]["ci95"]
            value = true(own, rig)
            out.append(Compared(f"{effect}.{name}", value, given[name]["value"], low <= value <= high))
    return out
