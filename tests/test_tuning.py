"""What `hdrig tune` asks of gains before it moves anything with them."""

from __future__ import annotations

from unittest.mock import Mock

from rig.bench import read
from rig.core.errors import Exit
from rig.session import Ended
from rig.tuning import as_it_was


def test_gains_that_let_the_loop_swing_up_are_not_tried() -> None:
    session = Mock(spec=())  # nothing can be asked of it
    said = as_it_was(session, read("twin", ["control.Kp=60.0"]))
    assert said == "not tried, the loop would swing up by itself on the declared gear"


def test_gains_there_were_that_trip_the_guard_are_told_and_end_nothing() -> None:
    session = Mock()
    session.run.side_effect = Ended("the trial was ended: 600 rpm", Exit.TRIPPED)
    assert as_it_was(session, read("twin", [])) == "the trial was ended: 600 rpm"
    session.run.assert_called_once()
