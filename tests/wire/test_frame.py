"""Bits on the wire, against an implementation that goes the long way round: as text."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.wire.frame import EXTENDED, REMOTE, Frame


def stuffed_length(bits: str) -> int:
    """Length of `bits` once a bit of the other level stands behind every five equal ones."""
    done = ""
    for bit in bits:
        done += bit
        if re.search(r"(00000|11111)$", done):
            done += "1" if bit == "0" else "0"
    return len(done)


def crc15(bits: str) -> str:
    """Remainder of the division by x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1, by long division."""
    divisor = "1100010110011001"
    work = list(bits + "0" * 15)
    for start in range(len(bits)):
        if work[start] == "1":
            for place, bit in enumerate(divisor):
                work[start + place] = "1" if work[start + place] != bit else "0"
    return "".join(work[-15:])


def by_hand(identifier: int, data: bytes) -> int:
    body = f"0{identifier:011b}000{len(data):04b}" + "".join(f"{byte:08b}" for byte in data)
    return stuffed_length(body + crc15(body)) + 10 + 3


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 0x7FF), st.binary(max_size=8))
def test_bits_are_those_of_the_frame_written_out(identifier: int, data: bytes) -> None:
    assert Frame(identifier, data).bits == by_hand(identifier, data)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 0x7FF), st.binary(max_size=8))
def test_bits_lie_between_none_stuffed_and_all_that_can_be(identifier: int, data: bytes) -> None:
    least = 47 + 8 * len(data)
    assert least <= Frame(identifier, data).bits <= least + (34 + 8 * len(data) - 1) // 4


def test_eight_bytes_that_never_repeat_a_level_are_111_bits() -> None:
    assert Frame(0x2AA, b"\x55" * 8).bits == 111


def test_a_long_identifier_costs_20_bits_and_a_remote_frame_carries_no_data() -> None:
    assert Frame(0x0AAAAAAA | EXTENDED, b"\x55" * 8).bits >= 131
    assert Frame(0x701 | REMOTE, bytes(1)).bits <= 55


@pytest.mark.parametrize(
    ("winner", "loser"),
    [(0x080, 0x181), (0x181, 0x281), (0x181, 0x181 | REMOTE), (0x181, 0x181 << 18 | EXTENDED)],
)
def test_the_lower_identifier_wins_the_bus(winner: int, loser: int) -> None:
    assert Frame(winner).rank < Frame(loser).rank
