"""Products of a model's columns with the bank: those of the columns, and made once for the same ones."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import crossed as module
from rig.analysis.tracing.fit.channels import BASELINE
from rig.analysis.tracing.fit.crossed import Crossed
from rig.analysis.tracing.fit.equations import Bare
from rig.analysis.tracing.fit.model import Part

KEYS = ((0, "A"), (0, "M"), (1, "A"))
ROWS = {(0, "A"): 40, (0, "M"): 30, (1, "A"): 20}
WIDTHS = {"A": 6, "M": 4}
FIRST = len(BASELINE)


@pytest.fixture
def bank(rng: np.random.Generator) -> Crossed:
    columns = {key: rng.standard_normal((ROWS[key], WIDTHS[key[1]])).astype(np.float32) for key in KEYS}
    spoilt = {(0, "A"): rng.standard_normal((ROWS[0, "A"], WIDTHS["A"])).astype(np.float32)}
    return Crossed(columns, spoilt, WIDTHS)


def part(rng: np.random.Generator, key: tuple[int, str], at: np.ndarray) -> Part:
    """Some columns of a block; in one of them noise is known."""
    spoilt = Bare(0.1 * rng.standard_normal((ROWS[key], at.size))) if key == (0, "A") else None
    return Part(Bare(rng.standard_normal((ROWS[key], at.size))), at, spoilt)


def model(*terms: dict[tuple[int, str], Part], baseline: dict[tuple[int, str], Part]) -> Any:
    """A design with two coefficients a term."""
    parts = {key: (baseline[key], *(term[key] for term in terms if key in term)) for key in KEYS}
    noise = SimpleNamespace(weight=lambda channel: {"A": 2.0, "M": 3.0}[channel])
    eq = SimpleNamespace(noise=noise, stands_for={(0, "A"): 1.5})
    place = lambda i: slice(FIRST + 2 * i, FIRST + 2 * i + 2)  # noqa: E731
    return SimpleNamespace(eq=eq, terms=terms, parts=parts, place=place, size=FIRST + 2 * len(terms))


def moved(term: dict[tuple[int, str], Part], by: int) -> dict[tuple[int, str], Part]:
    """The same columns at another place of the model."""
    return {key: Part(p.z, p.at + by, p.spoilt) for key, p in term.items()}


def straight(bank: Crossed, d: Any) -> dict[str, np.ndarray]:
    """The same products, block by block in double precision."""
    out = {c: np.zeros((d.size, width)) for c, width in WIDTHS.items()}
    for key in KEYS:
        w = d.eq.noise.weight(key[1])
        for p in d.parts[key]:
            out[key[1]][p.at] += w * (p.z.whole().T @ bank.columns[key])
            if p.spoilt is not None:
                out[key[1]][p.at] -= w * d.eq.stands_for[key] * (p.spoilt.whole().T @ bank.spoilt[key])
    return out


@pytest.fixture
def made(rng: np.random.Generator) -> tuple[dict[tuple[int, str], Part], ...]:
    """A baseline, of which each channel has other coefficients, and two terms, one of which acts in one channel."""
    baseline = {key: part(rng, key, np.array([0, 3, 7]) if key[1] == "A" else np.array([1, 2])) for key in KEYS}
    one = {key: part(rng, key, np.array([FIRST, FIRST + 1])) for key in KEYS}
    other = {key: part(rng, key, np.array([FIRST + 3])) for key in KEYS if key[1] == "A"}
    return baseline, one, other


def test_they_are_those_of_the_columns_and_what_noise_adds_is_taken_off(bank: Crossed, made: Any) -> None:
    baseline, one, other = made
    d = model(one, other, baseline=baseline)
    found, wanted = bank.of(d, KEYS), straight(bank, d)
    assert {c: x.shape for c, x in found.items()} == {c: (d.size, width) for c, width in WIDTHS.items()}
    for c, x in found.items():
        np.testing.assert_allclose(x, wanted[c], atol=1e-4)


def test_what_stays_of_a_model_is_not_made_again_wherever_it_stands_in_it(bank: Crossed, made: Any) -> None:
    baseline, one, other = made
    bank.of(model(one, other, baseline=baseline), KEYS)
    assert bank.made == 3
    d = model(moved(other, -2), moved(one, 2), baseline=baseline)
    found, wanted = bank.of(d, KEYS), straight(bank, d)
    assert bank.made == 3
    for c, x in found.items():
        np.testing.assert_allclose(x, wanted[c], atol=1e-4)


def test_a_column_that_changed_is_made_again(bank: Crossed, made: Any) -> None:
    baseline, one, _ = made
    bank.of(model(one, baseline=baseline), KEYS)
    changed = dict(one)
    changed[1, "A"] = Part(Bare(1.001 * one[1, "A"].z.whole()), one[1, "A"].at, None)
    d = model(changed, baseline=baseline)
    np.testing.assert_allclose(bank.of(d, KEYS)["A"], straight(bank, d)["A"], atol=1e-4)
    assert bank.made == 3


def test_other_blocks_and_another_weight_are_asked_for_anew(bank: Crossed, made: Any) -> None:
    baseline, *_ = made
    d = model(baseline=baseline)
    whole = bank.of(d, KEYS)["A"]
    part_of_it = bank.of(d, KEYS[:2])["A"]
    d.eq.noise.weight = lambda channel: 4.0
    np.testing.assert_allclose(bank.of(d, KEYS)["A"], 2.0 * whole, atol=1e-4)
    assert not np.allclose(part_of_it, whole)


def test_no_more_is_kept_than_there_is_room_for(bank: Crossed, made: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    baseline, one, other = made
    monkeypatch.setattr(module, "ROOM", 0)
    d = model(one, other, baseline=baseline)
    np.testing.assert_allclose(bank.of(d, KEYS)["A"], straight(bank, d)["A"], atol=1e-4)
    assert len(bank.kept) == 1
