"""Products of a model's columns with the whole bank, kept for who asks for the same again.

From one round of a search to the next, and from one search to another of the same campaign, most terms of a model stay
what they were; and with a bank of thousands of columns these products are most of what a search costs.
"""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import BASELINE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.laid import Index, Single
from rig.analysis.tracing.fit.model import Design, Part
from rig.model.effect import Array
from rig.process.workers import WORKERS

ROOM: Final = 2**26  # bytes: the terms of a few models, a twentieth of what their bank takes
DIGEST: Final = 16  # bytes


@dataclass(frozen=True)
class Columns:
    """Columns of the model in one block, (n, k) in single precision, where they lie among those of their term (k,),
    and how much one of their rows weighs; and the same of what sensor noise does to them, where that is known."""

    z: Single
    at: Index
    weight: float
    spoilt: Single | None
    spoilt_weight: float

    def digest(self, into: hashlib.blake2b) -> None:
        """All of it into a digest of the term."""
        for x in (self.z, self.at, self.spoilt):
            if x is not None:
                into.update(x.tobytes())
        into.update(repr((self.weight, self.spoilt_weight)).encode())


@dataclass
class Crossed:
    """Products (k, width) by channel of columns with one bank, those asked for last kept up to a bound in bytes."""

    columns: Mapping[Key, Single]
    spoilt: Mapping[Key, Single]
    widths: Mapping[str, int]
    kept: OrderedDict[bytes, dict[str, Array]] = field(default_factory=OrderedDict)
    made: int = 0  # terms whose products were not there yet

    def of(self, d: Design, keys: Sequence[Key]) -> dict[str, Array]:
        """Of all columns of a model in those blocks with the bank, noise taken off, (p, width) by channel."""
        places = [slice(0, len(BASELINE)), *(d.place(i) for i in range(len(d.terms)))]
        terms = [self._of_term(d, keys, place) for place in places]
        return {c: np.vstack([term[c] for term in terms]) for c in self.widths}

    def _of_term(self, d: Design, keys: Sequence[Key], place: slice) -> dict[str, Array]:
        """Of the columns whose coefficients lie at that place."""
        blocks = {
            key: _columns(d, key, part, place.start)
            for key in keys
            if key in self.columns
            for part in d.parts[key]
            if place.start <= part.at[0] < place.stop
        }
        digest = hashlib.blake2b(repr((list(blocks), place.stop - place.start)).encode(), digest_size=DIGEST)
        for block in blocks.values():
            block.digest(digest)
        name = digest.digest()
        if name not in self.kept:
            self.made += 1
            self.kept[name] = self._products(blocks, place.stop - place.start)
            self._make_room()
        self.kept.move_to_end(name)
        return self.kept[name]

    def _products(self, blocks: Mapping[Key, Columns], wide: int) -> dict[str, Array]:
        def summed(some: Sequence[Key]) -> dict[str, Array]:
            """Over some of the blocks."""
            out = {c: np.zeros((wide, width)) for c, width in self.widths.items()}
            for key in some:
                block, u = blocks[key], out[key[1]]
                u[block.at] += block.weight * (block.z.T @ self.columns[key])
                if block.spoilt is not None and key in self.spoilt:
                    u[block.at] -= block.spoilt_weight * (block.spoilt.T @ self.spoilt[key])
            return out

        mine = sorted(blocks, key=lambda key: -self.columns[key].size)
        with ThreadPoolExecutor(WORKERS) as pool:  # blocks by turns: products of large matrices leave the lock alone
            parts = list(pool.map(summed, [mine[i::WORKERS] for i in range(WORKERS)]))
        return {c: np.sum([part[c] for part in parts], axis=0) for c in self.widths}

    def _make_room(self) -> None:
        """The newest stays, however large it is."""
        while len(self.kept) > 1 and sum(_size(products) for products in self.kept.values()) > ROOM:
            self.kept.popitem(last=False)


def _columns(d: Design, key: Key, part: Part, first: int) -> Columns:
    weight = d.eq.noise.weight(key[1])
    spoilt = None if part.spoilt is None else part.spoilt.whole().astype(np.float32)
    z, taken = part.z.whole().astype(np.float32), weight * d.eq.stands_for.get(key, 0.0)
    return Columns(z, part.at - first, weight, spoilt, taken)


def _size(products: Mapping[str, Array]) -> int:
    return sum(x.nbytes for x in products.values())
