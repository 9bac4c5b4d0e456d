"""One screen, at a desk and on a tablet; by hand, by keyboard, in high contrast; a unit on every number."""

from __future__ import annotations

import re

import numpy as np
import pytest
from playwright.sync_api import Page

from tests.console.browser.look import in_state, text, until
from tests.console.browser.puppet import BENCH, RUN, Puppet
from tests.some import some

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]
SCREENS = {"a wall": (1920, 1080), "a desk": (1600, 900), "a tablet": (1024, 768)}
NARROW = {"half a desk": (800, 900), "a small desk": (1280, 800), "a little wider": (1300, 850)}
UNITS = r"(arcsec|deg|rpm|N·m|µs|ticks?|ms|s|%)"
SCROLLS = "[document.body.scrollHeight > innerHeight, document.body.scrollWidth > innerWidth]"
PAINTED = """node => {
  const ink = getComputedStyle(node).color;
  const clear = (one) => /rgba\\(0, 0, 0, 0\\)|transparent/.test(getComputedStyle(one).backgroundColor);
  while (node && clear(node)) node = node.parentElement;
  return [ink, getComputedStyle(node).backgroundColor];
}"""
TEXTS = ("#state", "#fault", "#halt b", ".tile dt", ".tile .basis", ".summary", "#steps .said", "#bench")
TOUCH = 44  # px, the least a finger hits

WORDS = ".tile :is(dt, .value, .basis), .pick button, .chart .legend, .key, #run-time"
CUT = """words => [...document.querySelectorAll(words)]
  .filter(one => one.checkVisibility())
  .filter(one => {
    const [box, room] = [one, one.closest('.chart, .tile, .progress, .pick')].map(it => it.getBoundingClientRect());
    return one.scrollWidth > one.clientWidth + 1 && one.clientWidth || box.right > room.right + 1;
  }).map(one => one.textContent)"""
COVERED = """() => {
  const over = document.getElementById('stale').getBoundingClientRect();
  return [...document.querySelectorAll('.bar, #now, .progress, .tile, #halt, .gentle button, .chart')]
    .map(one => [one.id || one.className, one.getBoundingClientRect()])
    .filter(([, box]) => box.top < over.bottom - 1 && box.bottom > over.top + 1)
    .filter(([, box]) => box.left < over.right - 1 && box.right > over.left + 1)
    .map(([name]) => name);
}"""
WRITTEN = """() => {
  window.written = [];
  const plain = CanvasRenderingContext2D.prototype.fillText;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...at) {
    const { a, b } = this.getTransform();  // turned by a right angle: along the height
    const room = Math.abs(b) > Math.abs(a) ? this.canvas.height : this.canvas.width;
    if (this.canvas.checkVisibility()) window.written.push([text, this.measureText(text).width / room]);
    return plain.call(this, text, ...at);
  };
}"""


def _running(station: Puppet) -> None:
    station.tell(state="running", bench=BENCH, run=RUN, job="run kinematic-error")


def test_one_screen_without_scrolling_and_halt_always_at_the_same_place(page: Page, station: Puppet) -> None:
    _running(station)
    in_state(page, "running")
    for name, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(100)
        places = []
        for view in ("rig", "runs"):
            page.click(f"#tab-{view}")
            scrolls = page.evaluate(
                "[document.body.scrollHeight > innerHeight, document.body.scrollWidth > innerWidth]"
            )
            assert scrolls == [False, False], f"{name}, {view}"
            places.append(page.locator("#halt").bounding_box())
        assert places[0] == places[1], name
        assert places[0]
        assert places[0]["x"] + places[0]["width"] <= width
        assert places[0]["height"] > TOUCH


def test_what_is_written_along_an_axis_fits_it_and_every_axis_has_numbers_on_it(page: Page, station: Puppet) -> None:
    page.evaluate(WRITTEN)
    for name, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        station.tell(state="running", bench=BENCH, run={**RUN, "uid": name}, campaign={"plan": "quick", "done": 3,
                     "total": 12, "current": "kinematic-error", "left_s": 300.0})  # fmt: skip
        page.wait_for_selector("#campaign:visible")
        page.evaluate("window.written = []")
        page.select_option("#theme", "dark")
        page.select_option("#theme", "calm")  # every chart is drawn anew
        page.wait_for_timeout(200)
        written = dict(page.evaluate("window.written"))
        assert {text: share for text, share in written.items() if share > 1.0} == {}, name
        assert "θ̃ about its mean, arcsec at the output" in written
        assert {"2", "4"} <= set(written) or {"1", "2"} <= set(written), f"orders have no numbers on {name}"


def test_no_name_number_or_legend_is_cut_off_on_any_screen(page: Page, station: Puppet) -> None:
    _running(station)
    in_state(page, "running")
    t, n = np.linspace(0.0, 60.0, 2000), 2000
    rows = {"motor_angle": 150_000.0 - 60 * t, "speed": -0 * t - 599.6, "tau_m": 0 * t - 4.6, "tau_l": 0 * t - 44.05}
    station.show({"t": t, **rows, "kinematic_error": np.zeros(n), "following": np.zeros(n)})
    page.wait_for_selector("[data-tile=speed]:has-text('599.6')")
    for name, (width, height) in {**SCREENS, **NARROW}.items():
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(200)
        assert page.evaluate(CUT, WORDS) == [], name


