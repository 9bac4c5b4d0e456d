"""The three import names are generic: they must be ours, side by side; and every source named in the code exists."""

from __future__ import annotations

import re
from pathlib import Path

import drivers
import rig
import sim
from rig.model.references import REFERENCES

ROOT = Path(rig.__file__).parents[1]


def test_the_three_packages_lie_side_by_side() -> None:
    assert {Path(p.__file__ or "").parents[1] for p in (rig, drivers, sim)} == {ROOT}


def test_every_source_key_in_the_code_has_its_reference() -> None:
    used = set()
    for package in ("rig", "drivers", "sim"):
        for file in (ROOT / package).rglob("*.py"):
            used |= set(re.findall(r" {3,}\[([a-z]+\d*)(?:, [^\]]*)?\]", file.read_text("utf-8")))
    assert used <= set(REFERENCES), used - set(REFERENCES)
    assert "ghorbel2001" in used
