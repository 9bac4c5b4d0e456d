"""How much of what is left each term of the bank would explain: exact, from Schur complements of one normal matrix."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.bank import Bank, Single
from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, Solution
from rig.analysis.tracing.thresholds import CLEAR, FAINTEST
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


def own(bank: Bank, d: Design, keys: Sequence[Key]) -> Own:
    """Own normal matrices of all terms, summed over channels."""
    gram = _own(bank, {k: (bank.columns[k], d.eq.noise.weight(k[1])) for k in keys if k in bank.columns})
    scale = {k: d.eq.noise.weight(k[1]) * d.eq.stands_for[k] for k in bank.spoilt}
    noise = _own(bank, {k: (m, scale[k]) for k, m in bank.spoilt.items()})
    return Own(gram, tuple(n if n.size else np.zeros_like(g) for n, g in zip(noise, gram, strict=True)))


def _own(bank: Bank, blocks: Mapping[Key, tuple[Single, float]]) -> tuple[Array, ...]:
    out: list[Array] = [np.zeros((0, 0))] * len(bank.terms)
    for (_, channel), (columns, w) in blocks.items():
        for i, place in enumerate(bank.places[channel]):
            if place is not None:
                c = columns[:, place].astype(np.float64)
                part = w * (c.T @ c)
                out[i] = out[i] + part if out[i].size else part
    return tuple(out)


def cross(bank: Bank, d: Design, keys: Sequence[Key], first: int) -> dict[str, Array]:
    """Products of the model's columns from `first` on with the whole bank, noise taken off, by channel: (p, width)."""
    out = {c: np.zeros((d.size, wide)) for c, wide in bank.widths().items()}
    for key in keys:
        if key not in bank.columns:
            continue
        for part in (p for p in d.parts[key] if p.at[0] >= first):
            w = d.eq.noise.weight(key[1])
            out[key[1]][part.at] += w * (part.z.T.astype(np.float32) @ bank.columns[key])
            if key in bank.spoilt and part.spoilt is not None:
                w *= d.eq.stands_for[key]
                out[key[1]][part.at] -= w * (part.spoilt.T.astype(np.float32) @ bank.spoilt[key])
    return {c: m[first:] for c, m in out.items()}


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
    size = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    noise = noise / size / size[:, None]
    left = gram / size / size[:, None] - noise - (v / size).T @ (v / size)
    values, vectors = np.linalg.eigh(left)
    good = (values > FAINTEST) & (values > CLEAR * (values + np.diag(vectors.T @ noise @ vectors)))
    along = vectors[:, good].T @ (b / size)
    x = (vectors[:, good] @ (along / values[good])) / size
    return Drop(i, float(np.sum(along**2 / values[good])), x)
