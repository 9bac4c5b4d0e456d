"""Switches in shared memory, and the interrupts that look at them."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.core.errors import Exit, NotReady
from rig.live.switches import Switches
from rig.station.interrupts import Panel


@pytest.fixture
def pressed() -> Iterator[Switches]:
    made = Switches.create()
    yield made
    made.unlink()
    made.close()


@pytest.fixture
def panel(pressed: Switches) -> Panel:
    return Panel(Switches.attach(pressed.path))


def test_nothing_is_asked_for_at_first(panel: Panel) -> None:
    assert (panel.count, panel.held, panel.exit) == (0, False, Exit.PASS)


def test_a_stop_is_one_and_a_second_stop_is_no_halt(pressed: Switches, panel: Panel) -> None:
    pressed.stop()
    pressed.stop()
    assert panel.count == 1
    assert panel.exit is Exit.STOPPED


def test_a_halt_is_a_halt_whatever_came_before(pressed: Switches, panel: Panel) -> None:
    pressed.stop()
    pressed.halt()
    assert panel.count == 2
    assert panel.exit is Exit.HALTED


def test_what_a_key_would_call_counts_too(panel: Panel) -> None:
    panel.stop()
    assert panel.count == 1
    panel.halt()
    assert panel.count == 2


def test_a_stop_by_key_is_over_with_the_next_act(pressed: Switches, panel: Panel) -> None:
    """As a hold is one that no loop could hold: the run after it was stopped before it began."""
    panel.stop()
    panel.arm(pressed.pressed)
    assert panel.count == 0


def test_a_hold_is_held_until_the_next_act(pressed: Switches, panel: Panel) -> None:
    pressed.hold()
    assert panel.held
    panel.arm(pressed.pressed)
    assert not panel.held


def test_what_was_pressed_before_an_act_was_accepted_does_not_end_it(pressed: Switches, panel: Panel) -> None:
    pressed.stop()
    pressed.halt()
    accepted = pressed.pressed
    panel.arm(accepted)
    assert panel.count == 0


def test_a_halt_between_acceptance_and_the_first_tick_counts(pressed: Switches, panel: Panel) -> None:
    accepted = pressed.pressed
    pressed.halt()
    panel.arm(accepted)
    assert panel.count == 2


def test_who_looks_says_what_was_seen(pressed: Switches, panel: Panel) -> None:
    pressed.halt()
    assert pressed.seen.halt == 0
    assert panel.count == 2
    assert pressed.seen == pressed.pressed


def test_two_signals_are_a_halt_as_on_a_terminal(panel: Panel) -> None:
    with panel:
        signal.raise_signal(signal.SIGTERM)
        assert (panel.count, panel.signalled) == (1, True)
        signal.raise_signal(signal.SIGTERM)
        assert panel.count == 2


def test_ctrl_backslash_is_a_halt_as_on_a_terminal(panel: Panel) -> None:
    with panel:
        signal.raise_signal(signal.SIGQUIT)
        assert (panel.count, panel.signalled) == (2, True)


def test_a_lost_page_is_a_stop_that_says_so_and_stays_one(pressed: Switches, panel: Panel) -> None:
    panel.arm(pressed.pressed, page_lost_s=0.02)
    assert panel.count == 0
    time.sleep(0.03)  # longer than a page may be away
    assert panel.count == 1
    assert "no page had been seen for 0.02 s" in panel.who
    pressed.page_alive()
    assert panel.count == 1, "what was begun to be stopped is not gone on with"


def test_a_motor_that_is_held_is_stopped_once_nobody_can_let_go_of_it(pressed: Switches, panel: Panel) -> None:
    """Where the bench says `continue` it was held with torque on for ever when the page's server had died."""
    panel.arm(pressed.pressed)
    panel.left_alone()
    assert panel.count == 0, "a run goes on to its own end, as the bench says"
    pressed.hold()
    panel.left_alone()
    assert panel.count == 1
    assert "server is gone" in panel.who


def test_a_page_that_gives_signs_of_life_is_not_lost(pressed: Switches, panel: Panel) -> None:
    panel.arm(pressed.pressed, page_lost_s=30.0)
    pressed.page_alive()
    assert panel.count == 0
    assert pressed.page_age < 30.0


def test_a_page_may_sleep_while_somebody_works_by_hand(pressed: Switches, panel: Panel) -> None:
    panel.arm(pressed.pressed, page_lost_s=0.02)
    with panel.unwatched():
        time.sleep(0.03)
        assert panel.count == 0
        pressed.stop()
        assert panel.count == 1, "a stop is a stop all the same"
    panel.arm(pressed.pressed, page_lost_s=0.02)
    with panel.unwatched():
        pass
    assert panel.count == 1, "afterwards a page is wanted again"


def test_a_bench_that_says_continue_never_loses_its_page(pressed: Switches, panel: Panel) -> None:
    panel.arm(pressed.pressed)
    time.sleep(0.01)
    assert panel.count == 0


@pytest.mark.parametrize("content", [b"", b"x" * 4096, b"hdrigSWI"])
def test_what_is_no_page_of_switches_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.switches"
    path.write_bytes(content)
    with pytest.raises(NotReady, match="no page of switches"):
        Switches.attach(path)
