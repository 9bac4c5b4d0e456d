"""How well coefficients are known: by what leaving single runs out would change of them, and by the noise alone."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.special import stdtrit  # of scipy.stats the import takes half a second

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.model import Solution, evened, inverse
from rig.core.quantiles import Z95
from rig.model.effect import Array

PIECES = 4  # of a run and channel: each many correlation times long
CORRECTED = 2.0  # times a variance, at most, for coefficients that took on some of it: in half a dozen runs there are
# as many of them as clusters, each of thousands of rows, and next to nothing would be known
FEW = 12  # runs: with fewer their pieces are left out instead, each many correlation times long
SEVERAL = 4  # runs, of which whole ones are left out: of three the one that alone shows something says all of it
FREEDOM = 2.0  # degrees, and no fewer: of one run alone the runs say nothing
LEVERAGE = 0.9  # of what is known of something: a run with more of it cannot be told by the others


def covariance(s: Solution) -> Array:
    """Jackknife (p, p), all channels of a run together, so wide that ±Z95 σ is Student's 95 % interval
    [mackinnon1985; bell2002]

    Runs differ by what no row shows: gains that drift, small effects that are in no model. Without run r, whose normal
    matrix is G_r and whose score is u_r, the fit is off by (G − G_r)⁻¹·u_r. Two runs that say most of something have
    few degrees of freedom, however many others there are. Of few runs pieces of them are left out.
    """
    return _jackknife(s, -(-FEW // _runs(s)))


def between_runs(s: Solution) -> Array:
    """By how much the variance (p,) of each coefficient is larger when whole runs are left out where `covariance` takes
    their pieces: friction that is another one in every run is the same in all pieces of one. Of a run or two nothing is
    known of that: 0, as where there are runs enough."""
    if not SEVERAL <= _runs(s) < FEW:
        return np.zeros(s.x.size)
    return np.asarray(np.maximum(np.diag(_jackknife(s, 1)) - np.diag(covariance(s)), 0.0))


def _runs(s: Solution) -> int:
    return len({run for run, _ in s.keys})


def _jackknife(s: Solution, pieces: int) -> Array:
    """(p, p), each run being so many clusters."""
    scaled, scale = evened(s.gram)
    # sensor noise taken off can leave some below zero: of those, no more is known than by how much it was too much
    sizes, axes = np.linalg.eigh(scaled)
    root = (axes / np.sqrt(np.maximum(np.abs(sizes), 1e-11))).T * scale
    out, count = np.zeros_like(s.gram), 0
    expected, squares = np.zeros(s.x.size), np.zeros(s.x.size)
    for gram, score in _clusters(s, pieces):
        inner = root @ gram @ root.T
        share, along = np.linalg.eigh(inner)
        off = root.T @ (along @ ((along.T @ (root @ score)) / (1 - np.minimum(share, LEVERAGE))))
        out += np.outer(off, off)
        part = np.maximum(np.einsum("ji,jk,ki->i", root, inner, root), 0.0)  # of each variance, were all rows alike
        expected += part
        squares += part**2
        count += 1
    freedom = np.maximum(expected**2 / np.maximum(squares, 1e-300), FREEDOM)
    wide = stdtrit(freedom, 0.975) / Z95
    return np.asarray(out * (count - 1) / max(count, 1) * wide * wide[:, None])


def scatter(s: Solution) -> Array:
    """Cluster-robust covariance (p, p) of what the rows say by themselves: every run and channel in quarters. Narrower:
    one run that alone shows something counts in full      [liang1986]"""
    d = s.design
    meat, clusters = np.zeros_like(s.gram), 0
    for key in s.keys:
        (z, at), e = d.whole(key), s.residual(key)
        for part in (_part(e.size, i, PIECES) for i in range(PIECES)):
            u = d.eq.noise.weight(key[1]) * (z[part].T @ e[part])
            meat[np.ix_(at, at)] += np.outer(u, u)
            clusters += 1
    bread = inverse(s.gram)
    return np.asarray(bread @ meat @ bread * min(clusters / max(1, clusters - d.size), CORRECTED))


def _part(n: int, i: int, of: int) -> slice:
    """The i-th of so many parts of n rows, the first ones longer by one where they do not come out even."""
    each, more = divmod(n, of)
    return slice(i * each + min(i, more), (i + 1) * each + min(i + 1, more))


def _clusters(s: Solution, pieces: int) -> Iterator[tuple[Array, Array]]:
    """Normal matrix (p, p) and score (p,) of so many pieces of each run."""
    for run in sorted({run for run, _ in s.keys}):
        keys = [key for key in s.keys if key[0] == run]
        blocks = {key: (*s.design.whole(key), s.residual(key)) for key in keys}
        for i in range(pieces):
            gram, score = np.zeros_like(s.gram), np.zeros(s.x.size)
            for key, (z, at, e) in blocks.items():
                some = _part(e.size, i, pieces)
                weight = s.design.eq.noise.weight(key[1])
                gram[np.ix_(at, at)] += weight * (z[some].T @ z[some])
                score[at] += weight * (z[some].T @ e[some])
            yield gram, score


def is_sure(s: Solution, name: str, least: float, times: float) -> bool:
    """Whether a coefficient of the baseline, in its unit, is larger than `least` and so many `times` half its 95 %
    interval."""
    at = INDEX[name]
    half = Z95 * float(np.sqrt(max(covariance(s)[at, at], 0.0)))
    return max(least, times * half) < abs(s.value(name))