@pytest.mark.parametrize("fault", some(["following error 12.4 deg", None], 1))
def test_what_says_stale_covers_nothing_and_moves_no_halt(page: Page, station: Puppet, fault: str | None) -> None:
    station.tell(state="fault" if fault else "running", bench=BENCH, run=RUN, fault=fault)
    in_state(page, "fault" if fault else "running")
    for name, (width, height) in {**SCREENS, **NARROW}.items():
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_selector("#stale", state="hidden")
        before = page.locator("#halt").bounding_box()
        station.silent = True
        page.wait_for_selector("#stale", state="visible")
        assert page.evaluate(COVERED) == [], name
        assert page.evaluate(SCROLLS) == [False, False], name
        assert page.locator("#halt").bounding_box() == before, name
        station.silent = False


def test_every_button_and_field_is_large_enough_for_a_finger(page: Page, station: Puppet) -> None:
    _running(station)
    in_state(page, "running")
    for width, height in SCREENS.values():
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(100)
        for element in page.locator("button:visible, input:visible, select:visible").all():
            box = element.bounding_box()
            assert box, element
            said = f"{element.get_attribute('id')} {element.text_content()}: {box}"
            assert box["height"] >= TOUCH, said
            assert box["width"] >= TOUCH, said


def test_every_number_of_a_run_has_a_unit(page: Page, station: Puppet) -> None:
    _running(station)
    in_state(page, "running")
    t = np.linspace(0.0, 1.0, 50)
    station.show({"t": t, "motor_angle": 60 * t, "speed": 0 * t + 9.6, "tau_m": 0 * t + 0.33, "tau_l": 0 * t + 1.05})
    page.wait_for_selector("[data-tile=speed]:has-text('9.6')")
    for tile in page.locator(".tile .value").all():
        said = tile.text_content() or ""
        assert re.fullmatch(rf"[−\d.]+( / [\d.]+)?\u00a0{UNITS}", said), said
    assert re.search(r"25 % .*50\W?s of at most 3\W?min 20\W?s .*2\W?min 30\W?s left", text(page, "#run-time"))


def test_what_was_not_measured_is_a_dash_and_not_a_zero(page: Page, station: Puppet) -> None:
    station.tell(state="running", bench=BENCH, run={**RUN, "peak_to_peak_arcsec": None})
    in_state(page, "running")
    station.show({"t": np.linspace(0.0, 1.0, 50), "speed": np.full(50, 9.6)})  # no torque sensor
    page.wait_for_selector("[data-tile=speed]:has-text('9.6')")
    assert text(page, "[data-tile=shaft] .value") == "—"
    assert text(page, "[data-tile=peak] .value") == "—"


def test_what_a_run_asks_for_is_in_sight_before_it_starts_without_opening_anything(page: Page, station: Puppet) -> None:
    station.tell(state="ready", bench=BENCH)
    in_state(page, "ready")
    page.wait_for_selector("#margins .sums")
    for name, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        for button in page.locator("button[data-panel=measure]:visible").all():  # a tablet shows one panel at a time
            button.click()
        said = [" ".join(row.inner_text().split()) for row in page.locator("#margins li").all()]
        assert any(re.search(r"travel 1440 of 144000 deg", row) for row in said), said
        assert said[-1] == ("stored energy ≤ 0.00062 J duration ≤ 3 min 21 s tightest margin motor speed, 98 %")
        place = page.locator("#margins").evaluate(
            "box => [box.scrollHeight, box.clientHeight, box.scrollWidth, box.clientWidth]"
        )
        assert place[0] <= place[1], f"{name}: cut off"
        assert place[2] <= place[3], f"{name}: cut off"


def test_a_torque_near_its_limit_is_marked(page: Page, station: Puppet) -> None:
    _running(station)
    in_state(page, "running")
    station.show({"t": np.linspace(0.0, 1.0, 50), "tau_m": np.full(50, 4.6), "speed": np.full(50, 9.6)})
    page.wait_for_selector("[data-tile=motor].abnormal")
    assert page.locator(".tile.abnormal").count() == 1


def test_everything_is_reached_by_the_keyboard_and_where_the_focus_is_can_be_seen(page: Page, station: Puppet) -> None:
    station.tell(state="ready", bench=BENCH)
    in_state(page, "ready")
    reached = set()
    for _ in range(45):
        page.keyboard.press("Tab")
        name, outline = page.evaluate(
            "[document.activeElement.id || document.activeElement.dataset.act || '', "
            "getComputedStyle(document.activeElement).outlineWidth]"
        )
        assert name in ("", "chooser") or outline != "0px", name
        reached.add(name)
    assert {"halt", "hold", "stop", "prove", "chosen", "start", "note-text", "tab-runs", "theme"} <= reached
    page.keyboard.press("Alt+2")
    page.wait_for_selector("#view-runs", state="visible")
    page.keyboard.press("Alt+1")
    page.focus("#start")
    page.keyboard.press("Enter")
    until(lambda: [act["act"] for act in station.acts] == ["start"], "start")


def test_text_stands_out_from_its_ground_in_every_look(page: Page, station: Puppet) -> None:
    station.tell(state="fault", bench=BENCH, fault="following error 12.4 deg", proof="ratio 49.994")
    in_state(page, "fault")
    for look, least in (("calm", 4.5), ("dark", 4.5), ("contrast", 7.0)):  # contrast of WCAG AA, AAA
        page.select_option("#theme", look)
        for selector in (
            "#state",
            "#fault",
            "#halt b",
            ".tile dt",
            ".tile .basis",
            ".summary",
            "#steps .said",
            "#bench",
        ):
            assert _contrast(page, selector) >= least, f"{selector} in {look}"


def _contrast(page: Page, selector: str) -> float:
    """Of the text to the nearest ground behind it that is painted, WCAG 2."""
    ink, ground = page.locator(selector).first.evaluate(PAINTED)
    high, low = sorted((_luminance(ink), _luminance(ground)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def _luminance(colour: str) -> float:
    parts = [int(x) / 255 for x in re.findall(r"\d+", colour)[:3]]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
