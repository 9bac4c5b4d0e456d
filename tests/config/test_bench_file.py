"""Configuration is read strictly: the sentence names file, key, value with unit, and what was expected."""

import re
import tomllib
from pathlib import Path

import pytest
import tomlkit
from hypothesis import given
from hypothesis import strategies as st

import rig
from rig.config.bench_file import BenchFile, read_bench
from rig.core.errors import UsageError

TEXT = (Path(rig.__file__).parent / "benches" / "twin.toml").read_text(encoding="utf-8")


def refusal(text: str) -> str:
    with pytest.raises(UsageError) as caught:
        read_bench(text, "bench.toml")
    message = str(caught.value)
    assert message.startswith("bench.toml")
    assert "\n" not in message
    return message


def test_a_byte_order_mark_is_no_key() -> None:
    """Editors of Windows leave one before the first character."""
    assert read_bench("\ufeff" + TEXT, "twin.toml") == read_bench(TEXT, "twin.toml")


def test_the_shipped_bench_is_valid() -> None:
    bench = read_bench(TEXT, "twin.toml")
    assert bench.gear.K == 7160.0
    assert bench.gear.N == 50.0


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('value = 7160.0, unit = "N·m/rad"', 'value = 7160.0, unit = "N·m/deg"', ["K", "7160", "N·m/deg", "N·m/rad"]),
        ("Kp =", "Kpp =", ["control.Kpp", "did you mean 'Kp'"]),
        ("[gear]", "[gaer]", ["gaer", "did you mean 'gear'"]),
        ("rate = { value = 1000.0", "rate = { value = -3.0", ["loop.rate", "-3", "Hz", "10"]),
        ("seed = 1\n", "", ["twin.seed", "missing"]),
        ("tau_c = { value = 0.30", 'tau_c = { value = "much"', ["tau_c", "much", "N·m", "number"]),
        ('output = "flexspline"', 'output = "flexpline"', ["output", "flexpline", "'flexspline'"]),
        ('from = "paper" }', 'from = "hearsay" }', ["hearsay", "catalogue"]),
        ("{ value = 50.0,", "{ vale = 50.0,", ["vale", "did you mean 'value'"]),
        ("stale_s = { value = 0.005", "stale_s = { value = nan", ["stale_s", "nan", "finite"]),
        ("speed_rpm = { value = 600.0", "speed_rpm = { value = 1e9", ["limits.speed_rpm", "rpm", "20000"]),
        ("twist_deg = { value = 0.4,", "twist_deg = { value = 400.0,", ["limits.twist_deg", "400.0 deg", "30"]),
        ("value = 10000, unit", "value = 0, unit", ["counts_per_turn", "0", "greater than 0"]),
        ("[35, -62,", "[35,", ["15 amplitudes", "14 phases"]),
        ('"hdrig.bench/1"', '"hdrig.bench/9"', ["schema", "hdrig.bench/9", "hdrig.bench/1"]),
        ("[twin]", "[twin", ["not valid TOML"]),
    ],
)
def test_a_mistake_is_one_sentence_with_everything_needed_to_mend_it(old: str, new: str, words: list[str]) -> None:
    assert old in TEXT
    message = refusal(TEXT.replace(old, new, 1))
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("gear", "3", "gear = 3: expected a table of keys such as serial, output, N"),
        ("console", "true", "console = true: expected a table of keys such as page_lost, page_lost_s"),
        ("bus", "4", "bus = 4: expected a table"),
        ("bus", "{ rig = 3 }", "bus.rig = 3: expected a table of keys such as interface, channel, bitrate"),
        ("name", "7", "name = 7: expected a text in quotes"),
    ],
)
def test_what_is_no_table_and_no_text_is_told_in_words_of_toml(key: str, value: str, said: str) -> None:
    raw = tomllib.loads(TEXT) | {key: tomllib.loads(f"x = {value}")["x"]}
    assert refusal(tomlkit.dumps(raw)).endswith(said)


def test_a_bare_number_is_allowed_and_an_integer_will_do_for_a_float() -> None:
    bare = TEXT.replace('K = { value = 7160.0, unit = "N·m/rad", from = "paper"', "K = 7000 #")
    assert read_bench(bare, "bench.toml").gear.K == 7000.0


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_with_a_sentence(text: str) -> None:
    try:
        assert isinstance(read_bench(text, "bench.toml"), BenchFile)
    except UsageError as error:
        assert str(error).startswith("bench.toml")


def test_a_bench_without_a_console_table_stops_a_run_whose_page_is_lost() -> None:
    older = re.sub(r"\[console\].*?(?=\n\[)", "", TEXT, flags=re.S)
    assert "page_lost" not in older
    console = read_bench(older, "x").console
    assert (console.page_lost, console.page_lost_s) == ("stop", 3.0)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('page_lost = "stop"', 'page_lost = "coast"', ["console.page_lost", "'continue' or 'stop'"]),
        ("page_lost_s = { value = 3.0", "page_lost_s = { value = 0.1", ["console.page_lost_s = 0.1 s", "0.5"]),
        ('page_lost = "stop"', 'page_loss = "stop"', ["console.page_loss", "page_lost"]),
    ],
)
def test_what_becomes_of_a_lost_page_is_read_strictly(old: str, new: str, words: list[str]) -> None:
    said = refusal(TEXT.replace(old, new))
    assert all(word in said for word in words), said
