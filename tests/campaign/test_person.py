"""The person at the terminal: asked in a sentence, heard by Enter; no terminal, no answer and Ctrl-C are told apart."""

from __future__ import annotations

import io
import os
import pty
import sys
from collections.abc import Iterator

import pytest

from rig.commands.person import NotMade, Person
from rig.core.errors import Exit, NotReady
from rig.core.operator import HangWeight
from rig.interrupts import Interrupts

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
    with pytest.raises(NotMade) as ended:
        Person(interrupts).make(CHANGE)
    assert ended.value.exit is Exit.STOPPED


def test_without_a_terminal_nobody_can_be_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("\n"))
    with pytest.raises(NotReady, match="standard input is no terminal"):
        Person(Interrupts()).make(CHANGE)
