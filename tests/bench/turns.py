"""Sides take turns: A B C, B C A, … so that what else the machine does falls on all of them."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Mapping
from dataclasses import dataclass

Side = Callable[[], float]  # does its work once; gives what it cost, s of CPU time unless the row says otherwise


@dataclass(frozen=True)
class Rounds:
    """How long the bench may take."""

    count: int  # rounds of every side
    quick: bool  # small sizes, to see that a row works: its figures mean nothing

    def size(self, full: int, small: int) -> int:
        """`full` in earnest, `small` when quick."""
        return small if self.quick else full


def take_turns(sides: Mapping[str, Side], rounds: int) -> dict[str, list[float]]:
    """What each side cost in each round, after one round that does not count (caches, compilation)."""
    names = list(sides)
    for name in names:
        sides[name]()
    cost: dict[str, list[float]] = {name: [] for name in names}
    for k in range(rounds):
        for i in range(len(names)):
            name = names[(i + k) % len(names)]
            cost[name].append(sides[name]())
    return cost


def cpu(work: Callable[[], object]) -> Side:
    """CPU time of this process [s]: time given to others by the machine does not count."""

    def once() -> float:
        began = time.process_time()
        work()
        return time.process_time() - began

    return once


def peak_mib(work: Callable[[], object]) -> float:
    """Memory that `work` holds at most beside what was there before [MiB], numpy's arrays included."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1] / 2**20
    finally:
        tracemalloc.stop()
