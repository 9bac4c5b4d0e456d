"""What a press sends, how often, and what halt does in spite of everything. Each button in each state: next door."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page

from tests.console.browser.conftest import Open
from tests.console.browser.look import enabled, in_state, text, until
from tests.console.browser.puppet import BENCH, Puppet

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]


def test_a_button_that_may_not_be_pressed_says_why_and_sends_nothing(page: Page, station: Puppet) -> None:
    page.click("[data-act=prove]", force=True)
    assert text(page, "#answer") == "Not possible now: no bench is connected"
    assert station.acts == []


def test_a_double_click_does_it_once(page: Page, station: Puppet) -> None:
    station.tell(state="ready", bench=BENCH)
    in_state(page, "ready")
    page.dblclick("[data-act=prove]")
    page.dblclick("[data-jog='1']")
    until(lambda: len(station.acts) >= 2, "both acts")
    page.wait_for_timeout(300)
    assert [act["act"] for act in station.acts] == ["prove", "jog"]


def test_an_act_says_its_id_and_the_state_it_was_based_on(page: Page, station: Puppet) -> None:
    station.tell(state="ready", bench=BENCH)
    in_state(page, "ready")
    page.fill("#jog-turns", "0.5")
    page.click("[data-jog='-1']")
    page.click("[data-jog='1']")
    until(lambda: len(station.acts) == 2, "two jogs")
    first, second = station.acts
    assert (first["turns"], second["turns"], first["speed_rpm"]) == (-0.5, 0.5, 10)
    assert first["id"] != second["id"]
    assert first["based_on"] == station.revision


def test_what_the_station_refuses_is_told_in_its_words(page: Page, station: Puppet) -> None:
    station.refusal = "the state has changed since this page last saw it"
    page.click("[data-act=connect]")
    page.wait_for_selector("#answer[data-ok=false]")
    assert text(page, "#answer") == f"Connect refused: {station.refusal}"


def test_halt_acts_when_the_button_goes_down_and_not_when_it_comes_up(page: Page, station: Puppet) -> None:
    box = page.locator("#halt").bounding_box()
    assert box
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    until(lambda: len(station.acts) == 1, "halt")
    page.mouse.up()
    page.wait_for_timeout(200)
    assert [act["act"] for act in station.acts] == ["halt"]
    until(lambda: "seen by the loop after 2.0 ms" in text(page, "#answer"), "an answer")


def test_halt_stop_and_hold_have_keys_that_write_nothing_into_a_field(page: Page, station: Puppet) -> None:
    page.fill("#start-note", "so far")
    page.focus("#start-note")
    for key in ("F8", "Pause", "F4", "F2"):
        page.keyboard.press(key)
    until(lambda: len(station.acts) == 4, "four acts")
    assert sorted(act["act"] for act in station.acts) == ["halt", "halt", "hold", "stop"]
    assert page.input_value("#start-note") == "so far"
    page.keyboard.type("halt stop F8 x h s")
    page.wait_for_timeout(100)
    assert len(station.acts) == 4


def test_a_halt_that_nobody_confirms_points_to_the_hard_wired_stop(page: Page, station: Puppet) -> None:
    station.server.should_exit = True
    station.thread.join(10)
    page.locator("#halt").dispatch_event("pointerdown")
    page.wait_for_selector("#answer[data-ok=false]")
    assert text(page, "#answer") == "HALT NOT CONFIRMED: use the hard-wired stop."


def test_a_page_without_control_only_looks_but_may_stop_and_halt(page: Page, station: Puppet) -> None:
    station.controller = "other"
    station.tell(bench=BENCH, state="ready")
    page.wait_for_selector("#take-control", state="visible")
    assert enabled(page) == {"stop", "take_control"}
    assert "Another page has control" in text(page, "#advice")
    page.keyboard.press("F8")
    page.click("#take-control")
    until(lambda: len(station.acts) == 2, "halt and take_control")
    assert {act["act"] for act in station.acts} == {"halt", "take_control"}


def test_a_page_with_a_wrong_token_only_looks(open_page: Open, station: Puppet) -> None:
    page = open_page(station.address + "#token=guessed", link="refused")
    assert "no valid token" in text(page, "#answer")
    page.click("[data-act=connect]", force=True)
    page.wait_for_timeout(200)
    assert station.acts == []
    assert enabled(page) == set()


def test_a_campaign_that_was_stopped_is_gone_on_with_by_clicking(page: Page, station: Puppet) -> None:
    left = {"folder": "runs/2026-11-20-1129-campaign-quick-TWIN-1a2b", "plan": "quick", "bench": "twin", "done": 3,
            "total": 12, "started_utc": "2026-11-20T11:29:00Z", "why": "stopped by the operator"}  # fmt: skip
    station.tell(
        state="ready", bench=BENCH, job="campaign quick", campaign={**left, "current": "friction", "left_s": 9}
    )
    page.wait_for_selector("#campaign:visible")
    page.click("[data-kind=plan]")
    assert page.locator("#chosen option").count() == 1
    station.campaigns = [left]
    station.tell(job="", campaign=None)  # it ends: asked for again
    page.wait_for_selector("#chosen optgroup[label='Go on with'] option", state="attached")
    page.select_option("#chosen", left["folder"])
    assert "3 of 12 runs are done; stopped by the operator" in text(page, "#summary")
    page.wait_for_selector("#start[aria-disabled=false]:has-text('Go on with campaign quick')")
    assert station.checked[-1]["resume"] == left["folder"]
    page.click("#start")
    until(lambda: len(station.acts) == 1, "campaign")
    sent = station.acts[0]
    assert (sent["act"], sent["resume"], "plan" in sent) == ("campaign", left["folder"], False)
