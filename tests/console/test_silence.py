"""A device that has gone silent while nothing runs: what it told last is not shown as the present."""

from __future__ import annotations

import math

import pytest

from rig.core.channels import Flag
from rig.core.sample import Sample
from rig.station.silence import LONGEST, Silence

READING = Sample(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.0, 0, 0, 0, "")
CASES = {
    Flag.STALE_M: {"theta_m", "omega_m", "tau_m"},
    Flag.STALE_L: {"theta_l"},
    Flag.STALE_TAU: {"tau_l"},
}


def _missing(sample: Sample) -> set[str]:
    return {name for name in ("theta_m", "theta_l", "omega_m", "tau_m", "tau_l") if math.isnan(getattr(sample, name))}


@pytest.mark.parametrize("flag", CASES)
def test_a_silent_channel_is_not_measured_any_more_and_the_others_are(flag: Flag) -> None:
    silence = Silence()
    silence.hear(READING, 0.0)
    dead = READING._replace(flags=int(flag))
    assert not _missing(silence.hear(dead, 0.5 * LONGEST))
    assert not _missing(silence.hear(dead, 0.9 * LONGEST))
    assert _missing(silence.hear(dead, 1.1 * LONGEST)) == CASES[flag]
    assert not _missing(silence.hear(READING, 1.2 * LONGEST)), "it is heard again"


def test_while_nobody_listened_nobody_was_silent() -> None:
    silence, stale = Silence(), READING._replace(flags=int(Flag.STALE_M))
    silence.hear(READING, 0.0)
    assert not _missing(silence.hear(stale, 100.0)), "the first reading after a job"
    silence.hear(stale, 100.0 + 0.6 * LONGEST)
    assert _missing(silence.hear(stale, 100.0 + 1.2 * LONGEST)) == CASES[Flag.STALE_M]


def test_on_a_clock_that_stands_still_nothing_grows_old() -> None:
    silence, still = Silence(), READING._replace(flags=int(Flag.STALE_M))
    assert not any(_missing(silence.hear(still, 7.0)) for _ in range(100))
