"""An operator at the page, `hdrig serve` behind it, drivers of real devices, a CAN bus, and `hdrig twin` at its end."""

from __future__ import annotations

import json
import re
import signal
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, Page

from tests.chromium import SIZE
from tests.console.browser.conftest import Open
from tests.console.browser.look import enabled, in_state, text, until
from tests.console.browser.rigs import Rig, rig
from tests.scenario.test_over_the_wire import STALLED

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("browser")]  # real time: a stall of the machine is a trip
ATTEMPTS = 4
PROMISED = 1.0  # s from the twin's end to the trip on the page; how long a device may be silent is part of it
MOVES = re.compile(r"[1-9]\d*\.\d")
NOTE_TRIP = """() => new MutationObserver((_, observer) => {
  if (document.documentElement.dataset.state !== 'fault') return;
  observer.disconnect();
  window.tripped = { at: Date.now() / 1e3, fault: document.getElementById('fault').textContent };
}).observe(document.documentElement, { attributes: true })"""
LOADED = 60.0  # s for what takes a tenth of that on an idle machine


@pytest.fixture(scope="module")
def served(browser: Browser) -> Iterator[Rig]:
    """One rig for the tests that leave it as it was."""
    with rig() as made:
        yield made


@pytest.fixture(scope="module")
def desk(browser: Browser, served: Rig) -> Iterator[Page]:
    """The operator's page on it, in control, the bench connected."""
    with browser.new_context(viewport=SIZE) as context:
        page = context.new_page()
        page.goto(served.url)
        _connected(page)
        yield page


@pytest.fixture
def fresh(browser: Browser) -> Iterator[Rig]:
    """One to be broken."""
    with rig() as made:
        yield made


def _connected(page: Page) -> None:
    """By clicking, again where a device of a stalled machine did not answer in time."""
    ready = page.locator("[data-act=prove][aria-disabled=false]")
    refused = page.locator("#events li[data-kind=refused]")
    for attempt in range(ATTEMPTS):
        page.click("[data-act=connect]", timeout=1e3 * LOADED)
        until(lambda n=attempt: ready.count() == 1 or refused.count() > n, "an answer of the bench", LOADED)  # type: ignore[misc]
        if ready.count() == 1:
            return
    raise AssertionError(text(page, "#events"))


def _jogging(page: Page) -> None:
    """A run of 54 s, to be ended by the test; the proof before it where there is none yet."""
    page.fill("#jog-turns", "9")
    page.click("[data-jog='1']", timeout=1e3 * LOADED)
    page.wait_for_selector(
        "#run-folder:has-text('jog'):not(:has-text('last'))", timeout=1e3 * LOADED
    )  # the run's own, not the proof's
    in_state(page, "running", LOADED)


def _turning(page: Page) -> None:
    """The proof: a run of 10 s that needs nothing before it."""
    page.click("[data-act=prove]", timeout=1e3 * LOADED)
    in_state(page, "running", LOADED)


def test_a_whole_kinematic_error_run_from_start_to_report_by_clicking(served: Rig, desk: Page) -> None:
    assert "SIMULATED" in text(desk, "#simulated")
    desk.select_option("#chosen", "kinematic-error")
    for name, value in (("amplitude_deg", "1080"), ("frequency", "0.04"), ("cycles", "0.5")):  # 13 s
        desk.fill(f"#parameter-{name}", value)
    desk.fill("#start-note", "by clicking")
    desk.wait_for_selector("#margins:has-text('28.8 of 600 rpm')", timeout=1e3 * LOADED)
    desk.wait_for_selector("#start[aria-disabled=false]")
    _until_completed(desk)

    report = desk.context.new_page()
    report.goto(desk.locator("#last a").get_attribute("href") or "")
    said = report.text_content("body") or ""
    report.close()
    assert "SIMULATED" in said
    assert "arcsec" in said
    *before, run = served.closed(2)
    assert (run["procedure"], run["status"]) == ("kinematic_error", "completed")
    assert run["conditions"]["note"] == "by clicking"
    assert run["conditions"]["speed_rpm"] == pytest.approx(28.8)  # 4·1080°·0.04 Hz: as typed
    assert before[0]["status"] == "completed"  # the proof, made first by itself
    desk.click("#tab-runs")
    desk.wait_for_selector(".listing tbody tr:has-text('kinematic-error')", timeout=1e3 * LOADED)


def _until_completed(page: Page) -> None:
    """Start, and see it to its end. A run that ends because the machine stalled is made again, by clicking."""
    for _ in range(ATTEMPTS):
        page.click("#start", timeout=1e3 * LOADED)
        page.wait_for_selector(
            "#run-folder:has-text('kinematic'):not(:has-text('last')), #fault:visible", timeout=1e3 * LOADED
        )
        page.wait_for_selector("#last a:visible, #fault:visible", timeout=3e3 * LOADED)  # the analysis too
        if page.locator("#fault").is_hidden():
            return
        assert STALLED.search(text(page, "#fault")), text(page, "#fault")
        page.click("#reset")
        in_state(page, "connected", LOADED)
    raise AssertionError(f"this machine stalled in all of {ATTEMPTS} runs")


def test_two_quick_clicks_on_the_real_server_turn_the_motor_once(served: Rig, desk: Page) -> None:
    desk.click("#tab-rig")
    desk.fill("#jog-turns", "0.25")
    before = desk.locator("#events li:has-text('running: jog')").count()
    forward = desk.locator("[data-jog='1']")
    forward.evaluate("button => { button.click(); button.click(); }")  # two clicks of which neither is a double click's
    desk.wait_for_selector("#run-folder:has-text('jog'):not(:has-text('last'))", timeout=1e3 * LOADED)
    desk.wait_for_selector("[data-jog='1'][aria-disabled=false]", timeout=1e3 * LOADED)
    jogs = [one for one in served.closed(1) if one.get("label") == "jog"]
    assert len(jogs) == before + 1 == 1


