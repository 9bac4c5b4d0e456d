"""matplotlib imported without its pages of help has them again afterwards."""

from __future__ import annotations

import inspect

from matplotlib import artist

from rig.report.without_help import without_help


def test_help_is_left_out_only_meanwhile() -> None:
    usual = artist.kwdoc
    with without_help():

        class Dot(artist.Artist):
            """An artist like those that are imported."""

    assert artist.kwdoc is usual
    assert artist.kwdoc(Dot)
    assert "alpha" not in (Dot.set.__doc__ or "")
    assert "alpha" not in inspect.signature(Dot.set).parameters

    class Line(artist.Artist):
        """One that is made later has all of it."""

    assert "alpha" in (Line.set.__doc__ or "")
    assert "alpha" in inspect.signature(Line.set).parameters
    dot = Dot()
    dot.set(alpha=0.5)
    assert dot.get_alpha() == 0.5
