"""The person at the terminal: asked in a sentence, heard by Enter; no terminal, no answer and Ctrl-C are told apart."""

from __future__ import annotations

import io
import os
import pty
import sys
from collections.abc import Iterator

import pytest

from rig.bench import Bench
from rig.commands.campaign import refuse_nobody
from rig.commands.person import Person
from rig.core.errors import Ended, Exit, NotReady
from rig.core.operator import HangWeight
from rig.process.interrupts import Interrupts
from tests.campaign.plans import LOADED, REST, campaign

CHANGE = HangWeight(5.0)


@pytest.fixture
def keyboard(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The other end of the terminal that is standard input."""
    ours, theirs = pty.openpty()
    with open(theirs) as terminal:
        monkeypatch.setattr(sys, "stdin", terminal)
        yield ours
    os.close(ours)


def test_enter_means_done_and_the_sentence_says_what_to_do(keyboard: int, capsys: pytest.CaptureFixture[str]) -> None:
    os.write(keyboard, b"\n")
    Person(Interrupts()).make(CHANGE)
    assert "Now hang 5 N·m on the output, pulling forward." in capsys.readouterr().err


def test_no_means_that_it_cannot_be_done(keyboard: int) -> None:
    os.write(keyboard, b"n\n")
    with pytest.raises(NotReady, match="the operator could not do this: hang 5 N·m"):
        Person(Interrupts()).make(CHANGE)


def test_ctrl_c_while_asked_ends_it_with_the_operators_exit_code(keyboard: int) -> None:
    interrupts = Interrupts()
    interrupts.request()
    with pytest.raises(Ended) as ended:
        Person(interrupts).make(CHANGE)
    assert ended.value.exit is Exit.STOPPED


def test_without_a_terminal_nobody_can_be_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("\n"))
    with pytest.raises(NotReady, match="standard input is no terminal"):
        Person(Interrupts()).make(CHANGE)


def test_who_hung_the_wrong_weight_may_try_once_more_or_end_it(
    keyboard: int, capsys: pytest.CaptureFixture[str]
) -> None:
    os.write(keyboard, b"\nn\n")
    assert Person(Interrupts()).again("it is another weight")
    assert not Person(Interrupts()).again("it is another weight")
    assert "it is another weight" in capsys.readouterr().err


def test_a_campaign_that_needs_a_hand_is_refused_where_nobody_can_be_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("\n"))
    real = campaign(REST, LOADED)
    refuse_nobody(real, [0, 1])  # the twin has a hand of its own
    monkeypatch.setattr(Bench, "simulated", False)
    refuse_nobody(real, [0])
    with pytest.raises(NotReady, match="needs somebody to hang 2 N·m"):
        refuse_nobody(real, [0, 1])
