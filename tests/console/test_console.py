"""The console's API with the real control process behind it, on the twin: every act, every way it is refused."""

from __future__ import annotations

import json
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed

from rig.console.columns import COLUMNS, HEADER, MAGIC
from rig.runfile.events import read_events
from rig.runfile.manifest import read
from tests.console.hand import FOREVER, SHORT, Hand
from tests.some import some

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("console")]  # one station for all of them


@pytest.fixture
def hand(tmp_path: Path) -> Iterator[Hand]:
    with Hand(tmp_path) as made:
        yield made


@pytest.fixture(scope="module")
def ready(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hand]:
    """Connected to the twin on a virtual clock, proven; whoever uses it leaves it so."""
    with Hand(tmp_path_factory.mktemp("runs")) as made:
        made.connect()
        made.prove()
        yield made


def test_a_whole_run_from_start_to_report(ready: Hand) -> None:
    ready.finish("start", procedure="kinematic-error", parameters=SHORT, note="by <hand> & π")
    state = ready.until(lambda s: s["last_run"]["report"])
    last = state["last_run"]
    assert last["status"] == "completed"
    assert "arcsec" in last["sentence"]
    folder = Path(last["folder"])
    assert read(folder)["status"] == "completed"
    assert read(folder)["conditions"]["note"] == "by <hand> & π"
    page = ready.client.get(last["report"], params={"token": ready.token})
    assert page.status_code == 200
    assert "SIMULATED" in page.text
    assert "sandbox" in page.headers["content-security-policy"]


def test_the_runs_that_were_made_are_listed_newest_first(ready: Hand) -> None:
    ready.finish("jog", turns=0.25, speed_rpm=30)
    rows = ready.client.get("/api/runs").json()["runs"]
    assert rows[0]["simulated"]
    assert rows[0]["started_utc"] >= rows[-1]["started_utc"]
    assert ready.client.get(f"/api/runs/{rows[0]['uid']}").json()["path"] == rows[0]["path"]
    assert ready.client.get("/api/runs", params={"status": "tripped"}).json()["runs"] == []
    refused = ready.client.get("/api/compare", params={"run": ["/etc", "/etc"]})
    assert (refused.status_code, "is not in" in refused.json()["why"]) == (400, True)


def test_the_same_id_is_done_once_and_answered_twice(ready: Hand) -> None:
    body = {"id": str(uuid.uuid4()), "based_on": ready.state()["revision"], "act": "note", "text": "once"}
    first, second = (ready.client.post("/api/act", json=body) for _ in range(2))
    assert first.json() == second.json()
    assert first.status_code == 200
    ready.until(lambda s: any(e["text"] == "once" for e in s["events"]))
    assert ready.told("note").count("once") == 1


def test_the_id_of_another_act_is_refused(ready: Hand) -> None:
    body = {"id": str(uuid.uuid4()), "based_on": ready.state()["revision"], "act": "note", "text": "once"}
    assert ready.client.post("/api/act", json=body).status_code == 200
    before = ready.state()["revision"]
    said = ready.client.post("/api/act", json={**body, "act": "prove", "based_on": before})
    assert (said.status_code, "that of another act, 'note'" in said.json()["why"]) == (409, True)
    assert before <= said.json()["revision"] <= ready.state()["revision"]  # another moment: a state may come between


@pytest.mark.parametrize("id", some([None, "of the start", "42", 42, "", ["x"], "halted before"], 3))
@pytest.mark.parametrize("act", ["stop", "halt"])
def test_stop_and_halt_are_done_whatever_the_id(ready: Hand, act: str, id: Any) -> None:
    start = str(uuid.uuid4())
    given = start if id == "of the start" else id
    if id == "halted before":
        assert ready.client.post("/api/act", json={"id": id, "act": act}).status_code == 200
    ready.do("start", id=start, procedure="kinematic-error", parameters=FOREVER)
    ready.until(lambda s: s["run"] and s["run"]["t"] > 1.0)
    said = ready.client.post("/api/act", json={"id": given, "act": act})
    assert (said.status_code, said.json()["accepted"]) == (200, True)
    assert ready.until(lambda s: not s["job"])["last_run"]["status"] == "stopped"


