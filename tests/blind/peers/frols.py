"""Forward orthogonal regression with error reduction ratios (Billings), from sysidentpy: a polynomial of features."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from sysidentpy.basis_function import Polynomial
from sysidentpy.model_structure_selection import FROLS

from tests.blind.peers.data import Split
from tests.blind.peers.peer import Guess, Peer, scaled

INPUTS = ("w", "T", "side", "cos1", "sin1", "cos2", "sin2", "cos_l", "sin_l", "T_0.1", "w_0.1")


class Frols(Peer):
    """Second degree, static; the number of terms by the Bayesian information criterion."""

    name: ClassVar[str] = "forward orthogonal regression (FROLS, quadratic)"

    def guess(self, split: Split, channel: str) -> Guess:
        x, held = scaled(split.train.of(*INPUTS), split.held.of(*INPUTS))
        size = split.train.y.std() + 1e-30
        model = FROLS(
            order_selection=True, n_info_values=20, info_criteria="bic", model_type="NFIR", xlag=[[1]] * len(INPUTS),
            basis_function=Polynomial(degree=2), err_tol=None,
        )  # fmt: skip
        model.fit(X=ahead(x), y=ahead(split.train.y[:, None] / size))
        predicted = model.predict(X=ahead(held), y=np.zeros((len(held) + 1, 1))).ravel()[1:]
        terms = {tuple(int(code) for code in row) for row in model.final_model}
        return Guess(predicted * size, frozenset(str(term) for term in terms))


def ahead(x: np.ndarray) -> np.ndarray:
    """One row more at the end: the package looks one row back, so its lag 1 is our present."""
    return np.vstack([x, x[-1:]]) if x.shape[1] > 1 else np.vstack([x[:1], x])
