"""What is made of a value again and again, made once."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import cached_property
from typing import Any, Final, Self, TypeVar, cast

Made = TypeVar("Made")
FEW: Final = 3  # kept lately: a shape, and the same a little off to either side


class Once:
    """Base of values that never change: a changed copy makes all of it anew, but for one that is `made_as` another."""

    @cached_property
    def _made(self) -> dict[str, Any]:
        return {}

    def made_as(self, before: Self) -> Self:
        """This copy with what was made of `before` and will be: for copies that differ in nothing of it."""
        self.__dict__["_made"] = before._made
        return self

    def lately(self, name: str, by: Hashable, make: Callable[[], Made]) -> Made:
        """What `make` gave for `by` under that `name`, of the last few that were asked for; else it is made."""
        recent: tuple[tuple[Hashable, Any], ...] = self._made.get("lately", ())
        for key, made in recent:
            if key == (name, by):
                return cast(Made, made)
        made = make()
        self._made["lately"] = (((name, by), made), *recent[: FEW - 1])
        return made

    def once(self, name: str, make: Callable[[], Made]) -> Made:
        """What `make` gave when `name` was first asked for."""
        if name not in self._made:
            self._made[name] = make()
        return cast(Made, self._made[name])
