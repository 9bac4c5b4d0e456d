"""What a form may change: tables of the plant, its scalars, what the sensors do. Effects add to one another here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.blind.kernel import (
    DEFLECTION_SIZE,
    DEFLECTION_STEP,
    LOAD_SIZE,
    LOAD_STEP,
    SPEED_SIZE,
    SPEED_STEP,
    TURN,
    Par,
    Tab,
)
from tests.blind.rig import Rig
from tests.blind.sensors import Sensors

ANGLE = np.arange(TURN) * 2 * np.pi / TURN
SPEED = np.arange(SPEED_SIZE) * SPEED_STEP
LOAD = np.arange(LOAD_SIZE) * LOAD_STEP
DEFLECTION = (np.arange(DEFLECTION_SIZE) - DEFLECTION_SIZE // 2) * DEFLECTION_STEP
ONE_TURN = (
    "p", "p_load", "p_frame", "p_out", "friction_angle", "friction_frame",
    "stiff_m", "stiff_l", "cogging", "ripple", "on_load", "encoder_m", "pulley",
)  # fmt: skip
PLAIN = (
    "ke_gain", "friction_forward", "friction_backward", "friction_load", "spring",
    "slip_k", "slip_x", "creep_k", "creep_tau", "play_k", "play_x",
)  # fmt: skip

Wave = Callable[[np.ndarray], np.ndarray]


def one_turn(table: np.ndarray) -> np.ndarray:
    """Values of one turn with the first again, then their slopes: by FFT, exact for a band-limited table."""
    slope = np.fft.irfft(np.fft.rfft(table) * 1j * np.arange(TURN // 2 + 1), TURN)
    return np.concatenate([table, table[:1], slope, slope[:1]])


@dataclass
class Builder:
    """The plant under construction. `tables` and `scalars` carry the field names of `Tab` and `Par`."""

    rig: Rig
    sensors: Sensors = field(default_factory=Sensors)
    tables: dict[str, np.ndarray] = field(default_factory=dict)
    scalars: dict[str, float] = field(default_factory=dict)
    load_waves: list[Wave] = field(default_factory=list)

    def add(self, name: str, table: np.ndarray) -> None:
        """Add a table to what is there."""
        self.tables[name] = self.tables.get(name, np.zeros_like(table)) + table

    def set(self, **scalars: float) -> None:
        """Set scalars; two effects may not claim the same one."""
        taken = [name for name in scalars if name in self.scalars]
        if taken:
            raise ValueError(f"two effects of one case claim {taken}: choose another pair")
        self.scalars.update(scalars)

    def par(self, locked: bool) -> Par:
        """Scalars of a run; `locked` holds the output."""
        rig = self.rig
        values: dict[str, float] = {
            "N": rig.N, "J_m": rig.J_m, "J_l": rig.J_l, "K": rig.K, "B_m": rig.B_m, "B_l": rig.B_l,
            "B_ml": rig.B_ml, "B_sp": rig.B_sp, "T_c": rig.T_c, "T_l": rig.T_l, "extra": 0, "J_x": 1.0, "k_x": 0.0,
            "c_x": 0.0, "dry_x": 0.0, "friction": 0, "sigma_0": 300.0, "sigma_1": 0.0, "share": 0.5,
            "hysteresis": 0, "bw_k": 0.0, "bw_x": 1.0, "bw_beta": 0.5, "bw_n": 1.0, "bw_delta": 0.0,
            "slip_back": 1.0, "t_slow": 0.03,
            "back_driven": 1.0, "heat_gain": 0.0, "heat_tau": 900.0, "warm_c": 0.0, "warm_v": 0.0,
            "warm_tau_1": 600.0, "warm_tau_2": 600.0, "warm_share": 1.0, "aging": 0.0, "aging_tau": 1800.0,
            "ke_aging": 0.0, "lag_angle": 0.0, "lag_scale": 0.05, "dead_zone": 0.0, "odd_order": 0.0, "odd_size": 0.0,
            "odd_phase": 0.0, "warm_root": 0, "locked": int(locked),
        }  # fmt: skip
        integers = {
            name: int(self.scalars.get(name, values[name])) for name in ("extra", "friction", "hysteresis", "warm_root")
        }
        return Par(**{**values, **self.scalars, **integers})

    def pure_error(self) -> np.ndarray:
        """Pure kinematic error of the baseline over one wave-generator turn, rad."""
        order = np.arange(1, len(self.rig.ke_cos) + 1)[:, None]
        a, b = np.array(self.rig.ke_cos)[:, None], np.array(self.rig.ke_sin)[:, None]
        return np.sum(a * np.cos(order * ANGLE) + b * np.sin(order * ANGLE), axis=0)

    def tab(self) -> tuple[Tab, np.ndarray]:
        """Tables for the compiled plant: where each begins, and the array that holds them all."""
        tables = self.tables | {"p": self.pure_error() + self.tables.get("p", np.zeros(TURN))}
        parts, at, end = [np.zeros(1)], dict.fromkeys(Tab._fields, 0), 1
        for name, table in tables.items():
            parts.append(one_turn(table) if name in ONE_TURN else table)
            at[name], end = end, end + len(parts[-1])
        for count, name in (("slips", "slip_k"), ("creeps", "creep_k"), ("plays", "play_k")):
            at[count] = len(tables.get(name, ()))
        return Tab(**at), np.concatenate(parts)
