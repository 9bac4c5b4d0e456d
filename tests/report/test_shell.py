"""All pages stand in one frame."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.report import shell

TEMPLATES = sorted(p for p in shell.HERE.rglob("*.html") if p.name != "base.html")
FRAME = ("<!doctype", "<head>", "Content-Security-Policy", "<main>", 'class="brand"')


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda p: str(p.relative_to(shell.HERE)))
def test_a_page_fills_the_frame_and_has_none_of_its_own(template: Path) -> None:
    text = template.read_text(encoding="utf-8")
    assert text.startswith('{% extends "base.html" %}\n')
    assert not [part for part in FRAME if part in text]
    assert "base.html" in shell.environment(template.parent).list_templates()


def test_the_style_sheet_of_a_page_follows_the_common_one() -> None:
    common = shell.css("a run", "SIMULATED")
    assert "{{" not in common
    assert '"a\\20 run"' in common
    own = shell.HERE / "trace"
    assert shell.css("a run", "SIMULATED", own) == f"{common}\n{(own / 'page.css').read_text(encoding='utf-8')}"
