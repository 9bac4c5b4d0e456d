"""Every parameter of every procedure says its unit and what it means, in the help as on the console's page."""

from __future__ import annotations

import pytest

from rig.campaign.sweeps import CATALOGUE as SWEEPS
from rig.campaign.sweeps import sweep_class
from rig.cli import main
from rig.parameters.told import told
from rig.procedures import CATALOGUE, procedure_class

KINDS = {name: procedure_class(name) for name in CATALOGUE} | {name: sweep_class(name) for name in SWEEPS}
NO_UNIT = {"nudge_share", "turns", "tolerance", "rates", "gain", "cycles"}  # shares and counts that need not be whole


@pytest.mark.parametrize("name", KINDS)
def test_every_parameter_has_a_meaning_and_every_quantity_a_unit(name: str) -> None:
    for t in told(KINDS[name]):
        assert t.unit or t.meaning, t.name
        assert t.meaning, f"{t.name}: the comment beside the field says what it is"
        if type(t.default) in (float, tuple) and t.name not in NO_UNIT:
            assert t.unit, f"{t.name} = {t.default}: expected a unit"


def test_a_comment_that_begins_with_its_unit_is_told_without_it() -> None:
    frequency = next(t for t in told(KINDS["kinematic-error"]) if t.name == "frequency")
    assert (frequency.unit, frequency.default) == ("Hz", 0.01)
    assert frequency.meaning.startswith("of the triangle")
    assert frequency.line.startswith("frequency=0.01 Hz ")


def test_a_field_over_several_lines_has_its_comment() -> None:
    tau_ext = next(t for t in told(KINDS["weigh"]) if t.name == "tau_ext")
    assert (tau_ext.unit, tau_ext.signed) == ("N·m", True)


def test_the_help_of_run_shows_units(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["run", "--help"])
    said = capsys.readouterr().out
    for words in ("tau_max=15 N·m", "rate=0.75 N·m/s", "frequency=0.01 Hz", "settle=5 s", "depths_mm=[0.15,0.3] mm"):
        assert words in said
