"""Which runs a campaign holds, in the order they are taken, with the clock time at which each starts."""

from __future__ import annotations

from dataclasses import dataclass, replace

SLOW_DT, FAST_DT = 4e-3, 1e-3  # s between rows
STROKE_SPEED = 1.0053  # rad/s = 9.6 rpm, the paper's slow speed
STAIR_S = 4.0  # s on a stair, a second of it to get there


@dataclass(frozen=True)
class RunPlan:
    """One run. `lead_s` seconds pass before the first row; `amplitude` is of the triangle, rad at the motor."""

    name: str
    procedure: str
    duration_s: float
    dt: float
    lead_s: float
    amplitude: float = 0.0
    tau_ext: float = 0.0
    locked: bool = False
    speed_rpm: float = 0.0
    one_way: bool = False
    start_s: float = 0.0
    stairs_rpm: tuple[float, ...] = ()  # speeds held one after the other, STAIR_S each, under the position loop


@dataclass(frozen=True)
class Plan:
    """A named list of runs; `channels` are those the loggers write."""

    name: str
    runs: tuple[RunPlan, ...]
    channels: tuple[str, ...] = ("theta_m", "theta_l", "tau_l", "tau_m")
    resonance_hz: tuple[float, float] = (
        16.2,
        21.5,
    )  # rigs whose resonance no steady speed of the plan excites by order 2


def slow(repeat: str) -> RunPlan:
    return RunPlan(f"slow_ke_{repeat}", "kinematic_error", 100.0, SLOW_DT, 0.0, amplitude=25.1327)


def loaded(torque: float, repeat: str) -> RunPlan:
    return RunPlan(
        f"load_{torque:g}nm_{repeat}", "kinematic_error", 44.0, SLOW_DT, 6.0, amplitude=12.5664, tau_ext=-torque
    )


def lock(degrees: int, repeat: str) -> RunPlan:
    amplitude = degrees * 3.14159265 / 180 * 0.98
    return RunPlan(f"lock_{degrees}_{repeat}", "stiffness_lock", 50.0, SLOW_DT, 0.0, amplitude=amplitude, locked=True)


def steady(rpm: int, repeat: str, torque: float = 0.0) -> RunPlan:
    """A speed held by a constant torque, under a weight of `torque` N·m at the load."""
    under = f"load_{torque:g}nm_" if torque else ""
    name = f"{under}speed_{'minus' if rpm < 0 else ''}{abs(rpm)}rpm_{repeat}"
    return RunPlan(name, "constant_torque", 10.0, FAST_DT, 4.0, tau_ext=-torque, speed_rpm=float(rpm))


def stairs(speeds_rpm: tuple[float, ...], repeat: str) -> RunPlan:
    """Up and down through the speeds, both ways."""
    up = (*speeds_rpm, *reversed(speeds_rpm))
    asked = (*up, *(-rpm for rpm in up))
    return RunPlan(f"stairs_{repeat}", "friction", STAIR_S * len(asked), FAST_DT, 0.0, stairs_rpm=asked)


STANDSTILL = RunPlan("standstill", "standstill", 10.0, SLOW_DT, 0.0)
BOTH = ("1", "2")
PAPERS = (18.6, 24.5)  # Hz, the paper's speeds: order 2 turns at 16.7 Hz at 500 rpm, order 4 at 20.7 Hz at 310 rpm


def started(runs: list[RunPlan], gap_s: float) -> tuple[RunPlan, ...]:
    """The runs one after another with a pause of `gap_s` between them."""
    clock, out = 0.0, []
    for run in runs:
        out.append(replace(run, start_s=clock))
        clock += run.lead_s + run.duration_s + gap_s
    return tuple(out)


def sentinel(letter: str) -> RunPlan:
    return steady(120, f"sentinel_{letter}")


