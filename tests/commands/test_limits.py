"""--limit: the words of an operator to the limits a run is judged against."""

import json
from pathlib import Path

import pytest

from rig.cli import main
from rig.commands.limits import limits_of, refuse_unanswerable
from rig.core.errors import UsageError
from rig.procedures import CATALOGUE, procedure_class
from tests.commands.made_run import made_run

pytestmark = pytest.mark.usefixtures("no_pictures")


@pytest.mark.parametrize(
    ("said", "limits"),
    [
        ("peak-to-peak=60 arcsec", {"kinematic_error_peak_to_peak": {"upper": 60.0, "unit": "arcsec"}}),
        ("K1=7000..", {"stiffness_K1": {"lower": 7000.0}}),
        ("C_2=39.5..40.5", {"fourier_amplitude_2": {"lower": 39.5, "upper": 40.5}}),
        ("drift=-1e-2..", {"drift": {"lower": -0.01}}),
    ],
)
def test_a_limit_is_read_as_upper_lower_or_both(said: str, limits: dict[str, object]) -> None:
    assert limits_of([said]) == limits


@pytest.mark.parametrize("said", ["K1", "=3", "K1=", "K1=..", "K1=nan", "K1=8..7", "K1=60arcsec", "K1=1...2"])
def test_what_is_no_limit_is_refused_with_the_form_expected(said: str) -> None:
    with pytest.raises(UsageError, match=r"NAME=LOWER\.\.UPPER"):
        limits_of([said])


def test_two_limits_of_one_figure_are_refused_by_whatever_names() -> None:
    with pytest.raises(UsageError, match="'kinematic_error_peak_to_peak=100': kinematic_error_peak_to_peak was given"):
        limits_of(["peak-to-peak=60", "kinematic_error_peak_to_peak=100"])


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("peak-to-peek=60 arcsec", "no figure is called 'peak-to-peek'; did you mean 'peak-to-peak'?"),
        ("xyz=3", "expected peak-to-peak, C_2, K1, hysteresis-loss, friction, or the name of a figure"),
        ("peak-to-peak=60 arcsek", "60 arcsek is no size of peak-to-peak, for 'arcsek' is no unit of it"),
        ("peak-to-peak=60 N·m", "expected a number in arcsec, rad, mrad, deg, arcmin"),
        ("revolutions_forward=5.. m", "expected a number in no unit"),
        ("peak-to-peak=-5", "-5 arcsec, and peak-to-peak is never below zero; expected 0 arcsec or more"),
        ("C_17=3", "no run has a figure C_17; of the orders expected one of C_1, C_2, C_4, C_6, C_8, C_10"),
        ("fourier_amplitude_3=3", "no run has a figure fourier_amplitude_3; of the orders expected one of C_1, C_2,"),
        ("C_2=-1..", "-1 arcsec, and C_2 is never below zero"),
        ("revolutions_forward=-1..", "-1, and revolutions_forward is never below zero; expected 0 or more"),
    ],
)
def test_a_limit_no_run_can_be_judged_by_is_refused_before_anything_is_read_or_written(
    tmp_path: Path, said: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    run, out = tmp_path / "run", tmp_path / "out"
    run.mkdir()
    (run / "manifest.json").write_text("{}")  # no run at all: it is not got so far
    for verb in (["analyse", str(run)], ["run", "kinematic-error"]):
        assert main([*verb, "--out", str(out), "--limit", said]) == 2
        assert words in capsys.readouterr().err
    assert not out.exists()
    assert [path.name for path in run.iterdir()] == ["manifest.json"]


def test_any_order_whose_amplitude_is_a_figure_can_have_a_limit_and_any_other_lose_one() -> None:
    assert limits_of(["C_4=10"]) == {"fourier_amplitude_4": {"upper": 10.0}}
    assert limits_of(["C_17=none"]) == {"fourier_amplitude_17": None}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("limit", "code"),
    [("120 arcsec", 0), ("60 arcsec", 1), ("1 arcmin", 1), ("0.6 mrad", 0), ("80..", 0)],
)
def test_analyse_judges_by_the_limit_it_is_given_and_leaves_the_manifest_alone(
    tmp_path: Path, limit: str, code: int
) -> None:
    folder = made_run(tmp_path / "run")
    before = (folder / "manifest.json").read_bytes()
    assert main(["analyse", str(folder), "--out", str(tmp_path / "out"), "--limit", f"peak-to-peak={limit}"]) == code
    assert (folder / "manifest.json").read_bytes() == before