def test_a_second_click_on_the_same_state_is_refused_and_starts_nothing(ready: Hand) -> None:
    revision = ready.state()["revision"]
    more = {"based_on": revision, "procedure": "standstill", "parameters": {"duration": 1.0}}
    first, second = (ready.ask("start", **more) for _ in range(2))
    assert (first[0], second[0]) == (200, 409)
    assert "the state has changed" in second[1]["why"]
    ready.until(lambda s: not s["job"])


def last_uid(hand: Hand) -> str | None:
    """Of the last run, whose analysis may still be under way."""
    last = hand.state()["last_run"]
    return None if last is None else str(last["uid"])


def test_wrong_parameters_are_refused_with_their_sentence_before_anything_moves(ready: Hand) -> None:
    before = last_uid(ready)
    status, said = ready.ask("start", procedure="kinematic-error", parameters={"cycles": 0.3})
    assert (status, "expected a multiple of 0.5" in said["why"]) == (409, True)
    status, said = ready.ask("start", procedure="kinematic-error", parameters={"frequency": 5.0})
    assert (status, "the bench allows" in said["why"]) == (409, True)
    status, said = ready.ask("jog", turns=1000)
    assert (status, "expected up to 10 turns" in said["why"]) == (409, True)
    assert last_uid(ready) == before


def test_an_unknown_key_is_refused_with_the_known_ones_before_anything_moves(ready: Hand) -> None:
    before = last_uid(ready)
    status, said = ready.ask("start", procedure="kinematic-error", with_=SHORT)
    assert (status, "unknown key 'with_'; known keys" in said["why"]) == (409, True)
    status, said = ready.ask("jog", turns=0.25, rpm=10)
    assert (status, "did you mean 'speed_rpm'?" in said["why"]) == (409, True)
    looked = ready.client.post("/api/check-parameters", json={"procedure": "friction", "parameter": {}}).json()
    assert "did you mean 'parameters'?" in looked["problems"]["*"]
    assert last_uid(ready) == before
    assert ready.state()["job"] == ""


def test_only_one_page_holds_control_and_it_can_be_taken(ready: Hand) -> None:
    status, said = ready.ask("note", page="second", text="me too")
    assert (status, "another page holds control" in said["why"]) == (409, True)
    assert ready.ask("stop", page="second")[0] == 200
    assert ready.ask("halt", page="second")[0] == 200
    assert ready.ask("take_control", page="second")[0] == 200
    assert ready.state()["controller"] == "other"
    assert "another page holds control" in ready.state()["allowed"]["start"]
    assert "another page has taken control" in ready.told("said")
    assert ready.ask("take_control")[0] == 200
    assert ready.state()["controller"] == "this"


@pytest.mark.parametrize("content", [
    b"", b"[]", b"null", b"{", b"\xff\xfe", b'"halt"', b"[" * 60_000, b'{"act": "note", "text": "' + b"x" * 70_000,
    rb'{"procedure": "jog", "parameters": {"turns": "\ud800"}}',
])  # fmt: skip
def test_a_body_that_is_no_act_is_refused_and_does_nothing(ready: Hand, content: bytes) -> None:
    said = ready.client.post("/api/act", content=content)
    assert said.status_code == (413 if len(content) > 65_536 else 400)
    assert said.json()["accepted"] is False
    assert ready.client.post("/api/check-parameters", content=content).status_code == said.status_code


@pytest.mark.parametrize("hostile", [
    "<img src=x onerror=alert(1)>", "'; rm -rf /; '", "../../etc/passwd", "\x00\x1b[2J", "\u202e", "𝒾" * 500,
    {"a": 1}, [1], 1e308, True, None,
])  # fmt: skip
def test_hostile_values_in_every_field_are_refused_or_kept_as_they_are(ready: Hand, hostile: Any) -> None:
    for act, field in [("start", "procedure"), ("start", "parameters"), ("campaign", "plan"), ("campaign", "resume"),
                       ("connect", "bench"), ("jog", "turns"), ("answer", "prompt_id"), ("sudo", "x")]:  # fmt: skip
        if (act, hostile) in (("jog", None), ("campaign", None)):
            continue  # nothing given: the default
        status, said = ready.ask(act, **{field: hostile})
        if status == 200:  # taken, then refused by the control process, with its reason
            ready.until(lambda s: not s["job"])
        assert status == 409 or act == "campaign", said
    assert ready.ask("note", text=hostile)[0] in (200, 409)
    assert ready.state()["state"] == "ready"


