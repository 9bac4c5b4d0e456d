"""What unseen runs leave beside what the fitted ones foretell along a coordinate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.rest.joined import Rest, rest
from rig.model.effect import Array


@dataclass(frozen=True)
class Unseen:
    """Residuals of unseen runs, and of one channel fitted and unseen rows joined, in this order, once for all that is
    asked of them; `both` is None where that channel has not both."""

    eq: Equations
    left: Mapping[Key, Array]
    floors: Mapping[Key, float]
    both: Rest | None
    fitted: int  # rows

    def without(self, found: Home) -> dict[Key, Array]:
        """Those residuals without what that coordinate foretells, as read in the fitted rows, and without zeros that
        are their own beside it."""
        out = dict(self.left)
        if self.both is None or found.read is None:
            return out
        both = self.both
        if both.own_zeros != found.own_zeros:
            both = replace(both, own_zeros=found.own_zeros)
        guess = found.read(both, np.arange(both.e.size) < self.fitted)[self.fitted :]
        start = 0
        for key in [k for k in self.left if k[1] == found.channel]:
            n = self.left[key].size
            mine = self.left[key] - self.eq.without_local(key, guess[start : start + n]) * self.floors[key]
            out[key] = mine - np.mean(mine) if found.own_zeros else mine
            start += n
        return out


def unseen_beside(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float], channel: str
) -> Unseen:
    """The residuals `unseen`, with those of `channel` joined behind the `fitted` ones."""
    train, test = rest(eq, fitted, floors, channel), rest(eq, unseen, floors, channel)
    if train is None or test is None:
        return Unseen(eq, unseen, floors, None, 0)
    both = replace(
        train,
        e=np.concatenate([train.e, test.e]),
        run=np.concatenate([train.run, test.run]),
        at={k: np.concatenate([train.at[k], test.at[k]]) for k in train.at},
        z=np.concatenate([train.z, test.z]),
        worth=np.concatenate([train.worth, test.worth]),
        offset=np.concatenate([train.offset, test.offset]),
    )
    return Unseen(eq, unseen, floors, both, train.e.size)


def smooth_term(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float], found: Home
) -> dict[Key, Array]:
    """Unseen residuals without what a coordinate foretells of them, where nothing else is asked."""
    return unseen_beside(eq, fitted, unseen, floors, found.channel).without(found)
