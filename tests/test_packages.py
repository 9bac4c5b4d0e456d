"""The three import names are generic: they must be ours, side by side; and every source named in the code exists."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import pytest

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


def layers() -> dict[str, int]:
    """How high each part of rig stands, by the first import contract; 0 is the command line."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    return {name: k for k, row in enumerate(contracts[0]["layers"]) for name in row.split(" | ")}


def is_module(name: str) -> bool:
    place = ROOT / name.replace(".", "/")
    return place.is_dir() or place.with_suffix(".py").is_file()


def named_modules(file: Path) -> set[str]:
    """Parts of rig that `file` names in texts that are modules: what it starts or loads without an import statement."""
    nodes = (n for n in ast.walk(ast.parse(file.read_text("utf-8"))) if isinstance(n, ast.Constant))
    texts = {n.value.partition(":")[0] for n in nodes if isinstance(n.value, str)}
    return {text.split(".")[1] for text in texts if re.fullmatch(r"rig(\.\w+)+", text) and is_module(text)}


@pytest.mark.slow
def test_what_is_started_or_loaded_by_name_lies_no_higher_than_who_names_it() -> None:
    high, above = layers(), []
    for file in sorted((ROOT / "rig").rglob("*.py")):
        part = file.relative_to(ROOT / "rig").parts[0].removesuffix(".py")
        above += [f"{file.name} names rig.{m}" for m in named_modules(file) if part in high and high[m] < high[part]]
    assert above == []
