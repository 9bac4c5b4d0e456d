"""What stands on the page after an act and after a run: what became of it, and nothing that is over."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import Page

from tests.console.browser.look import in_state, text, until
from tests.console.browser.puppet import BENCH, RUN, Puppet
from tests.some import some

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]
REFUSED = {"t": None, "utc": "2026-11-21T00:18:53+00:00", "kind": "refused", "text": "the drive does not answer"}
HALTED = {**REFUSED, "kind": "error", "text": "torque off not confirmed by the drive: hard-wired stop"}
LAST = {
    "uid": "u1", "title": "kinematic-error", "status": "completed", "reason": "", "folder": "runs/ke",
    "report": "/runs/ke/report.html", "verdict": "MEASURED", "sentence": "93.4 arcsec peak to peak",
}  # fmt: skip
INK = """canvas => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let n = 0;
  for (let k = 3; k < data.length; k += 4) n += data[k] > 100;
  return n;
}"""


def test_what_became_of_an_accepted_act_stands_where_it_was_answered(page: Page, station: Puppet) -> None:
    station.tell(state="fault", bench=BENCH, fault="the bus is lost")
    in_state(page, "fault")
    page.click("#reset")
    until(lambda: "accepted" in text(page, "#answer"), "an answer")
    station.tell(events=[REFUSED])
    until(lambda: text(page, "#answer") == REFUSED["text"], "what it came to")
    assert page.get_attribute("#answer", "data-ok") == "false"


def test_a_halt_the_drive_did_not_confirm_is_told_although_it_was_taken(page: Page, station: Puppet) -> None:
    station.tell(state="fault", bench=BENCH, fault="the bus is lost", events=[REFUSED])
    in_state(page, "fault")
    page.keyboard.press("F8")
    until(lambda: "Halt" in text(page, "#answer"), "an answer")
    station.tell(events=[REFUSED, HALTED])
    until(lambda: text(page, "#answer") == HALTED["text"], "what it came to")


def test_a_halt_nobody_can_hear_any_more_is_not_confirmed(page: Page, station: Puppet) -> None:
    station.tell(state="running", bench=BENCH, run=RUN, station=False, fault="the control process has ended")
    page.wait_for_selector("#stale", state="visible")
    page.keyboard.press("F8")
    until(lambda: "NOT CONFIRMED" in text(page, "#answer"), "a warning")


def test_an_old_refusal_goes_with_the_state_that_was_its_reason(page: Page, station: Puppet) -> None:
    station.tell(state="ready", bench=BENCH, job="taring the torque sensor")
    page.wait_for_selector('[data-act="check"][aria-disabled="true"]')
    page.click('[data-act="check"]', force=True)  # as a finger does that does not look
    assert "busy: taring" in text(page, "#answer")
    station.tell(job="")
    until(lambda: text(page, "#answer") == "", "an answer that is over")


def test_the_last_seconds_of_a_run_stay_in_the_strips_until_the_next_one(page: Page, station: Puppet) -> None:
    station.tell(state="running", bench=BENCH, run=RUN)
    in_state(page, "running")
    t = np.arange(0.0, 15.0, 0.01)
    station.show({"t": t, "motor_angle": 58 * t, "following": np.sin(t), "tau_m": 0 * t + 1.5, "tau_l": 0 * t})
    until(lambda: _tile(page, "motor").startswith("1.50"), "rows of the run")
    page.wait_for_timeout(300)
    drawn = page.locator("#chart-following canvas").evaluate(INK)
    station.tell(state="fault", run=None, fault="shaft torque", last_run={**LAST, "status": "tripped"})
    in_state(page, "fault")
    idle = 400.0 + np.arange(0.0, 30.0, 0.05)  # of another clock
    station.show({"t": idle, "motor_angle": 0 * idle, "tau_m": 0 * idle + 0.25, "tau_l": 0 * idle})
    until(lambda: _tile(page, "motor").startswith("0.25"), "present values")
    page.wait_for_timeout(300)
    assert page.locator("#chart-following canvas").evaluate(INK) == pytest.approx(drawn, rel=0.02)
    assert page.get_attribute("#charts", "data-over") == "true"
    station.tell(bench={**BENCH, "source": "another.toml"})
    until(lambda: page.get_attribute("#charts", "data-over") == "false", "an empty picture")


@pytest.mark.parametrize("size", some([(1024, 768), (1280, 800), (1920, 1080)], 1))
def test_the_report_of_a_run_is_in_sight_when_it_is_there(page: Page, station: Puppet, size: tuple[int, int]) -> None:
    page.set_viewport_size({"width": size[0], "height": size[1]})
    station.tell(state="ready", bench=BENCH, last_run=LAST)
    page.wait_for_selector("#last a", state="visible")
    box = page.locator("#last a").bounding_box()
    assert box
    assert box["y"] + box["height"] < size[1] / 2, "without scrolling"
    assert "93.4 arcsec" in text(page, "#last")


def test_what_is_wrong_and_what_to_do_is_read_whole_and_from_afar(page: Page, station: Puppet) -> None:
    fault = "a device reports a fault: CAN bus 'rig' is lost (cannot receive, Connection reset by peer [Error 104]); "
    station.tell(state="fault", bench=BENCH, fault=fault + "the drive did not confirm that its torque is off")
    in_state(page, "fault")
    for width, height in ((1280, 800), (1920, 1080)):
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(100)
        cut = "node => [node.scrollHeight - node.clientHeight, parseFloat(getComputedStyle(node).fontSize)]"
        over, size = page.locator("#now .words").evaluate(cut)
        assert over <= 1, f"{over} px of it are out of sight at {width} x {height}"
        assert size >= 14
        assert page.locator("#advice").evaluate(cut)[1] >= 15.9


def test_a_phone_shows_what_runs_before_what_could_run(page: Page, station: Puppet) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    station.tell(state="running", bench=BENCH, run=RUN, job="run kinematic-error")
    in_state(page, "running")
    box = page.locator("[data-tile=peak]").bounding_box()
    assert box
    assert box["y"] + box["height"] < 844


def _tile(page: Page, name: str) -> str:
    return page.locator(f"[data-tile={name}] .value").text_content() or ""
