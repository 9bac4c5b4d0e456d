"""Every colour of the report, light and dark, by the name of its CSS variable. Figures are drawn with the light ones;
on a page each is then replaced by its variable, so that one drawing serves both and print.

Forward and reverse are blue and vermilion: apart for every common colour vision, and never told apart by colour alone.
"""

from __future__ import annotations

LIGHT = {
    "paper": "#fcfcfa",
    "sheet": "#f4f4f0",  # banded rows, quiet boxes
    "ink": "#1b242c",
    "muted": "#56616b",
    "axis": "#8d969e",
    "grid": "#e4e6e6",
    "forward": "#1d63a6",
    "forward-soft": "#86b2da",
    "reverse": "#b5480f",
    "reverse-soft": "#e2a37c",
    "fit": "#0d1318",
    "bar": "#34618a",
    "bar-soft": "#aac2d6",
    "level": "#7c6213",  # floors and limits
    "mark": "#77409a",  # SIMULATED
    "good": "#18714d",
    "bad": "#b02a20",
    "warn": "#8a5600",
}

DARK = {
    "paper": "#11161a",
    "sheet": "#192026",
    "ink": "#e7ebee",
    "muted": "#a0abb5",
    "axis": "#717d87",
    "grid": "#2a333b",
    "forward": "#74b6f2",
    "forward-soft": "#3d6c97",
    "reverse": "#f39a62",
    "reverse-soft": "#925a38",
    "fit": "#fefefe",
    "bar": "#7fb3db",
    "bar-soft": "#3f5e78",
    "level": "#d9ba62",
    "mark": "#c9a0ea",
    "good": "#5fc79a",
    "bad": "#ff8a7d",
    "warn": "#f0b357",
}

NAME = {colour: name for name, colour in LIGHT.items()}


def variables(theme: dict[str, str]) -> str:
    """The theme as CSS declarations."""
    return "".join(f"--{name}:{colour};" for name, colour in theme.items())
