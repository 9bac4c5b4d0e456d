"""Lists of cases: thirty for every day, three hundred for the record; any other number in the same proportions."""

from __future__ import annotations

import numpy as np

from tests.blind.cases import Request
from tests.blind.forms import EFFECTS, OUTSIDE

# shares of a suite by kind; the rest after rounding goes to `single`
SHARES = {
    "single": 0.30,
    "single_other": 0.25,
    "crowded": 0.10,
    "pair": 0.10,
    "clean": 0.07,
    "outside": 0.13,
    "ambiguous": 0.05,
}
OTHER_PLANS = ("noreps", "one_direction", "no_torque_sensor")


def counts(total: int) -> dict[str, int]:
    out = {kind: max(1, round(share * total)) for kind, share in SHARES.items()}
    out["single"] += total - sum(out.values())
    return out


def requests(total: int, seed: int) -> list[Request]:
    """`total` requests; effects come in turn, so that none is left out; one single in five has a poorer plan."""
    rng = np.random.default_rng([seed, 9])
    seeds = iter(int(s) for s in rng.choice(2**31, size=total, replace=False))
    inside, outside = endless(rng, EFFECTS), endless(rng, tuple(form.effect for form in OUTSIDE))
    out = []
    for kind, number in counts(total).items():
        for place in range(number):
            effect, plan = "", "complete"
            if kind in ("single", "single_other", "crowded", "pair"):
                effect = next(inside)
            if kind == "outside":
                effect = next(outside)
            if kind == "ambiguous":
                plan = "paper"
            if kind == "single" and place % 5 == 4:
                plan = OTHER_PLANS[place // 5 % len(OTHER_PLANS)]
            out.append(Request(kind, next(seeds), plan, effect))
    return [out[i] for i in rng.permutation(total)]


def endless(rng: np.random.Generator, names: tuple[str, ...]):
    """All names in a random order, again and again."""
    while True:
        yield from (str(name) for name in rng.permutation(names))