@pytest.mark.slow
def test_a_sweep_of_many_runs_is_not_judged_by_one_limit(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "load-sweep", "--dry-run", "--limit", "peak-to-peak=60"]) == 2
    assert "hdrig analyse --limit" in capsys.readouterr().err


def test_a_campaign_says_what_judges_its_runs(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["campaign", "quick", "--dry-run", "--limit", "peak-to-peak=60"])
    said = capsys.readouterr()
    assert "unrecognized arguments: --limit peak-to-peak=60; a limit judges runs once they are made" in said.err
    assert "hdrig analyse CAMPAIGN" in said.err
    assert not said.out
    with pytest.raises(SystemExit, match="0"):
        main(["campaign", "--help"])
    assert "--limit" not in capsys.readouterr().out  # it is none of its options


@pytest.mark.slow
def test_a_run_judged_again_says_what_the_verdict_was_and_by_which_limit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = str(made_run(tmp_path / "run"))
    told = []
    for limit in ([], ["--limit", "peak-to-peak=2 arcmin"], ["--limit", "peak-to-peak=60 arcsec"]):
        main(["analyse", run, *limit])
        told.append(next((line for line in capsys.readouterr().out.splitlines() if "judged before" in line), ""))
    name = "Kinematic error, peak to peak at most"
    assert told == [
        "",
        f"judged before: no limit set; now PASS by {name} 2 arcmin (120 arcsec)",
        f"judged before: PASS by {name} 2 arcmin (120 arcsec); now FAIL by {name} 60 arcsec",
    ]
    kept = json.loads((tmp_path / "run" / "result.json").read_text())
    assert [f["verdict"] for f in kept["former"]] == ["MEASURED", "PASS"]
    assert kept["limits"] == {"kinematic_error_peak_to_peak": f"{name} 60 arcsec"}
    assert f"Judged before: no limit set, then PASS by {name} 2 arcmin" in (tmp_path / "run/report.html").read_text()


