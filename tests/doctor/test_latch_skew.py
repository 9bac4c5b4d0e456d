"""The doctor says whether latch skew is known, and what it means."""

from __future__ import annotations

from rig.bench import Bench, read
from rig.config.bench_file import read_bench
from rig.doctor.finding import Health
from rig.doctor.latch_skew import check_latch_skew


def test_a_skew_nobody_measured_is_doubtful_with_what_a_period_would_do() -> None:
    (found,) = check_latch_skew(read("twin"))
    assert found.health is Health.DOUBTFUL
    assert "one period of 1 ms would move θ̃ by 4.1 arcsec at 9.6 rpm" in found.sentence


def test_a_measured_one_is_told_with_its_interval() -> None:
    text = read("twin").text.replace("[load_encoder]", "[load_encoder]\nskew = -1e-4\nskew_half_width = 1e-5")
    (found,) = check_latch_skew(Bench(read_bench(text, "told"), text, "told"))
    assert found.health is Health.GOOD
    assert found.sentence == "-100 ± 10 µs after the motor angle, moves θ̃ by 0.41 ± 0.041 arcsec at 9.6 rpm"
