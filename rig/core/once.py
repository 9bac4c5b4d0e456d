"""What is made of a value again and again, made once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, Self, TypeVar, cast

Made = TypeVar("Made")


class Once:
    """Base of values that never change: a changed copy makes all of it anew, but for one that is `made_as` another."""

    @cached_property
    def _made(self) -> dict[str, Any]:
        return {}

    def made_as(self, before: Self) -> Self:
        """This copy with what was made of `before` and will be: for copies that differ in nothing of it."""
        self.__dict__["_made"] = before._made
        return self

    def once(self, name: str, make: Callable[[], Made]) -> Made:
        """What `make` gave when `name` was first asked for."""
        if name not in self._made:
            self._made[name] = make()
        return cast(Made, self._made[name])
