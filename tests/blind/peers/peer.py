"""What a peer is: fits the residual on some rows, predicts it on others, and says which families it used."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from tests.blind.peers.data import Rows, Split


@dataclass(frozen=True)
class Guess:
    """Predicted residual of the held-out rows, and the families of effects the method would name."""

    y: np.ndarray
    families: frozenset[str]


class Peer(ABC):
    """One method. Whatever it tunes, it tunes on the fitted runs."""

    name: ClassVar[str]

    @abstractmethod
    def guess(self, split: Split, channel: str) -> Guess:
        """Fit on `split.train`, predict `split.held`."""


def halves(rows: Rows) -> tuple[np.ndarray, np.ndarray]:
    """Every third run of the fitted ones is kept for tuning: masks of what to fit and what to tune on."""
    names = list(dict.fromkeys(rows.run.tolist()))
    tune = np.isin(rows.run, names[1::3])
    return ~tune, tune


def scaled(train: np.ndarray, held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both, by mean and spread of the first."""
    mean, spread = train.mean(axis=0), train.std(axis=0) + 1e-12
    return (train - mean) / spread, (held - mean) / spread
