"""The mapping file: every key is read, every other one is named with its nearest valid key."""

from __future__ import annotations

import re
import string
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.cli import main
from rig.core.errors import UsageError
from rig.core.kinds import KINDS
from rig.runfile.importing.mapping import SHIPPED, load_mapping, read_mapping, shipped
from rig.runfile.importing.strict import Section
from rig.runfile.importing.units import UNITS, known

from .formats import MAPPING


def refused(text: str) -> str:
    with pytest.raises(UsageError) as caught:
        read_mapping(text, "map.toml")
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_the_example_is_read_as_it_is_meant() -> None:
    mapping = read_mapping(MAPPING, "map.toml")
    assert mapping.columns == ["time", "motor", "load", "torque", "temperature"]
    assert mapping.channels["theta_m"].modulus == 65536
    assert mapping.encoders == {"motor_counts_per_rev": 4096}
    assert mapping.channels["theta_l"].sign == -1


@pytest.mark.parametrize("name", shipped())
def test_every_shipped_mapping_is_found_by_name_and_says_what_it_is(name: str) -> None:
    mapping = load_mapping(name)
    assert mapping.description
    assert mapping.source == f"{name}.toml"
    assert load_mapping(SHIPPED / f"{name}.toml") == mapping


def test_an_unknown_name_is_answered_with_the_nearest(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no mapping is called 'lara8-joint9'; did you mean 'lara8-joint"):
        load_mapping("lara8-joint9")
    with pytest.raises(UsageError, match=re.escape("cannot read the mapping")):
        load_mapping(tmp_path / "absent.toml")
    (tmp_path / "junk.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UsageError, match="not UTF-8 text"):
        load_mapping(tmp_path / "junk.toml")


def test_a_procedure_is_known_by_the_command_lines_name_too() -> None:
    dashed = MAPPING.replace('"kinematic_error"', '"kinematic-error"')
    assert dashed != MAPPING
    assert read_mapping(dashed, "map.toml").procedure == "kinematic_error"


WRONG = [
    ('schema = "hdrig.import/1"', 'schema = "hdrig.import/2"', "schema = 'hdrig.import/2'; did you mean"),
    ('schema = "hdrig.import/1"', "", "'schema' is missing"),
    ("procedure", "proceedure", "'procedure' is missing; is 'proceedure' meant for it?"),
    ('"kinematic_error"', '"kinematic-eror"', "procedure = 'kinematic-eror'; did you mean 'kinematic_error'?"),
    ("ratio = 50", 'ratio = "50"', "gear.ratio = '50': expected a number"),
    ("ratio = 50", "ratio = true", "gear.ratio = True: expected a number"),
    ("ratio = 50", "ratio = -50", "gear.ratio = -50: expected a finite number above 1"),
    ("ratio = 50", "ratio = nan", "gear.ratio = nan: expected a finite number above 1"),
    ("ratio = 50", "ration = 50", "'gear.ratio' is missing; is 'ration' meant for it?"),
    ("ratio = 50", 'ratio = 50\noutput = "flexspine"', "gear.output = 'flexspine'; did you mean 'flexspline'?"),
    ("ratio = 50", "ratio = 50\nserail = 7", "unknown key 'gear.serail'"),
    ("bits = 16", "bit = 16", "unknown key 'channels.theta_m.bit'; did you mean 'bits'?"),
    ("bits = 16", "bits = 16\nmodulus = 65536", "channels.theta_m has modulus and bits"),
    ("bits = 16", "modulus = 655.5", "channels.theta_m.modulus = 655.5: expected a whole number of counts"),
    ("bits = 16", "bits = 63", "channels.theta_m.bits = 63: expected a whole number from 1 to 62"),
    ("counts_per_turn = 4096", "", "'channels.theta_m.counts_per_turn' is missing"),
    ("sign = -1", "sign = 0", "channels.theta_l.sign = 0: expected 1 or -1"),
    ("sign = -1", "scale = 0", "channels.theta_l.scale = 0.0: expected a number other than 0"),
    ("sign = -1", "bits = 12", "channels.theta_l.bits = 12: expected modulus in deg"),
    ("sign = -1", "counts_per_turn = 9", "channels.theta_l.counts_per_turn = 9: expected none with unit = 'deg'"),
    ('unit = "deg"', 'unit = "degs"', "unit = 'degs' is not known; expected a unit of angle: did you mean 'deg'?"),
    ('unit = "deg"', 'unit = "ms"', "channels.theta_l.unit = 'ms' is a unit of time; expected a unit of angle"),
    ('unit = "ms"', 'unit = "ms"\nsign = 1', "unknown key 'channels.t.sign'"),
    ('unit = "ms"', 'unit = "ms"\nduplicates = "keep"', "channels.t.duplicates = 'keep'"),
    ('column = "time"', 'sum = [{column = "time"}]', "channels.t.sum: expected a column"),
    ('column = "torque"', 'colum = "torque"', "'channels.tau_l.column' is missing; is 'colum' meant for it?"),
    ('column = "torque"', 'column = "torque"\nsum = []', "channels.tau_l has column and sum; expected one of them"),
    ('column = "torque"', 'column = "motor"', "channels.tau_l: column 'motor' is already theta_m; expected"),
    ('column = "torque"', "sum = []", "channels.tau_l.sum: expected at least one term"),
    ('column = "torque"', 'sum = [{column = "torque", scal = 2}]', "tau_l.sum[0].scal'; did you mean 'scale'?"),
    ('column = "load"', 'sum = [{column = "a"}, {column = "b"}]\nzero = 3', "channels.theta_l is a sum; modulus, bits"),
    ('meaning = "housing"', "", "'channels.temperature.meaning' is missing; 'temperature' is no standard channel"),
    ("[channels.tau_l]", "[channels.tau_L]", "'tau_L' is no standard channel (did you mean 'tau_l'?)"),
    ("[channels.temperature]", "[channels.flags]", "channels.flags cannot be imported"),
    ("[channels.temperature]", '[channels."a b"]', "channels.a b is no name for a channel"),
    ("[gear]", '[csv]\ndelimiter = ",,"\n[gear]', "csv.delimiter = ',,': expected one character"),
    ("[gear]", '[csv]\ndecimal = ","\n[gear]', "csv.delimiter = ',': expected another character than decimal"),
    ("[gear]", '[csv]\ndelimeter = ";"\ndecimal = ","\n[gear]', "unknown key 'csv.delimeter'; did you mean 'deli"),
    ("[gear]", "[csv]\nskip_lines = 2\n[gear]", "unknown key 'csv.skip_lines'; did you mean 'skip_rows'?"),
    ("[gear]", "[conditions]\noutput_locked = 1\n[gear]", "conditions.output_locked = 1: expected true or false"),
    ("[gear]", "[conditions]\ntau_exp = 1\n[gear]", "unknown key 'conditions.tau_exp'; did you mean 'tau_ext'?"),
    ("[gear]", '[accept]\nratios = "so"\n[gear]', "unknown key 'accept.ratios'; did you mean 'ratio'?"),
    ("[gear]", "[encoders]\nmotor_counts_per_rev = 4097\n[gear]", "motor_counts_per_rev = 4097 but channels.theta_m"),
    ("[gear]", "[declared]\nK = 0\n[gear]", "declared.K = 0: expected a finite number above 0"),
    ("[gear]", "[chanels]\n[gear]", "unknown key 'chanels'"),
    ("[gear]", "[gear", "is not valid TOML"),
]  # fmt: skip


@pytest.mark.parametrize(("wrong", "right", "said"), WRONG)
def test_what_is_not_a_mapping_is_named(wrong: str, right: str, said: str) -> None:
    assert wrong in MAPPING
    assert said in refused(MAPPING.replace(wrong, right, 1))


def test_a_column_may_be_two_channels_where_it_is_said_why_and_be_counts_beside_their_angle() -> None:
    twice = MAPPING.replace('column = "torque"', 'column = "motor"')
    assert read_mapping(f'{twice}[accept]\ncolumn = "a dry run of the wiring"\n', "map.toml").columns[1] == "motor"
    counts = f'{MAPPING}[channels.counts_m]\ncolumn = "motor"\n'
    found = read_mapping(counts, "map.toml").channels
    assert found["counts_m"].terms == found["theta_m"].terms


def test_a_mapping_without_an_angle() -> None:
    said = refused(re.sub(r"\[channels\.theta_.*?(?=\[channels\.t)", "", MAPPING, flags=re.DOTALL))
    assert said == "map.toml maps no angle; expected [channels.theta_m] or [channels.theta_l]"


SECTIONS = ["", "gear", "csv", "conditions", "encoders", "declared", "accept", "channels.theta_m", "channels.t"]


@given(st.sampled_from(SECTIONS), st.text(string.ascii_lowercase + "_", min_size=1, max_size=12))
def test_no_key_is_ever_overlooked(section: str, key: str) -> None:
    """A key either changes what is read, or is refused by its name."""
    raw = tomllib.loads(MAPPING)
    table = raw
    for part in section.split(".") if section else ():
        table = table.setdefault(part, {})
    if key in table:
        return
    head, body = ("", MAPPING) if not section else (f"[{section}]\n", MAPPING)
    added = f"{head}{key} = [[1]]\n"
    text = MAPPING.replace(head, added, 1) if head and head in MAPPING else (added + body if not head else body + added)
    with pytest.raises(UsageError) as caught:
        read_mapping(text, "map.toml")
    whole = f"{section}.{key}" if section else key
    assert whole in str(caught.value) or key == "sum"  # beside `column`, both are named


def test_every_key_that_is_read_is_named_in_the_help(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    read: set[str] = set()
    done = Section.done

    def noted(section: Section) -> None:
        read.update(section._known)
        done(section)

    monkeypatch.setattr(Section, "done", noted)
    read_mapping(MAPPING, "map.toml")
    with pytest.raises(SystemExit):
        main(["import", "--help"])
    words = set(re.findall(r"\w+", capsys.readouterr().out))
    assert read >= {"skip_rows", "holes", "modulus", "file_unit", "tau_ext"}
    assert read - {"channels"} <= words


def test_a_procedure_there_is_not_names_all_there_are() -> None:
    said = refused(MAPPING.replace('"kinematic_error"', '"foo"'))
    assert all(kind in said for kind in KINDS)


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_in_one_sentence(text: str) -> None:
    with pytest.raises(UsageError):
        read_mapping(text, "map.toml")


@pytest.mark.parametrize(("spelt", "word"), [
    ("Nm", "N·m"), ("N*m", "N·m"), ("N.m", "N·m"), ("N m", "N·m"), ("mNm", "mN·m"), ("mN*m", "mN·m"), ("[N·m]", "N·m"),
    ("°", "deg"), ("degrees", "deg"), ("µs", "us"), ("\u03bcs", "us"), ("rev", "turns"), ("1/min", "rpm"),
    ("oz-in", None), ("ozf-in", "ozf·in"), ("N\u22c5m", "N·m"), ("V", None), ("", None), ("MN·m", None), ("mnm", None),
])  # fmt: skip
def test_units_are_known_however_they_are_spelt(spelt: str, word: str | None) -> None:
    found = known(spelt)
    assert (found.word if found else None) == word


def test_imperial_units_are_what_their_definitions_give() -> None:
    pound, gravity, foot = 0.45359237, 9.80665, 0.3048  # kg, m/s², m: exact by definition
    assert UNITS["lbf·ft"].factor == pytest.approx(pound * gravity * foot, rel=1e-15)
    assert UNITS["lbf·in"].factor == pytest.approx(pound * gravity * foot / 12, rel=1e-15)
    assert UNITS["ozf·in"].factor == pytest.approx(pound / 16 * gravity * foot / 12, rel=1e-15)


def test_a_serial_no_folder_could_be_called_by_is_refused() -> None:
    text = MAPPING.replace('serial = "SN7"', f'serial = "{"7" * 400}"')
    assert "expected at most 64 characters, these are 400" in refused(text)
