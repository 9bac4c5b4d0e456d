"""Each act once, on the state it was based on, by the page that holds control."""

from __future__ import annotations

import uuid
from typing import Any

import pytest

from rig.console.bodies import OF_ACT
from rig.console.gate import CONTROL, Answer, Gate
from rig.station.rules import ACTS, ALWAYS, allowed
from rig.station.status import Status

IDLE = allowed(Status().picture())


def asked(act: str, based_on: int | None = 1, **more: Any) -> dict[str, Any]:
    return {"id": str(uuid.uuid4()), "act": act, "based_on": based_on, **more}


def test_an_act_on_the_present_revision_passes() -> None:
    assert Gate().refuse(asked("connect"), "a", IDLE) == ""


@pytest.mark.parametrize("based_on", [0, 2, None, "1", 1.5, [], {}])
def test_an_act_based_on_anything_else_is_refused_with_both_numbers(based_on: Any) -> None:
    why = Gate().refuse(asked("connect", based_on), "a", IDLE)
    assert "the state has changed" in why
    assert "it is 1" in why


def test_the_second_click_is_based_on_what_was_before_the_first() -> None:
    gate = Gate()
    assert gate.refuse(asked("connect"), "a", IDLE) == ""
    gate.passed()
    assert "the state has changed" in gate.refuse(asked("connect"), "a", IDLE)


@pytest.mark.parametrize("act", ALWAYS)
def test_hold_stop_and_halt_pass_on_any_revision(act: str) -> None:
    assert Gate().refuse(asked(act, based_on=-7), "a", IDLE) == ""


@pytest.mark.parametrize(("act", "key", "said"), [
    ("start", "with_", "start: unknown key 'with_'; known keys (beside id, act, based_on): procedure, para"),
    ("start", "parameter", "did you mean 'parameters'?"),
    ("connect", "override", "did you mean 'overrides'?"),
    ("jog", "turn", "did you mean 'turns'?"),
    ("campaign", "with", "known keys (beside id, act, based_on): plan, resume, parameters, note"),
    ("take_control", "force", "known keys (beside id, act, based_on): none of its own"),
])  # fmt: skip
def test_a_key_an_act_does_not_have_is_refused_with_those_it_has(act: str, key: str, said: str) -> None:
    assert said in Gate().refuse(asked(act, **{key: 1}), "a", IDLE | {act: True})


@pytest.mark.parametrize(("act", "key", "value", "said"), [
    ("connect", "overrides", 5, "connect: overrides is '5'; expected a list of texts, KEY=VALUE"),
    ("connect", "overrides", [{"a": 1}], "expected a list of texts, KEY=VALUE"),
    ("connect", "bench", {"a": 1}, "expected a text"),
    ("note", "text", 5, "note: text is '5'; expected a text"),
    ("start", "parameters", ["cycles=1"], "expected a table of names and values"),
])  # fmt: skip
def test_a_key_that_holds_another_kind_of_thing_is_refused(act: str, key: str, value: Any, said: str) -> None:
    assert said in Gate().refuse(asked(act, **{key: value}), "a", IDLE | {act: True})
    assert Gate().refuse(asked(act, **{key: None}), "a", IDLE | {act: True}) == ""


def test_every_act_says_which_keys_it_has_but_those_that_are_always_done() -> None:
    assert set(OF_ACT) == {*ACTS, CONTROL} - set(ALWAYS)


@pytest.mark.parametrize("act", ALWAYS)
def test_hold_stop_and_halt_pass_whatever_else_is_said(act: str) -> None:
    assert Gate().refuse(asked(act, wiht=1), "a", IDLE) == ""


@pytest.mark.parametrize("act", ["stop", "halt"])
def test_every_page_may_stop_and_halt(act: str) -> None:
    assert Gate(controller="a").refuse(asked(act), "b", IDLE) == ""


@pytest.mark.parametrize("act", ["connect", "hold", "start", "jog", "answer", "reset"])
def test_a_page_without_control_may_do_nothing_else(act: str) -> None:
    assert "another page holds control" in Gate(controller="a").refuse(asked(act), "b", IDLE)


def test_control_can_be_taken_and_is_then_the_others_no_more() -> None:
    gate = Gate(controller="a")
    assert gate.refuse(asked("take_control"), "b", IDLE) == ""
    gate.take("b")
    assert gate.holds("b")
    assert not gate.holds("a")
    gate.release("a")  # who has none gives none back
    assert gate.controller == "b"


def test_what_the_rules_do_not_allow_is_refused_with_their_sentence() -> None:
    assert Gate().refuse(asked("start"), "a", IDLE) == "no bench is connected"


@pytest.mark.parametrize("id", [None, "", 7, "x" * 40, "not-a-uuid", ["x"], "0" * 500])
def test_an_act_needs_an_id_that_is_one(id: Any) -> None:
    assert "an id of its own" in Gate().refuse({**asked("connect"), "id": id}, "a", IDLE)


@pytest.mark.parametrize("act", [None, 7, "", "sudo", ["halt"], {"act": "halt"}, "take_control "])
def test_an_unknown_act_is_refused_with_the_list(act: Any) -> None:
    why = Gate().refuse({**asked("x"), "act": act}, "a", IDLE)
    assert "there is no act" in why
    assert "halt" in why


def test_an_id_is_answered_once_and_for_all() -> None:
    gate, first = Gate(), asked("connect")
    assert gate.before(first) is None
    answer = gate.remember(first, Answer.yes())
    gate.passed()
    assert gate.before(first) is answer
    other = gate.before(dict(first, act="disconnect"))
    assert other is not None
    assert (other.status, "another act, 'connect'" in other.body["why"]) == (409, True)


def test_the_memory_of_ids_is_bounded() -> None:
    gate = Gate()
    for _ in range(2000):
        gate.remember(asked("note"), Answer.yes())
    assert len(gate._answers) == 500


def test_what_an_act_lacks_is_named_with_its_key() -> None:
    gate = Gate()
    assert "'id', a UUID" in gate.refuse({"act": "tare"}, "page", {"tare": True})
    act = {"act": "tare", "id": str(uuid.uuid4())}
    assert "'based_on', the revision" in gate.refuse(act, "page", {"tare": True})
    assert gate.refuse({**act, "based_on": gate.revision}, "page", {"tare": True}) == ""
