"""Sparse regression by sequentially thresholded least squares (Brunton 2016, pysindy's optimiser) on two libraries."""

from __future__ import annotations

import warnings
from itertools import combinations_with_replacement
from typing import ClassVar

import numpy as np
from pysindy.optimizers import STLSQ

from tests.blind.peers.data import Rows, Split
from tests.blind.peers.peer import Guess, Peer, halves

THRESHOLDS = (0.003, 0.01, 0.03, 0.1, 0.3)  # of the residual's spread, for columns of unit spread
PLAIN = ("w", "dw", "T", "side", "cos1", "sin1", "cos2", "sin2", "cos_l", "sin_l", "place")

Library = tuple[list[str], np.ndarray]


def quadratic(rows: Rows) -> Library:
    """Products of two of the plain features, and these: the generic library."""
    x = rows.of(*PLAIN) / np.array([10, 100, 20, 1, 1, 1, 1, 1, 1, 1, 30.0])
    pairs = list(combinations_with_replacement(range(len(PLAIN)), 2))
    names = [*PLAIN, *(f"{PLAIN[i]}·{PLAIN[j]}" for i, j in pairs)]
    return names, np.column_stack([x, *(x[:, i] * x[:, j] for i, j in pairs)])


def physical(rows: Rows) -> Library:
    """One family per effect that a textbook knows, in its textbook form; the part before '#' is the family."""
    f = {name: rows.x[:, i] for i, name in enumerate(rows.names)}
    load, c, s = f["T"], f["cos_l"], f["sin_l"]
    columns = friction(f["w"], load, f["side"], f["place"])
    columns |= {
        "cubic": load**3, "square": load * np.abs(load), "backlash": load / (np.abs(load) + 0.5), "inertia": f["dw"],
        "wind_up#1": np.tanh(load / 0.3) * (1 - np.exp(-np.abs(load) / 2)),
        "wind_up#2": np.tanh(load / 0.3) * (1 - np.exp(-np.abs(load) / 8)),
        "loop#1": load - f["T_0.5"], "loop#2": load - f["T_0.1"], "drift": f["place"],
        "output_turn#1": c, "output_turn#2": s, "output_twice#1": c * c - s * s, "output_twice#2": 2 * c * s,
    }  # fmt: skip
    for k in (1, 2, 4):
        columns |= modulated(k, f[f"cos{k}"], f[f"sin{k}"], load, f["side"])
    return list(columns), np.column_stack(list(columns.values()))


Columns = dict[str, np.ndarray]


def friction(w: np.ndarray, load: np.ndarray, side: np.ndarray, place: np.ndarray) -> Columns:
    a = np.abs(w)
    return {
        "stribeck#1": side * np.exp(-a),
        "stribeck#2": side * np.exp(-a / 3),
        "drag": w * a,
        "churn": side * a ** (2 / 3),
        "load_friction": side * np.abs(load),
        "direction": side,
        "lag": w,
        "warming#1": w * place,
        "warming#2": side * place,
    }


def modulated(k: int, c: np.ndarray, s: np.ndarray, load: np.ndarray, side: np.ndarray) -> Columns:
    """What order k of the motor may modulate: torque, friction, stiffness, an error that shrinks with load."""
    by = {"cogging": 1.0, "friction_angle": side, "stiffness_angle": load, "load_error": np.exp(-np.abs(load) / 3)}
    return {f"{name}_{k}#{i}": x * y for name, x in by.items() for i, y in ((1, c), (2, s))}


class Sparse(Peer):
    """STLSQ whose threshold is chosen on the tuning runs."""

    @staticmethod
    def library(rows: Rows) -> Library:
        raise NotImplementedError

    def guess(self, split: Split, channel: str) -> Guess:
        names, x = self.library(split.train)
        _, x_held = self.library(split.held)
        spread, size = x.std(axis=0) + 1e-12, split.train.y.std() + 1e-30
        x, x_held, y = x / spread, x_held / spread, split.train.y / size
        fit, tune = halves(split.train)
        errors = [np.mean((y[tune] - x[tune] @ solve(x[fit], y[fit], t)) ** 2) for t in THRESHOLDS]
        beta = solve(x, y, THRESHOLDS[int(np.argmin(errors))])
        used = {name.split("#")[0] for name, b in zip(names, beta, strict=True) if b != 0}
        return Guess(x_held @ beta * size, frozenset(used))


def solve(x: np.ndarray, y: np.ndarray, threshold: float) -> np.ndarray:
    """Coefficients; zeros when the threshold leaves none."""
    optimiser = STLSQ(threshold=threshold, alpha=1e-6, max_iter=20)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Sparsity parameter is too big")  # then the answer is zero
        return np.asarray(optimiser.fit(x, y[:, None]).coef_).ravel()


class SparseGeneric(Sparse):
    name: ClassVar[str] = "sparse regression, quadratic library (STLSQ)"
    library = staticmethod(quadratic)


class SparsePhysical(Sparse):
    name: ClassVar[str] = "sparse regression, physics library (STLSQ)"
    library = staticmethod(physical)
