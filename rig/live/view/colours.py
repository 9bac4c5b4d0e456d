"""Colours on the viewer's dark ground, 0xRRGGBB. Forward and reverse are blue and vermilion, as in the report: apart
for every common colour vision, and never told apart by colour alone.
"""

from __future__ import annotations

FORWARD = 0x74B6F2
FORWARD_SOFT = 0x345A7C
REVERSE = 0xF39A62
REVERSE_SOFT = 0x74482C
GROUND = 0x0D1114
NOW = 0xFEFEFE  # what is being measured this moment
INK = 0xE7EBEE
MUTED = 0xA0ABB5
AXIS = 0x717D87
GRID = 0x2A333B
GOOD = 0x5FC79A
WARN = 0xF0B357
BAD = 0xFF8A7D
MARK = 0xC9A0EA  # SIMULATED
STEEL = 0x8792A0
DARK_STEEL = 0x3C4650
BRASS = 0xD9BA62