@pytest.mark.parametrize("path", [
    "/runs/../../etc/passwd", "/runs/%2e%2e/%2e%2e/etc/passwd", "/runs//etc/passwd", "/runs/x%00/report.html",
    "/static/../access.py", "/static/%2e%2e/access.py", "/runs/manifest.json",
])  # fmt: skip
def test_no_file_but_reports_below_the_folder_can_be_had(ready: Hand, path: str) -> None:
    assert ready.client.get(path).status_code == 404


def test_nothing_is_told_or_done_without_the_token(ready: Hand) -> None:
    for wrong in ({"x-hdrig-token": ""}, {"x-hdrig-token": ready.token[:-1]}):
        for path in ("/api/state", "/api/catalogue", "/api/runs", "/runs/x/report.html"):
            assert ready.client.get(path, headers=wrong).status_code == 401
        assert ready.client.post("/api/act", json={"act": "halt"}, headers=wrong).status_code == 401
    assert ready.client.get("/", headers={"x-hdrig-token": ""}).status_code == 200  # the page itself holds no secret


@pytest.mark.parametrize(
    "wrong", [{"origin": "http://evil.example"}, {"origin": "null"}, {"host": "evil.example:8765"}]
)
def test_another_origin_or_host_is_refused_even_with_the_token(ready: Hand, wrong: dict[str, str]) -> None:
    assert ready.client.post("/api/act", json={"act": "stop"}, headers=wrong).status_code == 403
    assert ready.client.get("/api/state", headers=wrong).status_code == 403
    assert ready.client.get("/", headers=wrong).status_code == 403


def test_every_answer_says_what_its_page_may_load(ready: Hand) -> None:
    for path in ("/", "/api/state", "/nowhere"):
        headers = ready.client.get(path).headers
        assert "default-src 'none'" in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"


def test_a_page_hears_states_and_samples_with_their_age(ready: Hand) -> None:
    with ready.listen() as page:
        page.send(json.dumps({"token": ready.token, "page": "first"}))
        states, frames = [], []
        while len(states) < 5 or len(frames) < 10:
            message = page.recv()
            if isinstance(message, str):
                states.append(json.loads(message))
                page.send(json.dumps({"seen": states[-1]["seq"]}))
            else:
                frames.append(message)
    assert [s["seq"] for s in states] == sorted({s["seq"] for s in states})
    assert states[-1]["live"]["columns"] == [{"name": n, "unit": u} for n, u in COLUMNS]
    assert all(HEADER.unpack_from(f)[0] == MAGIC for f in frames)
    assert states[-1]["age_ms"] < 5000.0


@pytest.mark.parametrize(
    "first", ["[" * 20_000, "", "{}", "x", "[]", '{"token": null}', '{"token": "wrong", "page": "a"}']
)
def test_a_websocket_without_the_token_hears_nothing(ready: Hand, first: str) -> None:
    with ready.listen() as page:
        page.send(first)
        with pytest.raises(ConnectionClosed) as closed:
            page.recv()
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == 4401


def test_a_prompt_is_answered_by_the_page_and_believed_only_when_the_sensors_show_it(ready: Hand) -> None:
    ready.do("start", procedure="lock-check", parameters={})
    prompt = ready.prompt("fit the lock pin of the output")
    assert ready.ask("answer", prompt_id="another", done=True)[0] == 409
    ready.do("answer", prompt_id=prompt["id"], done=True)
    state = ready.until(lambda s: not s["job"])
    assert state["rigging"]["output_locked"]
    assert any(text.startswith("the output is locked: the motor turned") for text in ready.told("finding"))
    assert ready.state()["allowed"]["jog"] == "the output is locked"
    ready.do("start", procedure="standstill", parameters={"duration": 0.5})  # needs it free: asked for again
    ready.made("remove the lock pin")
    assert not ready.until(lambda s: not s["job"])["rigging"]["output_locked"]


