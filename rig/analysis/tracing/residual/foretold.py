"""What unseen runs leave beside what the fitted ones foretell along a coordinate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Rest, rest
from rig.model.effect import Array


@dataclass(frozen=True)
class Less:
    """Residuals of fitted and of unseen runs without what was foretold of them."""

    fitted: dict[Key, Array]
    unseen: dict[Key, Array]


@dataclass(frozen=True)
class Unseen:
    """Residuals of fitted and unseen runs, and of one channel those rows joined, in this order, once for all that is
    asked of them; `both` is None where that channel has not both."""

    eq: Equations
    seen: Mapping[Key, Array]
    left: Mapping[Key, Array]
    floors: Mapping[Key, float]
    both: Rest | None
    fitted: int  # rows

    def without(self, found: Home) -> Less:
        """Those residuals without what that coordinate foretells, as read in the fitted rows, and without zeros that
        are their own beside it."""
        if self.both is None or found.read is None:
            return Less(dict(self.seen), dict(self.left))
        both = self.both
        if both.own_zeros != found.own_zeros:
            both = replace(both, own_zeros=found.own_zeros)
        guess = found.read(both, np.arange(both.e.size) < self.fitted)
        return Less(
            self._less(self.seen, found, guess[: self.fitted]), self._less(self.left, found, guess[self.fitted :])
        )

    def _less(self, left: Mapping[Key, Array], found: Home, guess: Array) -> dict[Key, Array]:
        """Residuals less the guess of their rows, (n,) in floors."""
        out, start = dict(left), 0
        for key in [k for k in left if k[1] == found.channel]:
            n = left[key].size
            mine = left[key] - self.eq.without_local(key, guess[start : start + n]) * self.floors[key]
            out[key] = mine - np.mean(mine) if found.own_zeros else mine
            start += n
        return out


def unseen_beside(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float], channel: str
) -> Unseen:
    """The residuals `unseen`, with those of `channel` joined behind the `fitted` ones."""
    train, test = rest(eq, fitted, floors, channel), rest(eq, unseen, floors, channel)
    if train is None or test is None:
        return Unseen(eq, fitted, unseen, floors, None, 0)
    both = replace(
        train,
        e=np.concatenate([train.e, test.e]),
        run=np.concatenate([train.run, test.run]),
        at={k: np.concatenate([train.at[k], test.at[k]]) for k in train.at},
        z=np.concatenate([train.z, test.z]),
        worth=np.concatenate([train.worth, test.worth]),
        offset=np.concatenate([train.offset, test.offset]),
    )
    return Unseen(eq, fitted, unseen, floors, both, train.e.size)


def smooth_term(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float], found: Home
) -> dict[Key, Array]:
    """Unseen residuals without what a coordinate foretells of them, where nothing else is asked."""
    return unseen_beside(eq, fitted, unseen, floors, found.channel).without(found).unseen
