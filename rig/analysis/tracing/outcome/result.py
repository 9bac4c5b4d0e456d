"""What a trace found, as one value: what trace.json says, and the arrays its page draws."""

from __future__ import annotations

from dataclasses import dataclass, field

from rig.analysis.findings.result import Array
from rig.analysis.tracing.answer import Candidate, NextRun, Verdict
from rig.analysis.tracing.outcome.mean_drift import MeanDrift
from rig.analysis.tracing.outcome.ripple import Ripple
from rig.model.effect import Parameter


@dataclass(frozen=True)
class Floor:
    """The scatter between repeats of one channel: what no model can explain."""

    channel: str  # theta_l, tau_l or tau_m
    rms: float
    unit: str
    how: str
    ci95: tuple[float, float] | None = None  # of the RMS; None of one that is rounding, or all that is left


@dataclass(frozen=True)
class Found:
    """An effect that was named, with its parameters after the refit of everything together."""

    effect: str
    parameters: tuple[Parameter, ...]
    share: float  # of the held-out excess over the floor it removes, in the channel it matters most in
    each_run: bool = False  # phases or instants that every run has to itself, held out or not


@dataclass(frozen=True)
class Errors:
    """Error of a model on one run (or on all held-out runs), and the floor beside it. None: not measured there."""

    kinematic_error_rms_arcsec: float | None
    tau_m_rms: float | None
    tau_l_rms: float | None
    floor_kinematic_error_arcsec: float | None = None
    floor_tau_m: float | None = None
    floor_tau_l: float | None = None
    free_kinematic_error_rms_arcsec: float | None = None  # of a simulation led by the motor's motion alone
    free_by_load_rest_rms_arcsec: float | None = None  # what the rest of the shaft torque makes of that by itself


@dataclass(frozen=True)
class Curve:
    """A curve without a name along a coordinate, in one channel; what that leaves of unseen runs, RMS over floor.
    `acts`: where it acts and as what, of a form that was fitted with everything else; "" of a curve in the channel
    alone."""

    coordinate: str
    channel: str  # theta_l, tau_l or tau_m
    order: float | None  # cycles per turn of that coordinate
    frequency_hz: float | None
    over_floor: float
    acts: str = ""


@dataclass(frozen=True)
class Before:
    """Errors on held-out runs alone."""

    per_run: dict[str, Errors]
    pooled: Errors


@dataclass(frozen=True)
class Trace:
    """All of it. `curves` by dotted name, arrays of equal length within a group; units in the name's last part:

    spectrum.motor_order, spectrum.before_arcsec, spectrum.after_arcsec      held-out kinematic error against order
    angle.theta_m_deg, angle.before_arcsec, angle.after_arcsec      mean residual; load_angle.* alike
    direction.*, load.*, speed.*, time.*      mean residual of each run in each channel (`_arcsec`, `_Nm`)
    run.<name>.theta_m_turns, .measured_arcsec, .before_arcsec, .after_arcsec
        kinematic error, measured and modelled
    loop.<name>.windup_arcsec, .torque_Nm, .before_Nm, .after_Nm      torque against wind-up of held-out lock runs
    """

    campaign: str
    simulated: bool
    fitted: tuple[str, ...]
    held_out: tuple[str, ...]
    held_out_how: str
    floors: tuple[Floor, ...]
    baseline: tuple[Parameter, ...]
    baseline_after: tuple[Parameter, ...]
    cannot_be_told_apart: tuple[tuple[str, ...], ...]
    unexplained: dict[str, float]  # share of the held-out variance the baseline leaves, by channel
    ratios_before: dict[str, float]  # held-out RMS over floor, by channel
    ratios_after: dict[str, float]
    lives_in: tuple[str, ...]
    candidates: tuple[Candidate, ...]
    verdict: Verdict
    effects: tuple[Found, ...]
    before: Before
    after: Before
    next_run: NextRun | None
    notes: tuple[str, ...]  # runs left out, channels missing, floors that are not to be trusted: one sentence each
    cannot: tuple[str, ...]  # what this campaign cannot tell, one sentence each
    curves: dict[str, Array] = field(default_factory=dict)
    ripple: tuple[Ripple, ...] = ()  # of torques by order, where a channel is missing
    mean_drift: tuple[MeanDrift, ...] = ()  # of torques from day to day, where a channel is missing
    added_curves: tuple[Curve, ...] = ()  # without a name, in the order in which they were added
    ratios_named: dict[str, float] = field(default_factory=dict)  # as `ratios_after`, without those curves
    law: tuple[str, ...] = ()  # the laws without a name that were, for people
    read: int = 0  # runs of the campaign that were read, standstill among them
    left_out: tuple[str, ...] = ()  # runs that were not, by folder; the notes say why

    @property
    def by_names(self) -> dict[str, float]:
        """Held-out RMS over floor by channel, with effects and laws alone: without curves that have no name."""
        return self.ratios_named or self.ratios_after
