"""The command line: light to start, one sentence for every mistake, the documented exit codes."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from rig.cli import main
from rig.commands import CATALOGUE

HEAVY = {"numpy", "scipy", "numba", "pyarrow", "pydantic", "matplotlib", "jinja2", "rich", "tomlkit", "can", "rerun"}


def hdrig(*args: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "rig.cli", *args], capture_output=True, text=True, timeout=120)


def test_help_imports_nothing_heavy() -> None:
    code = "import sys, rig.cli\ntry: rig.cli.main(['--help'])\nexcept SystemExit: pass\n"
    code += "import json; print(json.dumps(sorted(m for m in sys.modules if '.' not in m)))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert not HEAVY & set(json.loads(out.splitlines()[-1]))


def test_help_names_every_verb_and_no_arguments_means_help() -> None:
    for args in (["--help"], []):
        done = hdrig(*args)
        assert done.returncode == 0
        for verb in CATALOGUE:
            assert f"\n  {verb} " in done.stdout


def test_help_says_of_exit_codes_what_the_readme_says(capsys: pytest.CaptureFixture[str]) -> None:
    readme = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
    said = " ".join(readme.partition("\nExit codes: ")[2].partition(".\n")[0].split()).replace(" ·", ",")
    with pytest.raises(SystemExit):
        main(["--help"])
    assert said.startswith("0 pass, 1 ")
    assert said in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize("verb", [["run", "standstill"], ["campaign", "quick"]])
def test_a_dry_run_says_of_a_twin_over_a_wire_that_it_is_simulated(
    verb: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*verb, "--dry-run", "--bench", "twin-can"]) == 0
    assert " on twin-can (SIMULATED)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("gains", "code", "said"),
    [
        ("control.Kp=3.0", 0, "the loop comes to rest with up to 4.35 times these, by the declared gear"),
        ("control.Kp=60.0", 3, "the loop would swing up by itself, by the declared gear"),
    ],
)
def test_a_dry_run_says_by_what_the_gains_may_be_multiplied(
    gains: str, code: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "kinematic-error", "--dry-run", "--set", gains]) == code
    assert f"\ngains       {said}\n" in capsys.readouterr().out


@pytest.mark.parametrize("verb", CATALOGUE)
def test_every_verb_explains_itself(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main([verb, "--help"])
    assert end.value.code == 0
    assert CATALOGUE[verb][1].split(":")[0][:20] in capsys.readouterr().out.replace("\n", " ")


def test_no_word_is_offered_for_no_can_bus_that_would_be_taken_for_the_name_of_one(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit):
        main(["devices", "--help"])
    said = " ".join(capsys.readouterr().out.split())
    assert "none:" not in said
    assert "can0 for example; left out: serial ports alone" in said


@pytest.mark.slow
@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["lst"], ["lst", "list"]),
        (["run"], ["PROCEDURE"]),
        (["run", "kinematic"], ["no procedure called 'kinematic'", "did you mean 'kinematic-error'"]),
        (["run", "kinematic-error", "--bench", "twn"], ["no bench called 'twn'", "did you mean 'twin'"]),
        (["run", "kinematic-error", "--bench", "absent.toml"], ["absent.toml", "No such file"]),
        (["run", "kinematic-error", "--set", "control.Kq=3"], ["control.Kq", "did you mean"]),
        (["run", "kinematic-error", "--set", "control.Kp=high"], ["Kp", "high", "N·m/rad", "number"]),
        (["run", "kinematic-error", "--set", "control.Kp"], ["expected key=value"]),
        (["run", "kinematic-error", "--with", "cycle=2"], ["no parameter 'cycle'", "did you mean 'cycles'"]),
        (["run", "kinematic-error", "--with", "cycles=-2"], ["cycles = -2", "more than 0"]),
        (["run", "kinematic-error", "--with", "cycles=many"], ["cycles = many", "finite number"]),
        (["run", "kinematic-error", "--with", "cycles=nan"], ["cycles = nan", "finite number"]),
        (["run", "kinematic-error", "--with", "cycles=0.25"], ["cycles = 0.25", "multiple of 0.5"]),
        (["run", "kinematic-error", "--with", "frequency=1e-300"], ["endless", "frequency = 1e-300 Hz"]),
        (
            ["run", "kinematic-error", "--dry-run", "--with", "cycles=1e9", "--with", "amplitude_deg=700"],
            ["with cycles = 1e+09 (by default 2) is endless", "s, expected above 0 and at most 2678400 s (31 days)"],
        ),
        (["run", "kinematic-error", "--dry-run", "--with", "frequency=1e-9"], ["frequency = 1e-09 Hz (by default "]),
        (["run", "constant-torque", "--dry-run", "--with", "settle=1e9"], ["settle = 1e+09 s (by default 5 s)"]),
        (["run", "standstill", "--dry-run", "--with", "duration=1e9"], ["duration = 1e+09 s", "would take 1e+09 s"]),
        (["run", "constant-torque", "--dry-run", "--with", "speed_rpm=1e9"], ["speed_rpm = 1e+09 rpm (by default 310"]),
        (["run", "kinematic-error", "--with", "cycles=1", "--with", "cycles=2"], ["cycles is given already, as 1"]),
        (
            ["run", "kinematic-error", "--with", "amplitude_deg=720 deg"],
            ["amplitude_deg = 720 deg: expected a number in deg, without the unit, for example "],
        ),
        (
            ["run", "kinematic-error", "--with", "amplitude_deg=9rad"],
            ["amplitude_deg = 9rad: expected a number in deg"],
        ),
        (["run", "friction", "--with", "speeds_rpm=0,5"], ["speeds_rpm = 0,5: expected speeds above 0 rpm, divided"]),
        (["run", "jog", "--with", "turns=0"], ["expected up to 10 turns of the motor, either way, and not 0"]),
        (
            ["run", "full-turn", "--with", "turns=1e6"],
            ["turns = 1000000.0: expected a whole number in digits alone, 1000000, for"],
        ),
        (["run", "full-turn", "--with", "turns=2.5"], ["turns = 2.5: expected a whole number, for example 1"]),
        (["run", "kinematic-error", "--with", "frequency=0,01"], ["frequency = 0,01: expected a decimal point, 0.01"]),
        (["run", "kinematic-error", "--with", "amplitude_deg=1,440"], ["1.440, or no comma between thousands, 1440"]),
        (
            ["run", "standstill", "--set", "loop.rate=-1"],
            ["loop.rate = -1.0 Hz: expected greater than or equal to 10 Hz"],
        ),
        (["run", "standstill", "--set", "limits.torque=5 Nm"], ["limits.torque = '5 Nm': expected a number in N·m"]),
        (["run", "jog", "--clock", "virtual", "--bench", "twin-can", "--dry-run"], ["virtual clock exists only on"]),
        (
            ["run", "jog", "--set", "gear.N=-50"],
            ["hdrig: --set gear.N=-50 in ", "gear.N = -50.0: expected greater than 1"],
        ),
        (["run", "jog", "--seed", "abc"], ["--seed: 'abc': expected a whole number, 0 or more; see hdrig run --help"]),
        (["demo", "--seed", "-1"], ["--seed: '-1': expected a whole number, 0 or more; see hdrig demo --help"]),
        (["simulate", "x", "--load", "abc"], ["argument --load: 'abc': expected a number"]),
        (["campaign", "quick", "--skip", "a"], ["argument --skip: 'a': expected whole numbers, for example 3,7"]),
        (["run", "jog", "--dryrun"], ["arguments: --dryrun; did you mean --dry-run? See hdrig run --help"]),
        (["run", "jog", "--dryrun=1"], ["did you mean --dry-run? See"]),
        (["run", "jog", "--qqqqq"], ["unrecognized arguments: --qqqqq; see hdrig run --help"]),
        (["list", "--format", "json"], ["unrecognized arguments: --format", "; see hdrig list --help"]),
        (
            ["run", "stiffness-lock", "--with", "cycles=1,hold=2"],
            ["cycles = 1,hold=2: expected one parameter at a time, cycles=1 and then hold=2 by itself"],
        ),
        (["tune", "--write", "nowhere/x.toml"], ["there is no folder nowhere; name another place with --write"]),
        (["analyse", "nowhere"], ["nowhere", "does not exist"]),
        (["recover", "nowhere"], ["nowhere", "does not exist"]),
    ],
)
def test_a_wrong_command_line_is_one_sentence_and_exit_2_and_writes_nothing(
    args: list[str],
    words: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    try:
        code = main(args)
    except SystemExit as end:
        code = int(end.code or 0)
    out, err = capsys.readouterr()
    assert code == 2
    assert out == ""
    assert err.startswith("hdrig: ")
    assert err.count("\n") == 1
    for word in words:
        assert word in err
    assert list(tmp_path.iterdir()) == []


def test_the_folder_of_a_campaign_in_place_of_a_plan_is_told_how_it_is_gone_on_with(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "0718-campaign-quick"
    folder.mkdir()
    (folder / "campaign.json").write_text("{}")
    for named in (str(folder), folder.name):
        assert main(["campaign", named]) == 2
        said = capsys.readouterr().err
        expected = f"{named} is the folder of a campaign, expected a plan; hdrig campaign --resume {named} goes on"
        assert said.startswith(f"hdrig: {expected}")
        assert said.count("\n") == 1


def test_a_dry_run_prints_the_margins_and_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", "kinematic-error", "--dry-run"]) == 0
    out = capsys.readouterr().out
    for word in ("SIMULATED", "201.0 s", "1440 of 144000 deg", "9.6 of 600 rpm", "margin", "MB", " J "):
        assert word in out
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("assignment", "word"),
    [("amplitude_deg=200000", "200000 deg of motor travel"), ("frequency=1.0", "960 rpm of motor")],
)
def test_what_the_bench_does_not_allow_is_refused_before_anything_moves(
    assignment: str, word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", "kinematic-error", "--with", assignment]) == 3
    assert word in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_the_formats_offered_are_those_there_are() -> None:
    from rig.commands.export import FORMATS as OFFERED
    from rig.runfile.export import FORMATS

    assert set(OFFERED) == set(FORMATS)


def test_the_mapping_shown_by_import_help_works(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from rig.commands.import_ import EXAMPLE

    lines = [line[2:] for line in EXAMPLE.splitlines() if line.startswith("  ")]
    (tmp_path / "map.toml").write_text("\n".join(lines), encoding="utf-8")
    rows = ["Time,motor,load"]
    for k in range(2000):
        theta_m = 0.02 * k
        theta_l = theta_m / 50 - 1e-4 * math.sin(2 * theta_m)
        rows.append(f"{4.0 * k},{int(theta_m / (2 * math.pi) * 10000)},{-math.degrees(theta_l):.6f}")
    (tmp_path / "own.csv").write_text("\n".join([*rows, ""]))
    assert main(["import", str(tmp_path / "own.csv"), "--map", str(tmp_path / "map.toml"), "--out", str(tmp_path)]) == 0
    said = capsys.readouterr()
    assert "SN0042" in said.out
    assert len(said.out.splitlines()) == 1, "the folder alone, for scripts"
    assert "own.csv: 2000 rows, 7.996 s" in said.err
    assert "gear.ratio = 50" in said.err


@pytest.mark.slow
def test_what_a_proof_on_the_twin_found_says_that_it_is_simulated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "sign-and-scale", "--out", str(tmp_path)]) == 0
    first, figures, *_ = capsys.readouterr().out.splitlines()
    assert first.startswith("SIMULATED ")
    assert figures.startswith("ratio ")
