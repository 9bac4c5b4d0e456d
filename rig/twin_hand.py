"""The hand of a twin in another process: weights and pin through its command channel, one JSON object a line."""

from __future__ import annotations

import json
import socket
from typing import Any, final

from rig.core.errors import HdrigError, NotReady
from rig.core.operator import Change, ClearFault, FreeOutput, HangWeight, LockOutput, Operator, Reassemble

PATIENCE = 5.0  # s for an answer: the twin may wait for the processor
LONGEST_LINE = 65536  # bytes


@final
class TwinHand(Operator):
    """Speaks to the socket at `control`. The twin runs on by itself: what was done stays done."""

    def __init__(self, control: str) -> None:
        self.control = control

    def make(self, change: Change) -> None:
        """Raises NotReady: nobody there, or the twin refuses, with its sentence."""
        match change:
            case HangWeight(tau_ext):
                self.ask({"do": "load", "tau_ext": tau_ext})
            case LockOutput():
                self.ask({"do": "lock"})
            case FreeOutput():
                self.ask({"do": "unlock"})
            case Reassemble(depth_mm):
                self.ask({"do": "reassemble", "depth_mm": depth_mm})
            case ClearFault():
                return  # nothing of the twin breaks
            case _:
                raise NotReady(f"the twin at {self.control} cannot do this: {change.words()}")

    def ask(self, what: dict[str, Any], not_understood: type[HdrigError] = NotReady) -> dict[str, Any]:
        """One line there, one line back. Raises NotReady, and `not_understood` where the twin knows no such thing."""
        line = json.dumps(what).encode() + b"\n"
        try:
            with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as channel:
                channel.settimeout(PATIENCE)
                channel.connect(self.control)
                channel.sendall(line)
                answer = self._answer(channel)
        except OSError as error:
            raise NotReady(
                f"the twin's command channel {self.control} does not answer ({error.strerror or error}): "
                "is `hdrig twin` running, is hand.control in the bench file its --control?"
            ) from None
        if not answer.get("ok"):
            kind = not_understood if answer.get("usage") is True else NotReady
            raise kind(f"the twin refused {what['do']}: {answer.get('error', 'without a reason')}")
        return answer

    def _answer(self, channel: socket.socket) -> dict[str, Any]:
        got = b""
        while not got.endswith(b"\n") and len(got) < LONGEST_LINE:
            piece = channel.recv(LONGEST_LINE)
            if not piece:
                break
            got += piece
        try:
            answer = json.loads(got)
        except ValueError:
            answer = None
        if type(answer) is not dict:
            raise NotReady(f"{self.control} answers with no JSON object: that is no twin's command channel")
        return answer
