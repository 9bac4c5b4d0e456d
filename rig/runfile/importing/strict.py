"""A TOML table read key by key: what is left over at the end was not meant to be there, and is named with its nearest
valid key."""

from __future__ import annotations

import difflib
import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any, NoReturn

from rig.core.errors import UsageError
from rig.core.few import few

_MISSING = object()
_WORD = {str: "a text in quotes", int: "a whole number", float: "a number", bool: "true or false", dict: "a table"}


def nearest(wrong: str, valid: Iterable[str], most: int = 12) -> str:
    """ "did you mean 'x'?", or the list of what exists (its first `most`)."""
    names = list(dict.fromkeys(valid))
    close = difflib.get_close_matches(wrong.lower(), [n.lower() for n in names], n=1, cutoff=0.6)
    if close:
        return f"did you mean '{next(n for n in names if n.lower() == close[0])}'?"
    return f"there is {few(names, most)}"


class Section:
    """One table of a TOML file. `take` every key it may have, then `done`."""

    def __init__(self, file: str, path: str, raw: Mapping[str, Any]) -> None:
        self.file, self.path, self._raw = file, path, dict(raw)
        self._known: list[str] = []

    def has(self, key: str) -> bool:
        """True when the file gives this key; a valid key from now on."""
        self._known.append(key)
        return key in self._raw

    def names(self) -> list[str]:
        """The keys as they stand in the file."""
        return list(self._raw)

    def text(
        self,
        key: str,
        default: Any = _MISSING,
        choices: Collection[str] = (),
        blank: bool = False,
        longest: float = math.inf,
    ) -> str:
        """A text that is not blank (unless blanks are meant), of at most `longest` characters; one of `choices` when
        given."""
        found: str = self._take(key, str, default)
        if found is not default and len(found) > longest:
            self.refuse(key, f"{found[:40]}…", f"at most {longest:g} characters, these are {len(found)}")
        if found is not default and not blank and not found.strip():
            self.refuse(key, found, "a text that says something")
        if found is not default and choices and found not in choices:
            raise UsageError(f"{self.file}: {self._name(key)} = '{found}'; {nearest(found, choices)}")
        return found

    def number(self, key: str, default: Any = _MISSING, above: float = -math.inf) -> float:
        """A finite number greater than `above`."""
        found: float = self._take(key, float, default)
        if found is not default and (not math.isfinite(found) or found <= above):
            self.refuse(key, found, "a finite number" + (f" above {above:g}" if math.isfinite(above) else ""))
        return found if found is default else float(found)  # TOML's 2 is as good as 2.0

    def whole(self, key: str, default: Any = _MISSING, least: int = 0, most: int = 2**63 - 1) -> int:
        """A whole number from `least` to `most`."""
        found: int = self._take(key, int, default)
        if found is not default and not least <= found <= most:
            self.refuse(key, found, f"a whole number from {least} to {most}")
        return found

    def flag(self, key: str, default: Any = _MISSING) -> bool:
        """true or false."""
        found: bool = self._take(key, bool, default)
        return found

    def sign(self, key: str) -> int:
        """1 or -1; 1 when absent."""
        found: int = self._take(key, int, 1)
        if found not in (1, -1):
            self.refuse(key, found, "1 or -1")
        return found

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of texts, empty when absent."""
        found = self._take(key, list, [])
        if not all(isinstance(x, str) for x in found):
            self.refuse(key, found, "a list of texts in quotes")
        return tuple(found)

    def table(self, key: str, default: Any = _MISSING) -> Section:
        """A table inside this one; empty when absent and a default is given."""
        return Section(self.file, self._name(key), self._take(key, dict, default))

    def tables(self, key: str) -> list[Section]:
        """A list of tables, empty when absent."""
        found = self._take(key, list, [])
        if not all(isinstance(x, dict) for x in found):
            self.refuse(key, found, "a list of tables {column = …, scale = …}")
        return [Section(self.file, f"{self._name(key)}[{i}]", x) for i, x in enumerate(found)]

    def done(self) -> None:
        """Raises UsageError for a key nobody took."""
        for key in self._raw:
            if key not in self._known:
                hint = nearest(key, (k for k in self._known if k not in self._raw))
                raise UsageError(f"{self.file}: unknown key '{self._name(key)}'; {hint}")

    def refuse(self, key: str, found: Any, expected: str) -> NoReturn:
        """Raises UsageError: key, value, what was expected."""
        raise UsageError(f"{self.file}: {self._name(key)} = {found!r}: expected {expected}")

    def missing(self, key: str) -> str:
        """That the key is not there, and which key may have been meant for it."""
        close = difflib.get_close_matches(key, (k for k in self._raw if k not in self._known), n=1, cutoff=0.6)
        return f"'{self._name(key)}' is missing" + (f"; is '{close[0]}' meant for it?" if close else "")

    def _name(self, key: str) -> str:
        return f"{self.path}.{key}" if self.path else key

    def _take(self, key: str, kind: type, default: Any) -> Any:
        self._known.append(key)
        if key not in self._raw:
            if default is _MISSING:
                raise UsageError(f"{self.file}: {self.missing(key)}")
            return default
        found = self._raw[key]
        wanted = (int, float) if kind is float else kind
        if not isinstance(found, wanted) or (isinstance(found, bool) and kind is not bool):
            self.refuse(key, found, _WORD.get(kind, "a list"))
        return found
