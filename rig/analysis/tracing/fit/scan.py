"""How much of what is left each term of the bank would explain: exact, from Schur complements of one normal matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.bank import Bank, Products
from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.model import Design, Solution
from rig.analysis.tracing.thresholds import CLEAR, FAINTEST, NOISE_ALONE
from rig.model.effect import Array


@dataclass(frozen=True)
class Own:
    """Normal matrices of the terms among themselves (k, k) and the part of them that is sensor noise; they do not
    change while the model grows."""

    gram: tuple[Array, ...]
    noise: tuple[Array, ...]


@dataclass(frozen=True)
class Drop:
    """What one term would take from the weighted sum of squares, and its coefficients (k,)."""

    term: int
    drop: float
    coefficients: Array


def own(bank: Bank, d: Design) -> Own:
    """Own normal matrices of all terms, summed over channels."""
    gram, noise = _own(bank.gram, d), _own(bank.spoilt_gram, d)
    return Own(gram, tuple(n if n.size else np.zeros_like(g) for n, g in zip(noise, gram, strict=True)))


def _own(products: Products, d: Design) -> tuple[Array, ...]:
    made = ([d.eq.noise.weight(c) * m for c, m in by_channel.items() if m.size] for by_channel in products)
    return tuple(np.sum(parts, axis=0) if parts else np.zeros((0, 0)) for parts in made)


def gradient(bank: Bank, s: Solution) -> dict[str, Array]:
    """Products of the residual with the whole bank, noise taken off, by channel, (width,)."""
    d, out = s.design, {c: np.zeros(wide) for c, wide in bank.widths().items()}
    for key in s.keys:
        if key not in bank.columns:
            continue
        w = d.eq.noise.weight(key[1])
        out[key[1]] += (w * s.residual(key)).astype(np.float32) @ bank.columns[key]
        if key in bank.spoilt:
            e = w * d.eq.stands_for[key] * d.noise_left(key, s.x)
            out[key[1]] -= e.astype(np.float32) @ bank.spoilt[key]
    return out


def drops(bank: Bank, mine: Own, u: dict[str, Array], s: Solution) -> list[Drop]:
    """The drop of every term, given products `u` (p, width) of the whole model with the bank."""
    g = gradient(bank, s)
    scale = np.where(np.diag(s.gram) > 0, 1 / np.sqrt(np.maximum(np.diag(s.gram), 1e-300)), 0.0)
    scaled = s.gram * scale * scale[:, None]
    scaled[np.diag_indices_from(scaled)] += np.where(scale > 0, 1e-11, 1.0)
    # what sensor noise adds is taken off: where little else is there, that may leave a direction less than nothing
    scaled[np.diag_indices_from(scaled)] += max(0.0, 1e-11 - float(np.linalg.eigvalsh(scaled)[0]))
    lower = np.linalg.cholesky(scaled)
    half = {c: np.linalg.solve(lower, scale[:, None] * m) for c, m in u.items() if m.shape[1]}
    out = []
    for i in range(len(bank.terms)):
        places = [(c, p) for c in CHANNELS if (p := bank.places[c][i]) is not None]
        if not places or mine.gram[i].size == 0:
            continue
        v = np.sum([half[c][:, p] for c, p in places], axis=0)
        b = np.sum([g[c][p] for c, p in places], axis=0)
        out.append(_drop(i, mine.gram[i], mine.noise[i], v, b))
    return out


def _drop(i: int, gram: Array, noise: Array, v: Array, b: Array) -> Drop:
    """One term: project out the model, leave directions out that are not its own or mostly sensor noise."""
    alone = NOISE_ALONE * np.abs(np.diag(noise))
    size = np.sqrt(np.maximum(np.maximum(np.diag(gram), alone), 1e-300))
    noise = noise / size / size[:, None]
    left = gram / size / size[:, None] - noise - (v / size).T @ (v / size)
    values, vectors = np.linalg.eigh(left)
    # less than nothing in one direction, noise taken off, is how well any of them is known
    least = max(FAINTEST, -float(values[0]))
    good = (values > least) & (values > CLEAR * (values + np.diag(vectors.T @ noise @ vectors)))
    along = vectors[:, good].T @ (b / size)
    x = (vectors[:, good] @ (along / values[good])) / size
    return Drop(i, float(np.sum(along**2 / values[good])), x)
