"""Tables of many words and numbers stand whole on a screen of 1200 px: what is beyond a side is not read."""

from __future__ import annotations

import pytest
from playwright.sync_api import BrowserContext

from rig.report import shell

pytestmark = pytest.mark.slow
WORDS = "amplitude of the motor torque lost without current, 24 times a motor turn, in cos(24·θ_m + φ)"
SHIFT = ["−0.9003 ± 0.0041 N·m·s/rad", "−0.9003 ± 0.0041 N·m·s/rad", "0.0 %", "0.0 ×"]
THREE = ['+34.1 ± 2.2 N·m·s/rad<span class="small">+34.1 ± 2.2 N·m·s/rad, cannot be judged</span>'] * 3
TABLES = {
    "closing": ('<div class="round">{}</div>', "", SHIFT[:2]),
    "comparison": ("{}", "", THREE),
    "trace": ("{}", "numbers moved", SHIFT),
    "trace, each": ("{}", "numbers each", ["0.312 → 0.312 N·m <small>0.314</small>"] * 3),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_of_long_names_is_not_cut_off(name: str, context: BrowserContext) -> None:
    around, kind, cells = TABLES[name]
    heads = "".join(f'<th scope="col">Shift over its 95 % half-width {k}</th>' for k in range(len(cells)))
    row = f'<tr><th scope="row">{WORDS}</th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'
    table = f'<table class="{kind}"><thead><tr><th>Name</th>{heads}</tr></thead><tbody>{row}</tbody></table>'
    sheet = shell.css("page", "", shell.HERE / name.partition(",")[0])
    body = around.format(f'<div class="scroll">{table}</div>')
    page = context.new_page()
    page.set_viewport_size({"width": 1200, "height": 800})
    page.set_content(f'<style>{sheet}</style><div class="sheet"><main>{body}</main></div>')
    assert page.evaluate("(e => e.scrollWidth - e.clientWidth)(document.querySelector('.scroll'))") <= 1


def test_a_long_name_beside_a_long_number_leaves_both_whole(context: BrowserContext) -> None:
    pair = f"<div><dt><b>B_m</b> {WORDS}</dt><dd>4.4646 ± 0.0058 mN·m·s/rad</dd></div>"
    kept = "<div><dt>how runs were held out</dt><dd>whole repeats, and whole loads and speeds between others</dd></div>"
    body = f'<section class="physical"><dl class="rows">{2 * pair}</dl></section>'
    body += f'<section id="provenance"><dl class="rows">{2 * kept}</dl></section>'
    page = context.new_page()
    page.set_content(
        f'<style>{shell.css("page", "", shell.HERE / "trace")}</style><div class="sheet"><main>{body}</main></div>'
    )
    for width in (500, 1100, 1200, 1440):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth") <= 1
