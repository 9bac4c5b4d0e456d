"""Smoothness as a person is shown it: what was not met, with which gain it is mended, and its figures."""

from __future__ import annotations

from rig.analysis.findings.result import Check, Estimate
from rig.analysis.smoothness.fast_ripple import TOP_HZ
from rig.analysis.smoothness.measure import SIGMA_LIMIT, STUCK_BELOW, STUCK_LIMIT, Smoothness

ADVICE = {
    "stuck": "it sticks and breaks loose: raise Kd (double it), then Kp",
    "hunting": "either the loop hunts, then lower Ki (halve it), or something shakes the rig at that frequency "
    "(a standstill run shows it)",
    "rough": "it runs unevenly without a frequency of its own: raise Kp and Kd together",
}


def advice(s: Smoothness) -> str:
    """Which gain to change and how, for a run that was not smooth."""
    if s.stuck > STUCK_LIMIT:
        cause = "stuck"
    elif s.hunts:
        cause = "hunting"
    else:
        cause = "rough"
    return f"{ADVICE[cause]}; `hdrig tune` finds gains."


def sentence(s: Smoothness) -> str:
    """Why the run was rejected, or the figures it passed with."""
    figures = (
        f"stuck {100 * s.stuck:.1f} % of the time (limit {100 * STUCK_LIMIT:.0f} %), "
        f"speed scatter {100 * s.sigma:.1f} % of {s.nominal_rpm:.2f} rpm (limit {100 * SIGMA_LIMIT:.0f} %)"
    )
    if s.hunts and not s.passed:
        figures += f", swinging at {s.hunting_hz:.2f} Hz ({100 * s.hunting_share:.0f} % of the variance)"
    return (
        f"The motor ran smoothly: {figures}." if s.passed else f"The motor did not run smoothly: {figures}; {advice(s)}"
    )


def checks(s: Smoothness) -> tuple[Check, Check]:
    """The two conditions a slow run has to meet."""
    return (
        Check(
            "stuck_share",
            s.stuck <= STUCK_LIMIT,
            f"Stuck (below {100 * STUCK_BELOW:.0f} % of {s.nominal_rpm:.2f} rpm) for {100 * s.stuck:.2f} % of the "
            f"strokes, limit {100 * STUCK_LIMIT:.0f} %.",
        ),
        Check(
            "speed_scatter",
            s.sigma <= SIGMA_LIMIT,
            f"Speed scatter {100 * s.sigma:.2f} % of nominal (1 σ), limit {100 * SIGMA_LIMIT:.0f} %.",
        ),
    )


def estimates(s: Smoothness) -> tuple[Estimate, ...]:
    """The same as figures. They describe this run and stand for no other: they carry no interval."""
    nan = float("nan")
    how = f"within the strokes, half a turn at each reversal left out; speed over {1000 * s.window:.0f} ms windows"
    faster = f"what is faster, up to {TOP_HZ:.0f} Hz, from the angle's spectrum less its noise floor"
    stuck, sigma = 100 * s.stuck, 100 * s.sigma
    rows = [
        Estimate("stuck_share", "Time stuck", stuck, "%", (nan, nan), f"Share below 10 % of nominal; {how}."),
        Estimate("speed_scatter", "Speed scatter", sigma, "%", (nan, nan), f"1 σ over nominal; {how}, {faster}."),
    ]
    if s.hunts:
        share = f"{100 * s.hunting_share:.0f} % of its variance"
        what = f"Strongest frequency of the speed that does not follow the motor angle, {share}."
        rows.append(Estimate("hunting_frequency", "Hunting frequency", s.hunting_hz, "Hz", (nan, nan), what))
    return tuple(rows)
