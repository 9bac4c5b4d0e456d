"""What a verdict says in words."""

from __future__ import annotations

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.selection.sentences import nothing


def test_more_than_is_usual_left_and_nothing_missing_is_told_with_its_reason() -> None:
    assert nothing(WHOLE, 1.04, False).endswith("the baseline leaves 1.04 times the floor on held-out runs.")
    assert "by chance, or by friction that differs from run to run" in nothing(WHOLE, 1.39, False)
    assert nothing(WHOLE[:1], 1.39, False).endswith("these runs show nothing.")


def test_runs_that_could_show_little_say_no_more_than_they_saw() -> None:
    assert nothing(WHOLE, 1.04, True).startswith("Nothing that these runs could show is missing: ")
    assert nothing(WHOLE, 1.04, False).startswith("Nothing is missing: ")
