"""A figure that is far from its declaration is told beside it."""

from __future__ import annotations

from rig.analysis.motion.declared import far_off


def test_a_stiffness_a_thousand_times_the_declared_is_told_with_both_and_one_beside_it_is_not() -> None:
    assert "7.22e+06 N·m/rad, 1.01e+03 times the 7.16e+03 declared" in far_off("K", 7.2158e6, 7160.0)
    assert far_off("K", 7.2158, 7160.0)
    assert far_off("K", 7215.8, 7160.0) == ""
