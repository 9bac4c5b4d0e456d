"""The objects of a CiA 402 drive that say what its numbers mean: ratings, scales, units, limits      [cia402]"""

from __future__ import annotations

from sim.wire.motion import Settings
from sim.wire.motor import Motor, Rating
from sim.wire.objects import I8, I16, I32, U8, U16, U32, Entry, Objects

INCREMENTS, INCREMENTS_PER_SECOND = 0x00B50000, 0x00B50300  # 60A8, 60A9      [cia303]


def add_plate(o: Objects, motor: Motor, rating: Rating) -> None:
    """Ratings 6073 to 6080, scales 608F, 6091, 6092, units 60A8, 60A9."""
    turn = motor.counts_per_turn
    o.add(0x6073, Entry(U16, most_torque(motor, rating)))  # per mille of 6075
    o.add(0x6075, Entry(U32, round(1000.0 * rating.torque / rating.constant)))  # mA
    o.add(0x6076, Entry(U32, round(1000.0 * rating.torque)))  # mN·m
    o.add(0x6080, Entry(U32, 3000))  # rpm
    o.record(0x608F, {1: Entry(U32, turn), 2: Entry(U32, 1)})
    o.record(0x6091, {1: Entry(U32, 1), 2: Entry(U32, 1)})  # what is geared lies behind the motor's own encoder
    o.record(0x6092, {1: Entry(U32, turn), 2: Entry(U32, 1)})
    o.add(0x60A8, Entry(U32, INCREMENTS))
    o.add(0x60A9, Entry(U32, INCREMENTS_PER_SECOND))


def add_settings(o: Objects, motor: Motor, rating: Rating) -> Settings:
    """Targets and limits of motion; what a target does is put into its entry by who follows it."""
    turn = motor.counts_per_turn
    settings = Settings(
        target_torque=o.add(0x6071, Entry(I16, mappable=True)),
        target_position=o.add(0x607A, Entry(I32, mappable=True)),
        target_velocity=o.add(0x60FF, Entry(I32, mappable=True)),
        max_torque=o.add(0x6072, Entry(U16, most_torque(motor, rating), mappable=True)),
        window=o.add(0x6065, Entry(U32, turn // 4)),
        window_time=o.add(0x6066, Entry(U16, 100)),
        deceleration=o.add(0x6085, Entry(U32, 100 * turn)),  # from 600 rpm to rest in 0.1 s
        interval=Entry(U8, 1),
    )
    o.record(0x60C2, {1: settings.interval, 2: Entry(I8, -3)})
    return settings


def most_torque(motor: Motor, rating: Rating) -> int:
    """What the motor can give, in per mille of its rating."""
    return round(1000.0 * motor.world.parameters.torque_limit / rating.torque)
