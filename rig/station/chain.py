"""The hard-wired chain, as far as the drive tells: by the voltage at its power stage. What is not known is said."""

from __future__ import annotations

from typing import Any, final


@final
class Chain:
    """Judges the drive's "voltage enabled". Some drives tell it only while they are energised: then 0 means nothing.

    Only a drive that has once told of voltage while it was torque-free is believed when it tells of none.
    """

    def __init__(self) -> None:
        self._tells_when_off = False

    def judge(self, voltage: bool | None, energised: bool) -> dict[str, Any]:
        """`known`, `closed` and a sentence."""
        if voltage is None:
            return _said(None, "not known: this drive does not tell whether there is voltage at its power stage")
        if voltage:
            self._tells_when_off = self._tells_when_off or not energised
            return _said(True, "closed as far as the drive tells: there is voltage at its power stage")
        if self._tells_when_off:
            return _said(
                False, "open: the drive tells that its power stage has no voltage any more, or its supply is off"
            )
        return _said(None, "not known: this drive tells of no voltage at its power stage while it is torque-free")


def _said(closed: bool | None, text: str) -> dict[str, Any]:
    return {"known": closed is not None, "closed": closed, "text": text}


SILENT_DRIVE = _said(None, "not known: the drive is silent, and what it told last may hold no more")
