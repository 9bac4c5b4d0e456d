"""Effects outside the library of trace-report.md: the right answer is `unknown_effect` and a coordinate."""

from tests.blind.forms.outside import (
    damaged_tooth,
    drifting_interference,
    friction_hump,
    gear_creep,
    growing_error,
    hub_slip,
    kinematic_lag,
    magnetic_hysteresis,
    motor_dead_zone,
    one_way_drag,
    sensor_gain_temperature,
    stiffness_aging,
    stitched_grating,
    torque_sensor_hysteresis,
)

OUTSIDE = (
    *damaged_tooth.FORMS,
    *drifting_interference.FORMS,
    *friction_hump.FORMS,
    *gear_creep.FORMS,
    *growing_error.FORMS,
    *hub_slip.FORMS,
    *kinematic_lag.FORMS,
    *magnetic_hysteresis.FORMS,
    *motor_dead_zone.FORMS,
    *one_way_drag.FORMS,
    *sensor_gain_temperature.FORMS,
    *stiffness_aging.FORMS,
    *stitched_grating.FORMS,
    *torque_sensor_hysteresis.FORMS,
)
