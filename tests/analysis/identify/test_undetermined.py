"""What the runs do not determine is named, and what stands in its place is never called measured."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.identify.fit import fit
from rig.analysis.identify.identified import Identified, _motor_inertia, identified
from rig.analysis.identify.recording import Recording, recording
from rig.analysis.identify.undetermined import NOTHING, WANTED
from rig.bench import read, twin_parameters
from rig.core.errors import DataError
from rig.evaluation.identification import gear_of, refuse_nothing
from rig.evaluation.to_identify import Opened
from rig.model import gearfile
from rig.model.gear import Gear
from rig.report.text.gear import parameter_line
from tests.analysis.identify.test_identify import Made, turning

DECLARED = {"K": 7160.0, "J_l": 0.32, "J_m": 1.1e-3, "B_m": 5e-4, "B_ml": 2.5e-3, "B_l": 0.5, "B_sp": 3.6}


@pytest.fixture(scope="module")
def gear() -> Gear:
    found: Gear = twin_parameters(read("twin").file).gear
    return replace(found, tau_s=found.tau_c)


@pytest.fixture(scope="module")
def alone(gear: Gear) -> Recording:
    found = recording(turning(gear, 310.0, 6.0))
    assert found is not None
    return found


@pytest.fixture(scope="module")
def single(alone: Recording) -> Identified:
    return identified(fit([alone], 15), {"declared": DECLARED})


@pytest.mark.slow
def test_one_run_at_one_speed_says_which_parameters_it_leaves_open(single: Identified) -> None:
    assert single.undetermined == ("J_m", "B_sp", "B_m", "B_l", "tau_c", "F_cl")
    assert all(single.parameters[name].origin != "measured" for name in single.undetermined)
    assert single.parameters["K"].origin == "measured"
    said = " ".join(single.cannot)
    assert "tau_c, B_m and B_ml: only their sum is known" in said
    assert "F_cl, B_l and the zero of the torque sensor: only their sum is known" in said


def test_friction_that_is_not_told_from_drag_is_what_the_declared_drag_leaves_never_zero(
    single: Identified, gear: Gear
) -> None:
    p = single.parameters
    assert p["tau_c"].origin == p["F_cl"].origin == "assumed"
    assert p["tau_c"].value == pytest.approx(gear.tau_c, rel=0.01)
    assert p["F_cl"].value == pytest.approx(gear.F_cl, rel=0.01)
    assert "less declared B_m and declared B_ml" in p["tau_c"].note


def test_what_is_declared_is_taken_as_declared(single: Identified) -> None:
    for name in ("J_m", "B_m", "B_ml", "B_l"):
        assert (single.parameters[name].value, single.parameters[name].origin) == (DECLARED[name], "declared")


def test_a_mode_made_with_a_declared_inertia_is_not_measured_and_has_no_interval(single: Identified) -> None:
    for name in ("omega_n", "zeta"):
        assert single.parameters[name].origin == "declared"
        assert not single.parameters[name].half > 0.0
        assert "not determined by these runs" in single.parameters[name].note


@pytest.mark.slow
def test_the_gear_file_says_it_too(single: Identified) -> None:
    file = single.gear_file("A1", True, "a test")
    first = gearfile.loads(gearfile.dumps(file), "gear.toml").cannot[0]
    assert first == (
        "Not determined by these runs: J_m, B_sp, B_m, B_l, tau_c, F_cl; what stands in their place: "
        "J_m, B_sp, B_m, B_l declared; tau_c, F_cl assumed."
    )


def test_without_a_torque_sensor_load_side_friction_is_unknown_and_not_zero(alone: Recording) -> None:
    found = identified(fit([replace(alone, tau_l=None)], 15), {"declared": DECLARED})
    assert set(WANTED) - set(found.undetermined) == set()
    assert found.parameters["F_cl"].note == NOTHING
    assert "unknown" in parameter_line("F_cl", found.parameters["F_cl"], "N·m")


def test_runs_that_determine_nothing_are_refused_and_give_no_gear(monkeypatch: pytest.MonkeyPatch) -> None:
    t = np.arange(0.0, 4.0, 1e-3)
    still = recording(Made("still", {"t": t, **dict.fromkeys(("theta_m", "theta_l", "tau_l", "tau_m"), 0.0 * t)}))
    assert still is not None
    found = identified(fit([still], 15), {"declared": DECLARED})
    with pytest.raises(DataError, match=r"nothing of the gear can be determined from what is here \(constant-torque\)"):
        refuse_nothing(found, [still])
    monkeypatch.setattr("rig.evaluation.identification.open_runs", lambda folders, say: Opened([], [still]))
    monkeypatch.setattr("rig.evaluation.identification._fitted", lambda *known: (found, None))
    with pytest.raises(DataError, match="nothing of the gear can be determined"):
        gear_of([], 15, lambda text: None)


@pytest.mark.slow
def test_both_directions_at_three_speeds_leave_nothing_open(gear: Gear) -> None:
    runs = [turning(gear, rpm, 6.0) for rpm in (150, 300, 450, -150, -300, -450)]
    found = identified(fit([r for run in runs if (r := recording(run)) is not None], 15), {"declared": DECLARED})
    assert found.undetermined == ()
    assert not any(text.startswith("Not determined") for text in found.cannot)


def test_a_damping_below_zero_is_declared_and_open_and_the_gear_file_can_be_read(single: Identified) -> None:
    assert (single.parameters["B_sp"].value, single.parameters["B_sp"].origin) == (DECLARED["B_sp"], "declared")
    assert any(sentence.startswith("B_sp cannot be told: it comes out at -") for sentence in single.cannot)
    file = gearfile.loads(gearfile.dumps(single.gear_file("A1", True, "a test")), "gear.toml")
    assert min(p.value for p in file.parameters.values()) >= 0.0


@pytest.mark.parametrize(("u", "told"), [(3.8e-4, False), (2e-6, True)])
def test_an_inertia_whose_interval_holds_zero_is_not_measured(u: float, told: bool) -> None:
    """A servo that holds the speed leaves nothing of ω̇_m but the noise of the encoder: (230 ± 760)·10⁻⁶ for 1500."""
    motor = SimpleNamespace(coefficients=np.array([2.3e-4, 0.0]), u=lambda place: u, dof=50)
    fits: Any = SimpleNamespace(motor=motor, windows=[])
    found: dict[str, gearfile.Parameter] = {}
    cannot: list[str] = []
    _motor_inertia(found, cannot, fits)
    assert ("J_m" in found) is told
    assert [text.split(":")[0] for text in cannot] == ([] if told else ["J_m cannot be told"])