def test_a_second_page_looks_stops_and_takes_control_only_when_asked_to(
    desk: Page, browser: Browser, served: Rig
) -> None:
    with browser.new_context(viewport=SIZE) as elsewhere:
        second = elsewhere.new_page()
        second.goto(served.url)
        second.wait_for_selector("#take-control", state="visible")
        assert enabled(second) == {"stop", "take_control"}
        _jogging(desk)
        in_state(second, "running", LOADED)
        second.click("#stop")
        in_state(desk, "ready", LOADED)
        second.click("#take-control")
        desk.wait_for_selector("#take-control", state="visible")
        second.wait_for_selector("[data-act=prove][aria-disabled=false]", timeout=1e3 * LOADED)
        assert enabled(desk) == {"stop", "take_control"}
    desk.click("#take-control")
    desk.wait_for_selector("[data-act=prove][aria-disabled=false]", timeout=1e3 * LOADED)


def test_a_reload_in_mid_run_shows_the_run_and_keeps_control(served: Rig, desk: Page) -> None:
    _jogging(desk)
    desk.reload()
    in_state(desk, "running", LOADED)
    assert "jog" in text(desk, "#run-title")
    assert desk.locator("#take-control").is_hidden()
    desk.keyboard.press("F4")
    in_state(desk, "ready", LOADED)
    assert served.closed(1)[-1]["status"] == "stopped"


def test_halt_ends_a_run_at_once_and_closes_its_folder(served: Rig, desk: Page) -> None:
    _jogging(desk)
    desk.locator("#halt").dispatch_event("pointerdown")
    desk.wait_for_selector("#answer:has-text('Halt: ')")
    assert "seen by the loop after" in text(desk, "#answer")
    in_state(desk, "ready", LOADED)
    last = served.closed(1)[-1]
    assert (last["status"], last["exit"]) == ("stopped", 130)


def test_a_request_without_the_token_or_from_another_origin_moves_nothing(served: Rig) -> None:
    parts = urlsplit(served.url)
    token = parts.fragment.partition("=")[2]
    body = json.dumps({"act": "stop", "id": "5f0c54c4-4f3e-4a52-9c8e-0f3cbb4a76a5", "based_on": 0}).encode()
    for headers, status in (
        ({}, 401),
        ({"X-Hdrig-Token": "guessed"}, 401),
        ({"X-Hdrig-Token": token, "Origin": "http://evil.example"}, 403),
        ({"X-Hdrig-Token": token, "Host": "evil.example"}, 403),
        ({"X-Hdrig-Token": token}, 200),
    ):
        request = urllib.request.Request(f"http://{parts.netloc}/api/act", body, headers)
        try:
            with urllib.request.urlopen(request, timeout=LOADED) as answer:
                found = answer.status
        except urllib.error.HTTPError as error:
            found = error.code
            error.close()
        assert found == status, headers


def test_when_the_server_is_killed_the_page_is_stale_and_the_station_stops_the_motor_and_closes_the_run(
    fresh: Rig, open_page: Open
) -> None:
    page = open_page(fresh.url)
    _connected(page)
    _turning(page)
    fresh.server.kill()  # nothing is left to say goodbye
    page.wait_for_selector("#stale", state="visible")
    assert page.locator("#state").evaluate("node => getComputedStyle(node).textDecorationLine") == "line-through"
    (run,) = fresh.closed(1)  # the bench file says stop
    assert run["status"] == "stopped"
    assert "page" in run["exit_reason"]
    assert abs(float(fresh.ask(do="truth")["omega_m"])) < 0.1  # rad/s: it stands


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGSTOP], ids=["killed", "frozen"])
def test_when_the_twin_is_gone_the_trip_shows_within_a_second_in_words_with_what_to_do_next(
    fresh: Rig, open_page: Open, end: signal.Signals
) -> None:
    page = open_page(fresh.url)
    _connected(page)
    _turning(page)
    until(lambda: bool(MOVES.search(text(page, "[data-tile=speed] .value"))), "the motor turns", LOADED)
    page.evaluate(NOTE_TRIP)
    began = time.time()
    fresh.twin.send_signal(end)
    until(lambda: bool(page.evaluate("window.tripped")), "the trip", LOADED)
    shown = page.evaluate("window.tripped")
    print(f"{end.name} of the twin: the trip showed after {shown['at'] - began:.2f} s: {shown['fault']}")
    assert shown["at"] - began < PROMISED
    page.wait_for_selector("#advice:has-text('reset the fault')", timeout=1e3 * LOADED)
    assert "the drive did not confirm" in text(page, "#fault")
    assert page.locator("[data-act=prove]").get_attribute("aria-disabled") == "true"
    assert "hard-wired stop" in text(page, "#advice")
    page.wait_for_selector("#chain[data-chain=unknown]", timeout=1e3 * LOADED)  # nobody tells of it any more
    page.wait_for_selector("[data-tile=speed] .value:has-text('—')", timeout=1e3 * LOADED)
    (run,) = fresh.closed(1)
    assert run["status"] == "tripped"
    page.wait_for_selector("#events li[data-kind=trip]")
    fresh.twin.send_signal(signal.SIGCONT)
