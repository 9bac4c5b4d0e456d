"""Nothing old passes for the present, nothing foreign is run, nothing is asked for that can be missed."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import BrowserContext, Page

from tests.console.browser.conftest import Open
from tests.console.browser.look import enabled, in_state, text, until
from tests.console.browser.puppet import BENCH, RUN, Puppet

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]
HOSTILE = '<img src=x onerror="window.hit=1"><script>window.hit=1</script>"\'`${1}%00\u202eabc' + "W" * 400
STRUCK = "#state, #run-title, .tile .value, #events"
CROSSED = "node => getComputedStyle(node).textDecorationLine"


def test_before_the_first_state_the_page_says_that_it_waits_and_claims_nothing(
    open_page: Open, station: Puppet, wrong: list[str]
) -> None:
    station.tell(state="ready", bench=BENCH)
    station.silent = True
    page = open_page(station.url, link="waiting")
    page.wait_for_timeout(1000)  # the list of benches is here, no state is
    assert text(page, "#link .text") == "waiting for the state"
    shown = page.locator("body").inner_text().lower()
    for claim in ("live", "disconnected", "no bench connected", "nothing runs", "stale"):
        assert claim not in shown
    page.click("[data-act=connect]", force=True)
    assert text(page, "#answer") == "Not possible now: waiting for the first state"
    page.keyboard.press("F8")  # a halt is sent all the same
    until(lambda: [act["act"] for act in station.acts] == ["halt"], "halt")
    station.silent = False
    in_state(page, "ready")
    page.wait_for_selector("html[data-link=live]", state="attached")
    page.wait_for_selector("#simulated", state="visible")
    assert text(page, "#link .text").startswith("live, state ")
    assert wrong == []


def test_a_first_state_that_never_comes_is_stale_as_well(open_page: Open, station: Puppet) -> None:
    station.silent = True
    page = open_page(station.url, link="waiting")
    page.wait_for_selector("#stale", state="visible")
    assert "no word from the station for" in text(page, "#stale")


def test_without_a_word_for_half_a_second_the_page_says_stale_and_strikes_out_what_it_shows(
    page: Page, station: Puppet
) -> None:
    station.tell(state="running", bench=BENCH, run=RUN)
    in_state(page, "running")
    # a stall of the machine may make it stale for a moment
    until(lambda: {node.evaluate(CROSSED) for node in page.locator(STRUCK).all()} == {"none"}, "a fresh page")

    station.silent = True
    page.wait_for_selector("#stale", state="visible")
    assert "no word from the station for" in text(page, "#stale")
    assert {node.evaluate(CROSSED) for node in page.locator(STRUCK).all()} == {"line-through"}
    until(lambda: enabled(page) == {"hold", "stop"}, "nothing but stopping may be pressed")
    page.keyboard.press("F8")  # a halt is sent all the same
    until(lambda: [act["act"] for act in station.acts] == ["halt"], "halt")

    station.silent = False
    page.wait_for_selector("#stale", state="hidden")
    assert {node.evaluate(CROSSED) for node in page.locator(STRUCK).all()} == {"none"}


def test_a_dead_control_process_is_as_loud_as_a_dead_server(page: Page, station: Puppet) -> None:
    station.tell(state="running", bench=BENCH, run=RUN, station=False, fault="the control process has ended")
    page.wait_for_selector("#stale", state="visible")
    assert "control process has ended" in text(page, "#stale")
    assert page.locator("#fault").evaluate(CROSSED) == "none"  # that is new, and what to do now
    assert page.locator("#advice").evaluate(CROSSED) == "none"
    assert page.locator("#run-title").evaluate(CROSSED) == "line-through"


def test_the_age_grows_as_time_goes_by_and_not_with_what_the_server_says(
    context: BrowserContext, station: Puppet
) -> None:
    page = context.new_page()
    page.clock.install()
    page.goto(station.url)
    page.wait_for_selector("html[data-link=live]", state="attached")
    station.silent = True
    page.wait_for_selector("#stale", state="visible")  # nothing is on its way any more
    ages = []
    for _ in range(2):
        page.clock.run_for(20_000)  # less than a minute in all
        found = re.search(r"for ([\d.]+)\u00a0s", text(page, "#stale-age"))
        assert found, text(page, "#stale-age")
        ages.append(float(found[1]))
    assert ages[1] - ages[0] > 19.9  # and what the machine took for it


def test_simulated_is_said_as_long_as_the_bench_is_the_twin(page: Page, station: Puppet) -> None:
    station.tell(state="ready", bench=BENCH)
    page.wait_for_selector("#simulated", state="visible")
    assert "SIMULATED" in page.title()
    station.tell(bench={**BENCH, "simulated": False})
    page.wait_for_selector("#simulated", state="hidden")


def test_the_hard_wired_chain_is_never_said_to_be_closed_when_that_is_not_known(page: Page, station: Puppet) -> None:
    for chain, said in (
        ({"known": False, "closed": None, "text": "no drive"}, "hard-wired chain: not known"),
        ({"known": True, "closed": True, "text": "STO"}, "hard-wired chain closed"),
        ({"known": True, "closed": False, "text": "STO"}, "hard-wired chain OPEN"),
    ):
        station.tell(chain=chain)
        page.wait_for_selector(f"#chain:has-text('{said}')")


def test_hostile_words_from_files_and_people_are_shown_as_words(page: Page, station: Puppet, wrong: list[str]) -> None:
    event = {"t": 1.0, "utc": "2026-11-20T11:00:00Z", "kind": HOSTILE, "text": HOSTILE}
    last = {"title": HOSTILE, "status": HOSTILE, "reason": HOSTILE, "folder": HOSTILE, "verdict": HOSTILE,
            "sentence": HOSTILE, "report": "javascript:window.hit=1"}  # fmt: skip
    station.tell(
        state="fault", fault=HOSTILE, bench={**BENCH, "name": HOSTILE, "gear": HOSTILE}, proof=HOSTILE, tare=HOSTILE,
        checks=[{"name": HOSTILE, "ok": False, "text": HOSTILE}], events=[event], last_run=last,
        chain={"known": False, "closed": None, "text": HOSTILE}, prompt={"id": "p", "text": HOSTILE, "what": HOSTILE},
        campaign={"plan": HOSTILE, "done": 0, "total": 1, "current": HOSTILE, "left_s": 1.0}, viewer_url=None,
        runs=[{**dict.fromkeys(("path", "gear", "procedure", "status"), HOSTILE), "report": "//evil.example/x"}],
    )  # fmt: skip
    page.wait_for_selector("#prompt", state="visible")
    station.tell(prompt=None)
    page.wait_for_selector("#prompt", state="hidden")
    assert HOSTILE in text(page, "#fault")
    assert "javascript" not in (page.locator("#last a").get_attribute("href") or "")
    page.click("#tab-runs")
    page.wait_for_selector(".listing tbody tr")
    assert page.locator(".listing a").get_attribute("href") == "about:blank"
    assert page.locator("img, body script").count() == 0
    assert page.evaluate("window.hit") is None
    box = page.locator("#halt").bounding_box()
    assert box
    assert box["x"] + box["width"] <= 1920
    assert box["y"] + box["height"] <= 1080


def test_hostile_input_in_every_field_is_sent_as_it_was_typed_and_breaks_nothing(page: Page, station: Puppet) -> None:
    station.tell(state="ready", bench=BENCH)
    in_state(page, "ready")
    station.problems = {"amplitude_deg": HOSTILE, "*": HOSTILE}
    for field in page.locator("#side input:visible, #note input").all():
        field.fill(HOSTILE[:400])
    page.wait_for_selector("#parameter-amplitude_deg-wrong:has-text('<img src=x')")
    until(lambda: station.checked[-1]["parameters"].get("amplitude_deg") == HOSTILE[:400], "the value as typed")
    assert page.locator("#start").get_attribute("aria-disabled") == "true"
    page.click("[data-jog='1']")
    page.click("[data-act=note]")
    until(lambda: len(station.acts) == 2, "jog and note")
    assert {act.get("text") or act.get("turns") for act in station.acts} == {HOSTILE[:400]}
    assert page.evaluate("window.hit") is None


def test_a_prompt_stands_over_the_charts_until_it_is_answered_and_leaves_halt_and_notes_in_reach(
    page: Page, station: Puppet
) -> None:
    asked = {"id": "p1", "text": "hang 5 N·m on the output, pulling forward", "what": "HangWeight"}
    station.tell(state="ready", bench=BENCH, prompt=asked)
    page.wait_for_selector("#prompt", state="visible")
    assert text(page, "#prompt-text") == asked["text"]
    assert page.title().startswith("YOUR TURN")
    for key in ("Enter", "Space", "Escape"):  # on its way to something else
        page.keyboard.press(key)
    top = "([x, y]) => document.elementFromPoint(x, y).closest('button')?.id"
    for name in ("halt", "stop", "hold"):
        box = page.locator(f"#{name}").bounding_box()
        assert box
        assert page.evaluate(top, [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2]) == name
    assert station.acts == []

    page.fill("#note-text", "weight hung on the left arm")
    page.click("[data-act=note]")
    until(lambda: len(station.acts) == 1, "a note while it stands there")
    assert (station.acts[0]["act"], station.acts[0]["text"]) == ("note", "weight hung on the left arm")
    assert page.locator("#prompt").is_visible()
    page.click("#prompt-done")
    until(lambda: len(station.acts) == 2, "the answer")
    assert (station.acts[1]["act"], station.acts[1]["prompt_id"], station.acts[1]["done"]) == ("answer", "p1", True)


def test_nothing_is_fetched_from_anywhere_else(open_page: Open, station: Puppet, context: BrowserContext) -> None:
    asked: list[str] = []
    context.on("request", lambda request: asked.append(request.url))
    page = open_page(station.url)
    page.click("#tab-runs")
    page.wait_for_timeout(300)
    assert len(asked) > 10
    assert {url.split("/")[2] for url in asked} == {f"127.0.0.1:{station.port}"}
    assert not any("puppet" in url for url in asked)  # the token is in no address
    assert "token" not in page.url