def full_list() -> list[RunPlan]:
    """36 runs, the shape of the reference campaigns: slow and loaded triangles, speeds both ways, locks, sentinels."""
    runs = [STANDSTILL, sentinel("a"), *(slow(k) for k in BOTH)]
    runs += [loaded(torque, k) for torque in (2.5, 5.0, 10.0, 20.0, 40.0) for k in BOTH]
    runs += [sentinel("b")]
    runs += [steady(rpm, k) for rpm in (60, 120, 200, 300, 400, -60, -200, -400) for k in BOTH]
    return [*runs, *(lock(d, k) for d in (60, 20) for k in BOTH), sentinel("c")]


def complete() -> Plan:
    return Plan("complete", started(full_list(), 18.0))


def paper() -> Plan:
    """Only what the paper took: triangle, 120/300/310/500 rpm at constant torque, one lock test; each twice."""
    runs = [slow(k) for k in BOTH]
    runs += [steady(rpm, k) for rpm in (120, 300, 310, 500) for k in BOTH] + [lock(60, k) for k in BOTH]
    return Plan("paper", started(runs, 18.0), resonance_hz=PAPERS)


def paper_once() -> Plan:
    """The same without any repeat."""
    return Plan(
        "paper_once", started([run for run in paper().runs if run.name.endswith("_1")], 18.0), resonance_hz=PAPERS
    )


def paper_one_way() -> Plan:
    """The same, the slow runs forward only."""
    runs = [replace(run, one_way=run.procedure == "kinematic_error") for run in paper().runs]
    return Plan("paper_one_way", tuple(runs), resonance_hz=PAPERS)


def paper_no_torque_sensor() -> Plan:
    return replace(paper(), name="paper_no_torque_sensor", channels=("theta_m", "theta_l", "tau_m"))


def noreps() -> Plan:
    """One run per condition: no repeat to take a floor from."""
    return Plan("noreps", started([run for run in full_list() if not run.name.endswith("_2")], 18.0))


def one_direction() -> Plan:
    """Nothing turns back but the lock tests: slow and loaded runs are ramps forward, speeds are positive."""
    runs = [run for run in full_list() if "minus" not in run.name]
    return Plan(
        "one_direction", started([replace(run, one_way=run.procedure == "kinematic_error") for run in runs], 18.0)
    )


def no_torque_sensor() -> Plan:
    return replace(complete(), name="no_torque_sensor", channels=("theta_m", "theta_l", "tau_m"))


def no_motor_torque() -> Plan:
    """The drive does not say its torque."""
    return replace(complete(), name="no_motor_torque", channels=("theta_m", "theta_l", "tau_l"))


def slow_and_locks() -> Plan:
    """Never faster than the paper's slow speed."""
    runs = [run for run in full_list() if run.procedure in ("kinematic_error", "stiffness_lock")]
    return Plan("slow_and_locks", started(runs, 18.0))


def weights_at_one_speed() -> Plan:
    """120 rpm both ways under each weight, and a lock test."""
    runs = [steady(rpm, k, torque) for torque in (0.0, 5.0, 10.0, 20.0, 40.0) for rpm in (120, -120) for k in BOTH]
    return Plan("weights_at_one_speed", started([STANDSTILL, *runs, *(lock(60, k) for k in BOTH)], 18.0))


def speeds_alone() -> Plan:
    """Steady speeds both ways and nothing else."""
    return Plan("speeds_alone", started([run for run in full_list() if run.procedure == "constant_torque"], 18.0))


PLANS = {
    "complete": complete,
    "paper": paper,
    "paper_once": paper_once,
    "paper_one_way": paper_one_way,
    "paper_no_torque_sensor": paper_no_torque_sensor,
    "noreps": noreps,
    "one_direction": one_direction,
    "no_torque_sensor": no_torque_sensor,
    "no_motor_torque": no_motor_torque,
    "slow_and_locks": slow_and_locks,
    "weights_at_one_speed": weights_at_one_speed,
    "speeds_alone": speeds_alone,
}
