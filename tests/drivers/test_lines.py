"""Lines out of a byte stream, whatever is torn, glued or garbage."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.ascii_torque import decode_line
from drivers.lines import Lines
from drivers.qsb import decode_answer


def test_the_first_piece_may_be_a_tail_and_is_not_believed():
    lines = Lines(48)
    assert lines.feed(b"2.345 Nm\r\n-1.000 Nm\r\n") == [b"-1.000 Nm"]
    assert lines.dropped == 1


def test_a_torn_line_waits_for_its_rest():
    lines = Lines(48)
    lines.feed(b"\r\n")
    assert lines.feed(b"-12.3") == []
    assert lines.feed(b"45 Nm\r\n") == [b"-12.345 Nm"]


def test_glued_lines_come_apart():
    lines = Lines(48)
    lines.feed(b"\n")
    assert lines.feed(b"1.0 Nm\r\n2.0 Nm\n3.0 Nm\r") == [b"1.0 Nm", b"2.0 Nm", b"3.0 Nm"]


def test_after_a_flood_without_ends_the_next_line_but_one_is_believed():
    lines = Lines(48)
    lines.feed(b"\n")
    assert lines.feed(b"x" * 60) == []
    assert lines.feed(b"7 Nm\r\n8.0 Nm\r\n") == [b"8.0 Nm"]


@given(st.lists(st.binary(max_size=60), max_size=40))
def test_any_bytes_give_lines_no_longer_than_allowed_and_keep_no_more_than_that(pieces: list[bytes]):
    lines = Lines(48)
    for piece in pieces:
        assert all(0 < len(line) <= 48 for line in lines.feed(piece))
        assert len(lines._rest) <= 48


@pytest.mark.parametrize(
    ("line", "tau"),
    [
        (b"-12.345 Nm", -12.345),
        (b"+0.5 N.m", 0.5),
        (b"4.285 Nm", 4.285),
        (b" 3 Nm ", 3.0),
        (b"1.5 Nm*24", None),
        ("2 N·m".encode(), 2.0),
    ],
)
def test_a_torque_is_a_number_with_its_unit(line: bytes, tau: float | None):
    assert decode_line(line) == tau


@pytest.mark.parametrize(
    "line",
    [b"12.3", b"12.3 lbf.in", b"", b"1021.15", b"12..3 Nm", b"nan Nm", b"1e3 Nm", b"--1 Nm", b"12 Nmm", b"1 kNm"],
)
def test_what_has_no_unit_or_another_one_says_no_torque(line: bytes):
    assert decode_line(line) is None


def test_a_checksum_is_believed_over_the_text():
    # exclusive or of "1.5 Nm": 31 2E 35 20 4E 6D = 29h
    assert decode_line(b"1.5 Nm*29") == 1.5
    assert decode_line(b"1.7 Nm*29") is None


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        (b"r0E0000A1B2!", ("r", 0x0E, 0xA1B2)),
        (b"s0EFFFFFFFF!", ("s", 0x0E, 0xFFFFFFFF)),
        (b"w0000000003 00001234!", ("w", 0x00, 3)),
        (b"e00000003!", None),
        (b"r0E0000A1B", None),
    ],
)
def test_an_answer_of_the_encoder_adapter(line: bytes, answer: tuple[str, int, int] | None):
    assert decode_answer(line) == answer