def test_a_change_that_could_not_be_made_is_made_sure_before_the_next_run(ready: Hand) -> None:
    ready.do("start", procedure="lock-check", parameters={})
    ready.do("answer", prompt_id=ready.prompt("fit the lock pin")["id"], done=False)
    state = ready.until(lambda s: not s["job"])
    assert state["unsure"] == "fit the lock pin of the output"
    assert "the operator could not do this" in ready.told("refused")[-1]
    ready.do("start", procedure="standstill", parameters={"duration": 0.5})
    ready.made("remove the lock pin of the output")
    assert ready.until(lambda s: not s["job"])["unsure"] == ""


def test_halting_a_prompt_ends_what_was_asked_for(ready: Hand) -> None:
    ready.do("start", procedure="lock-check", parameters={})
    ready.prompt()
    ready.do("halt")
    state = ready.until(lambda s: not s["job"])
    assert state["prompt"] is None
    ready.do("start", procedure="standstill", parameters={"duration": 0.2})
    ready.made("remove the lock pin")
    assert ready.until(lambda s: not s["job"])["last_run"]["status"] == "completed"


@pytest.mark.parametrize(
    ("act", "status", "word"), [("stop", "stopped", "brought to rest"), ("halt", "stopped", "at once")]
)
def test_a_run_that_is_ended_closes_its_folder_and_leaves_no_torque(
    ready: Hand, act: str, status: str, word: str
) -> None:
    ready.do("start", procedure="kinematic-error", parameters=FOREVER)
    ready.until(lambda s: s["run"] and s["run"]["t"] > 1.0)
    ready.do(act)
    state = ready.until(lambda s: not s["job"])
    last = state["last_run"]
    assert (last["status"], state["state"]) == (status, "ready")
    assert word in last["reason"]
    about = read(Path(last["folder"]))
    assert about["status"] == status
    assert any(event["kind"] == "operator" for event in read_events(Path(last["folder"])))


def test_a_hold_is_kept_until_a_stop(ready: Hand) -> None:
    ready.do("start", procedure="kinematic-error", parameters=FOREVER)
    ready.until(lambda s: s["run"] and s["run"]["t"] > 1.0)
    ready.do("hold")
    assert ready.until(lambda s: s["state"] == "holding")["run"]["left_s"] is None, "it does not go on"
    ready.do("note", text="held to look at the coupling")
    ready.do("stop")
    state = ready.until(lambda s: not s["job"])
    assert state["last_run"]["status"] == "stopped"
    texts = [event["text"] for event in read_events(Path(state["last_run"]["folder"]))]
    assert "held to look at the coupling" in texts


def test_hold_stop_and_halt_are_accepted_in_every_state_and_twice(hand: Hand) -> None:
    for act in ("hold", "stop", "halt", "hold", "stop", "halt"):
        hand.do(act)
    hand.connect()
    for act in ("halt", "stop", "hold", "halt"):
        status, said = hand.ask(act)
        assert (status, said["seen_by_loop_ms"]) == (200, None), "no loop runs"
    hand.until(lambda s: any("halted while nothing ran" in e["text"] for e in s["events"]))
    hand.prove()  # what was pressed before is over and done
    hand.finish("disconnect")
    assert hand.ask("halt")[0] == 200
    assert hand.state()["state"] == "disconnected"


def test_a_trip_is_told_in_words_and_left_only_by_a_reset(hand: Hand) -> None:
    hand.connect(overrides=("limits.following_deg=0.01", "limits.following_s=0.0"))
    state = hand.finish("prove")
    assert state["state"] == "fault"
    assert "behind its reference" in state["fault"]
    assert "reset" in state["advice"]
    assert state["last_run"]["status"] == "tripped"
    status, said = hand.ask("start", procedure="kinematic-error", parameters=SHORT)
    assert (status, "the rig is in fault" in said["why"]) == (409, True)
    assert hand.finish("reset")["state"] == "connected"


