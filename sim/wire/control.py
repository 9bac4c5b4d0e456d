"""The twin's command channel: one JSON object a line on a Unix socket, one line back.

    {"do": "load", "tau_ext": 3.0}  →  {"ok": true}      {"do": "truth"}  →  {"ok": true, "theta_m": …, …}

{"do": "help"} lists what there is. A line that cannot be meant is answered with {"ok": false, "error": sentence}.
"""

from __future__ import annotations

import inspect
import json
import math
import socket
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, final

from rig.core.errors import HdrigError, UsageError
from sim.wire.hub import listen
from sim.wire.reactor import Reactor, Source

Answer = Mapping[str, Any] | None
Verb = Callable[..., Answer]
LONGEST_LINE = 65536  # bytes
KINDS = {"str": "NAME", "bool": "true|false"}  # what a verb is given, by its annotation; all else is a number


def describe(verbs: Mapping[str, Verb]) -> dict[str, str]:
    """Each verb with what it is given, in words, and what it does."""
    lines = {}
    for name, verb in verbs.items():
        text = inspect.getdoc(verb) or ""
        first = text.splitlines()[0] if text else ""
        lines[name] = f"{given}: {first}" if (given := _given(verb)) else first
    return lines


def _given(verb: Verb) -> str:
    """ "device=NAME by=NUMBER [count=NUMBER]": what may be left out stands in brackets."""
    keys = inspect.signature(verb).parameters.values()
    said = [(key, f"{key.name}={KINDS.get(str(key.annotation), 'NUMBER')}") for key in keys]
    return " ".join(word if key.default is key.empty else f"[{word}]" for key, word in said)


def perform(verbs: Mapping[str, Verb], line: bytes) -> dict[str, Any]:
    """Do what one line asks; the answer as an object, with `usage` where the line was not understood."""
    try:
        asked = json.loads(line)
        if not isinstance(asked, dict) or "do" not in asked:
            raise UsageError('expected an object with "do", for example {"do": "truth"}')
        name = asked.pop("do")
        if name not in verbs:
            raise UsageError(f"no command '{name}'; expected one of {', '.join(sorted(verbs))}")
        refuse_other_keys(name, verbs[name], asked)
        known = inspect.signature(verbs[name]).parameters
        for key, value in asked.items():
            refuse_other_kind(key, value, str(known[key].annotation))
            refuse_no_number(key, value, known[key].default)
        return {"ok": True, **(verbs[name](**asked) or {})}
    except UsageError as error:
        return {"ok": False, "error": str(error), "usage": True}
    except (HdrigError, ValueError, TypeError, OverflowError) as error:
        return {"ok": False, "error": str(error)}


def refuse_other_keys(name: str, verb: Verb, asked: Mapping[str, Any]) -> None:
    """Raises UsageError where a key is missing, with what there is to choose from, or there is one too many."""
    known = inspect.signature(verb).parameters
    choices: Mapping[str, Iterable[str]] = getattr(getattr(verb, "__self__", None), "choices", dict)()
    missing = [key for key, one in known.items() if one.default is one.empty and key not in asked]
    if missing:
        words = [f"{key} ({', '.join(choices[key]) or 'there is none'})" if key in choices else key for key in missing]
        raise UsageError(f"{name} needs {' and '.join(words)}, as in {name} {_given(verb)}")
    for key in asked:
        if key not in known:
            raise UsageError(f"{name} has no '{key}'; expected {_given(verb) or 'nothing more'}")


def refuse_other_kind(key: str, value: object, kind: str) -> None:
    """Raises UsageError for a word where a truth or a number is expected."""
    if kind == "bool" and not isinstance(value, bool):
        raise UsageError(f"{key} = {value}: expected true or false")
    if kind in ("float", "int") and (isinstance(value, bool) or not isinstance(value, int | float)):
        raise UsageError(f"{key} = {value}: expected a number")


def refuse_no_number(key: str, value: object, usual: object) -> None:
    """Raises UsageError for NaN, and for an infinity where none is the `usual` value."""
    if isinstance(value, float) and not math.isfinite(value) and value != usual:
        raise UsageError(f"{key} = {value:g}: expected a finite number")


@final
class Control(Source):
    """Accepts any number of clients at `path`; `verbs` are what they may ask for."""

    def __init__(self, reactor: Reactor, path: Path, verbs: Mapping[str, Verb]) -> None:
        self.reactor, self.path = reactor, path
        self.verbs: dict[str, Verb] = {**verbs, "help": lambda: describe(self.verbs)}
        self.lines: list[Line] = []
        self._socket = listen(path, socket.SOCK_STREAM)
        reactor.add(self)

    def fileno(self) -> int:
        """Of the listening socket."""
        return self._socket.fileno()

    def ready(self) -> None:
        """Somebody connects: a Line of its own."""
        line = Line(self, self._socket.accept()[0])
        self.lines.append(line)
        self.reactor.add(line)

    def close(self) -> None:
        """All clients are cut off, the path is removed."""
        for line in tuple(self.lines):
            line.close()
        self._socket.close()
        self.path.unlink(missing_ok=True)


@final
class Line(Source):
    """One client of the command channel."""

    def __init__(self, control: Control, connection: socket.socket) -> None:
        self._control, self._socket = control, connection
        self._socket.setblocking(False)
        self._text = b""

    def fileno(self) -> int:
        """Of the client's socket."""
        return self._socket.fileno()

    def ready(self) -> None:
        """Every whole line received is performed and answered; a client that is gone, or ends no line, is closed."""
        try:
            got = self._socket.recv(LONGEST_LINE)
        except OSError:
            got = b""
        if not got or len(self._text) > LONGEST_LINE:
            self.close()
            return
        *lines, self._text = (self._text + got).split(b"\n")
        for line in lines:
            answer = json.dumps(perform(self._control.verbs, line)).encode() + b"\n"
            try:
                self._socket.send(answer)
            except OSError:
                self.close()
                return

    def close(self) -> None:
        """Gone. Idempotent."""
        if self in self._control.lines:
            self._control.lines.remove(self)
            self._control.reactor.remove(self)
            self._socket.close()
