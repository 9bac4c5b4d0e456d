"""Where an effect enters the equations of the rig, or the reading of a sensor."""

from __future__ import annotations

from enum import StrEnum


class Port(StrEnum):
    """Where an effect enters      [ghorbel2001, Eqs. 6-7]

    With θ̃ = θ_m/N − θ_l, the shaft torque T (what the gear gives to the load) and the reading r of a sensor:

    MOTOR_TORQUE     N·m that resists the motor, as B_m·ω_m does
    LOAD_TORQUE      N·m that resists the load, as B_l·ω_l does
    KINEMATIC_ERROR  rad that adds to θ̃_p
    LEVER            dθ̃_p/dθ_m of the same columns; without it the columns turn no torque
    WIND_UP          rad of θ̃ that goes with the torque, as T/K does
    READS_*          what the reading of that sensor has too much, in its own unit
    """

    MOTOR_TORQUE = "motor_torque"
    LOAD_TORQUE = "load_torque"
    KINEMATIC_ERROR = "kinematic_error"
    LEVER = "lever"
    WIND_UP = "wind_up"
    READS_THETA_M = "reads_theta_m"
    READS_THETA_L = "reads_theta_l"
    READS_TAU_M = "reads_tau_m"
    READS_TAU_L = "reads_tau_l"
