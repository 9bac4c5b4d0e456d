"""Methods that predict and name nothing: gradient boosting and a Gaussian process, both offered history."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import ClassVar

import numpy as np
from scipy.optimize import minimize
from sklearn.ensemble import HistGradientBoostingRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

from tests.blind.peers.data import Split
from tests.blind.peers.peer import Guess, Peer, halves, scaled

NOTHING: frozenset[str] = frozenset()
STEPS = 15  # of the search for the lengths
POINTS = 300  # of the Gaussian process: its price grows with the cube
LEAVES = ((8, 0.05), (31, 0.05), (31, 0.15))  # leaves per tree and learning rate tried on the tuning runs


def short_search(
    likelihood: Callable[[np.ndarray], tuple[float, np.ndarray]], start: np.ndarray, bounds: np.ndarray
) -> tuple[np.ndarray, float]:
    """Lengths by at most STEPS steps of L-BFGS-B."""
    found = minimize(likelihood, start, jac=True, bounds=bounds, method="L-BFGS-B", options={"maxiter": STEPS})
    return found.x, found.fun


class Boosting(Peer):
    """Trees; leaves and rate chosen on the tuning runs."""

    name: ClassVar[str] = "gradient boosting, lagged features"

    def guess(self, split: Split, channel: str) -> Guess:
        x, size = split.train.x, split.train.y.std() + 1e-30
        y = split.train.y / size
        fit, tune = halves(split.train)

        def model(leaves: int, rate: float) -> HistGradientBoostingRegressor:
            return HistGradientBoostingRegressor(
                max_leaf_nodes=leaves, learning_rate=rate, max_iter=150, random_state=0
            )

        errors = [np.mean((model(*shape).fit(x[fit], y[fit]).predict(x[tune]) - y[tune]) ** 2) for shape in LEAVES]
        best = model(*LEAVES[int(np.argmin(errors))]).fit(x, y)
        return Guess(best.predict(split.held.x) * size, NOTHING)


class Gaussian(Peer):
    """One length per feature, by marginal likelihood on a random part of the fitted rows."""

    name: ClassVar[str] = "Gaussian process, lagged features"

    def guess(self, split: Split, channel: str) -> Guess:
        rng = np.random.default_rng(0)
        rows = rng.choice(len(split.train.y), min(POINTS, len(split.train.y)), replace=False)
        x, held = scaled(split.train.x, split.held.x)
        size = split.train.y.std() + 1e-30
        kernel = ConstantKernel(1.0) * RBF(np.full(x.shape[1], 3.0), (0.1, 1e3)) + WhiteKernel(0.3, (1e-4, 3.0))
        model = GaussianProcessRegressor(kernel, normalize_y=True, optimizer=short_search)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ConvergenceWarning)
            model.fit(x[rows], split.train.y[rows] / size)
        return Guess(model.predict(held) * size, NOTHING)
