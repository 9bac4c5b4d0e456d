"""The real server and a real browser against somebody who means harm: pages of others, what may be typed anywhere."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, Page

from tests.console.browser.conftest import Open
from tests.console.browser.look import in_state, until
from tests.console.hand import Hand
from tests.some import some

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]
FOREIGN = ("http://evil.example/", "http://127.0.0.1:9/")  # from outside, and of another program on this machine
ATTACK = """async ({ address, token }) => {
  const act = JSON.stringify({ id: "5f0c54c4-4f3e-4a52-9c8e-0f3cbb4a76a5", based_on: 0, act: "halt" });
  const headers = { "X-Hdrig-Token": token };
  const tried = async (promise) => promise.then((answer) => `${answer.type} ${answer.status}`, () => "failed");
  const heard = (socket) => new Promise((done) => {
    socket.onopen = () => socket.send(JSON.stringify({ token, page: "evil" }));
    socket.onmessage = () => done("heard something");
    socket.onclose = () => done("closed");
  });
  const framed = (frame) => new Promise((done) => {
    frame.onload = () => done(frame.contentDocument?.body.innerHTML ?? "not ours to look into");
    document.body.append(frame);
  });
  return {
    simple: await tried(fetch(`${address}api/act`, { method: "POST", mode: "no-cors", body: act })),
    withToken: await tried(fetch(`${address}api/act`, { method: "POST", headers, body: act })),
    reading: await tried(fetch(`${address}api/state`, { headers })),
    listening: await heard(new WebSocket(`${address.replace("http", "ws")}api/live`)),
    framed: await framed(Object.assign(document.createElement("iframe"), { src: address })),
  };
}"""
TYPED = (
    '<img src=x onerror="window.hit=1"><script>window.hit=1</script>', "'; DROP TABLE runs; --", "../../../etc/passwd",
    "1e309", "-1", "9" * 180, "\u202e\U0001f608", "${7*7}{{7*7}}%n%s",
)  # fmt: skip


@pytest.fixture
def hand(tmp_path: Path) -> Iterator[Hand]:
    with Hand(tmp_path) as made:
        made.connect()
        yield made


@pytest.mark.parametrize("origin", some(FOREIGN, 1))
def test_a_page_of_another_origin_moves_nothing_and_learns_nothing_even_with_the_token(
    hand: Hand, context: BrowserContext, origin: str
) -> None:
    page = context.new_page()
    page.route(f"{origin}**", lambda route: route.fulfill(body="<body>harmless</body>", content_type="text/html"))
    page.goto(origin)
    pressed = hand.serving.console.link.switches.pressed
    found = page.evaluate(ATTACK, {"address": f"http://127.0.0.1:{hand.port}/", "token": hand.token})
    assert found.pop("simple") in ("opaque 0", "failed")  # refused by the server, or by the browser before it
    assert found == {
        "withToken": "failed", "reading": "failed", "listening": "closed",
        "framed": "not ours to look into",
    }  # fmt: skip
    assert hand.serving.console.link.switches.pressed == pressed  # nothing was halted
    assert hand.told("operator") == []


def test_whatever_is_typed_into_any_field_is_refused_in_words_or_does_what_it_says(
    hand: Hand, open_page: Open, wrong: list[str]
) -> None:
    page = open_page(f"http://127.0.0.1:{hand.port}/#token={hand.token}")
    in_state(page, "connected")
    for words in TYPED:
        _everywhere(page, words)
    page.click("#tab-rig")
    assert wrong == []
    assert page.evaluate("window.hit") is None
    assert page.locator("#stale").is_hidden()
    assert hand.state()["state"] == "connected"
    assert not list(hand.serving.console.link.root.glob("*/*/manifest.json"))  # nothing was run
    assert all("Traceback" not in event["text"] for event in hand.state()["events"])


def _everywhere(page: Page, words: str) -> None:
    """Into every field of both views, and each button that uses one pressed; what is asked for by that is refused."""
    page.click("#tab-rig")
    for field in page.locator("#side input:visible, #note input:visible").all():
        field.fill(words)
    for button in ("[data-jog='1']", "[data-jog='-1']", "#start", "[data-act=note]"):
        if page.locator(button).get_attribute("aria-disabled") == "false":
            _pressed(page, button)
    page.click("#tab-runs")
    for field in page.locator("#view-runs input:visible").all():
        field.fill(words)
    page.wait_for_timeout(300)  # the list is asked for 200 ms after the last key


def _pressed(page: Page, button: str) -> None:
    page.evaluate("document.getElementById('answer').textContent = ''")
    page.locator(button).dispatch_event("click")
    until(lambda: page.locator("#answer").text_content() != "", "an answer")