@pytest.mark.long
def test_the_doctor_is_heard_with_and_without_a_bench(hand: Hand) -> None:
    names = [c["name"] for c in hand.finish("check", bench="twin")["checks"]]
    assert "disk" in names
    hand.connect()
    state = hand.finish("check")
    assert {"disk", "drive", "load_encoder"} <= {c["name"] for c in state["checks"]}
    assert all(c["text"] and c["health"] in ("good", "doubtful", "bad") for c in state["checks"])


def test_a_clock_that_is_none_is_refused(hand: Hand) -> None:
    status, said = hand.ask("connect", bench="twin", clock="virtul")
    assert (status, said["why"]) == (409, "clock is 'virtul'; expected wall or virtual")


def test_a_bench_that_is_not_there_is_refused_with_its_sentence(hand: Hand) -> None:
    hand.finish("connect", bench="twin-can", overrides=["bus.rig.channel=/nowhere/can"])
    assert "could not be opened" in hand.told("refused")[-1]
    assert hand.state()["allowed"]["connect"] is True


PLAN = """schema = "hdrig.plan/1"
name = "short"
[[step]]
procedure = "standstill"
with = { duration = 1.0 }
[[step]]
procedure = "lock-check"
"""


@pytest.mark.long
def test_a_campaign_is_stopped_at_a_prompt_and_gone_on_with(hand: Hand, tmp_path: Path) -> None:
    plan = tmp_path / "short.toml"
    plan.write_text(PLAN, encoding="utf-8")
    hand.connect()
    hand.do("campaign", plan=str(plan))
    state = hand.until(lambda s: s["prompt"])
    campaign = state["campaign"]
    assert (campaign["done"], campaign["total"], campaign["plan"]) == (1, 2, "short")
    hand.do("stop")
    hand.until(lambda s: not s["job"])
    assert "campaign stopped" in hand.told("said")[-1]
    (left,) = hand.client.get("/api/campaigns").json()["campaigns"]
    assert (left["folder"], left["plan"], left["done"], left["total"]) == (campaign["folder"], "short", 1, 2)
    checked = hand.client.post("/api/check-parameters", json={"resume": left["folder"]}).json()
    assert checked["ok"] is True
    assert any("lock-check" in line for line in checked["plan"]), checked
    other = hand.client.post("/api/check-parameters", json={"resume": left["folder"], "bench": "twin-can"}).json()
    assert "the bench is not the one this campaign began with" in other["problems"]["*"]
    hand.do("campaign", resume=left["folder"], note="after lunch")
    for text in ("remove the lock pin", "fit the lock pin", "remove the lock pin"):
        hand.made(text)
    hand.until(lambda s: not s["job"])
    assert "campaign completed: 2 done" in hand.told("said")[-1]
    book = json.loads((Path(campaign["folder"]) / "campaign.json").read_text(encoding="utf-8"))
    assert [run["status"] for run in book["runs"]] == ["done", "done"]
    assert book["note"] == "after lunch"
    assert hand.client.get("/api/campaigns").json()["campaigns"] == []


@pytest.mark.parametrize(
    ("folder", "why"),
    [
        ("/etc", "is not in"),
        ("../..", "is not in"),
        ("{root}", "no campaign.json"),
        ("{root}/\0", "is not in"),
        (7, "resume is '7'; expected a text"),
    ],
)
def test_a_campaign_that_is_none_of_ours_is_not_gone_on_with(ready: Hand, folder: Any, why: str) -> None:
    named = folder.replace("{root}", str(ready.serving.console.link.root)) if isinstance(folder, str) else folder
    status, said = ready.ask("campaign", resume=named)
    assert status == 409
    assert why in said["why"]


def test_a_tare_says_the_zero_of_the_torque_sensor(ready: Hand) -> None:
    assert "N·m" in ready.finish("tare")["tare"]
    assert any(text.startswith("zero of the torque sensor") for text in ready.told("finding"))