@pytest.mark.slow
def test_of_many_runs_a_limit_judges_those_made_for_its_figure_and_checks_are_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for place, procedure in (("a", "kinematic_error"), ("b", "other"), ("checks/c", "other")):
        manifest = made_run(tmp_path / "camp" / place) / "manifest.json"
        manifest.write_text(json.dumps(json.loads(manifest.read_text()) | {"procedure": procedure}))
    (tmp_path / "camp" / "campaign.json").write_text("{}")
    limit = ["--limit", "peak-to-peak=120 arcsec", "--out", str(tmp_path / "out")]
    assert main(["analyse", str(tmp_path / "camp"), *limit]) == 0
    said = capsys.readouterr()
    assert "left out: 1 check between the runs; name one to analyse it" in said.err
    assert said.out.count("PASS") == 1
    assert said.out.count("not judged by kinematic_error_peak_to_peak, for which such a run is not made") == 1
    assert main(["analyse", str(tmp_path / "camp" / "b"), *limit]) == 0  # by itself it is asked, and has the figure
    assert "PASS" in capsys.readouterr().out
    assert main(["analyse", str(tmp_path / "camp" / "checks" / "c"), "--out", str(tmp_path / "one")]) == 0
    assert "left out" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("procedure", "limit", "words"),
    [
        (
            "friction",
            "peak-to-peak=60",
            "a friction run gives no figure kinematic_error_peak_to_peak; expected one of co",
        ),
        (
            "coast-down",
            "friction=0.5",
            "a coast-down run gives no figure coulomb; expected one of inertia_at_motor, cou",
        ),
        ("kinematic-error", "K1=7000..", "a kinematic-error run gives no figure stiffness_K1; expected one of kinemat"),
        (
            "held-standstill",
            "C_2=9",
            "a held-standstill run gives no figure fourier_amplitude_2; expected one of noise",
        ),
    ],
)
def test_a_run_is_not_made_to_be_judged_by_what_it_does_not_measure(
    tmp_path: Path, procedure: str, limit: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", procedure, "--out", str(tmp_path / "out"), "--limit", limit]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("more", [[], ["--dry-run"]])
@pytest.mark.parametrize("procedure", [name for name in CATALOGUE if procedure_class(name).answers])
def test_a_run_that_answers_in_a_sentence_is_not_judged_by_a_limit(
    tmp_path: Path, procedure: str, more: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    """It moved, and nothing was judged."""
    assert main(["run", procedure, "--out", str(tmp_path / "out"), "--limit", "peak-to-peak=5", *more]) == 2
    said = capsys.readouterr()
    words = f"a {procedure} run says what it found in a sentence and gives no figure to limit; expected no limit"
    assert said.err == f"hdrig: --limit: {words}\n"
    assert not said.out
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("procedure", "limit"),
    [("kinematic-error", "C_4=10"), ("stiffness-lock", "hysteresis-loss=1"), ("friction", "friction=0.5"),
        ("skew", "latch_skew_load=5.."), ("compensated", "peak-to-peak=60"), ("held-standstill", "noise_tau_l=0.1")],
)  # fmt: skip
def test_a_run_may_be_judged_by_what_it_measures_or_might(procedure: str, limit: str) -> None:
    refuse_unanswerable(procedure_class(procedure), procedure, limits_of([limit]))


def test_one_run_is_not_judged_by_what_it_is_not_made_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Neither before it is made nor after; a limit that is lifted may be any."""
    run = made_run(tmp_path / "good")
    assert main(["analyse", str(run), "--limit", "K1=7000.."]) == 2
    assert "a kinematic-error run gives no figure stiffness_K1; expected one of" in capsys.readouterr().err
    assert not (run / "result.json").exists()
    assert main(["analyse", str(run), "--limit", "K1=none"]) == 0


@pytest.mark.slow
def test_one_run_is_not_judged_by_a_figure_it_turns_out_not_to_have(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It was kept with the run, and from then on no analysis of it could settle anything."""
    run = made_run(tmp_path / "run")
    assert main(["analyse", str(run)]) == 0
    before = {path.name: path.read_bytes() for path in run.iterdir()}
    capsys.readouterr()
    for limit, words in (
        ("torsion_span=3", "this run has no figure torsion_span; expected one of kinematic_error_peak"),
        (
            "C_10=3",
            "this run has no figure fourier_amplitude_10; expected one of fourier_amplitude_1, fourier_amplitude_",
        ),
    ):
        assert main(["analyse", str(run), "--limit", limit, "--limit", "peak-to-peak=60 arcsec"]) == 2
        said = capsys.readouterr()
        assert f"hdrig: {run}: --limit: {words}" in said.err
        assert not said.out
        assert {path.name: path.read_bytes() for path in run.iterdir()} == before


@pytest.mark.slow
def test_a_limit_that_a_run_was_given_for_a_figure_it_does_not_have_can_be_lifted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = made_run(tmp_path / "run", {"limits": {"fourier_amplitude_17": {"upper": 3.0}}})
    assert main(["analyse", str(run)]) == 6
    for _ in range(2):
        assert main(["analyse", str(run), "--limit", "C_17=none"]) == 0
    capsys.readouterr()
    assert main(["analyse", str(run)]) == 0
    assert "no limit set" in capsys.readouterr().out
