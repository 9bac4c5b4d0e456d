"""Bits of a CAN frame up to the end of its CRC, compiled: this runs for every frame.

Compiled functions that call each other stand in one file, as in sim/kernel.py.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

CRC = 0x4599  # x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1      [iso11898]
Progress = tuple[int, int, int, int]  # bits so far with stuffing, last level, length of its run, CRC


@njit(cache=True)
def append(state: Progress, value: int, width: int) -> Progress:
    """Send `width` bits of `value`."""
    count, level, run, crc = state
    for place in range(width - 1, -1, -1):
        bit = (value >> place) & 1
        turn = bit ^ ((crc >> 14) & 1)
        crc = (crc << 1) & 0x7FFF
        if turn:
            crc ^= CRC
        count += 1
        run = run + 1 if bit == level else 1
        level = bit
        if run == 5:  # five equal levels: the sixth is stuffed, of the other level
            count += 1
            level, run = 1 - level, 1
    return count, level, run, crc


@njit(cache=True)
def wire_bits(identifier: int, extended: int, remote: int, data: npt.NDArray[np.uint8]) -> int:
    """Bits from start of frame to the end of the CRC with stuff bits      [iso11898]"""
    state = append((0, 1, 0, 0), 0, 1)  # start of frame; the bus was recessive, its run does not count
    if extended:
        state = append(state, identifier >> 18, 11)
        state = append(state, 3, 2)  # SRR and IDE, recessive
        state = append(state, identifier & 0x3FFFF, 18)
    else:
        state = append(state, identifier, 11)
    state = append(state, remote, 1)
    state = append(state, 0, 2)  # IDE and r0, or r1 and r0
    state = append(state, len(data), 4)
    if not remote:
        for byte in data:
            state = append(state, int(byte), 8)
    return append(state, state[3], 15)[0]
