"""What is made once is made once; a changed copy makes it anew, unless it was said to differ in nothing of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from rig.core.once import Once


@dataclass(frozen=True)
class Number(Once):
    """A number, its square made once."""

    value: int
    colour: str = ""

    def square(self, made: list[int]) -> int:
        """Notes in `made` what it is really made of."""
        return self.once("square", lambda: made.append(self.value) or self.value**2)


def test_it_is_made_once_and_anew_by_a_changed_copy() -> None:
    made: list[int] = []
    three = Number(3)
    assert [three.square(made), three.square(made), replace(three, value=4).square(made)] == [9, 9, 16]
    assert made == [3, 4]


def test_a_copy_made_as_another_shares_what_either_makes() -> None:
    made: list[int] = []
    three = Number(3)
    red = replace(three, colour="red").made_as(three)
    assert [red.square(made), three.square(made)] == [9, 9]
    assert made == [3]


def test_of_what_was_made_lately_a_few_are_kept() -> None:
    made: list[int] = []
    three = Number(3)

    def power(by: int) -> int:
        return three.lately("power", by, lambda: made.append(by) or three.value**by)

    assert [power(by) for by in (1, 2, 1, 2, 3, 1)] == [3, 9, 3, 9, 27, 3]
    assert made == [1, 2, 3]
    assert power(4) == 81
    assert power(1) == 3  # it was asked for before three others were made, and is made anew
    assert made == [1, 2, 3, 4, 1]
