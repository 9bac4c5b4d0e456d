"""One case: what is hidden in which campaign, simulated, sized and described. Suites are lists of cases."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from tests.blind import rig as rigs
from tests.blind.builder import Builder
from tests.blind.campaign import simulate
from tests.blind.forms import EFFECTS, LIBRARY, OUTSIDE, Form, form_of, forms_of
from tests.blind.plans import PLANS
from tests.blind.residual import residuals, rms
from tests.blind.sensors import draw_noise
from tests.blind.strength import (
    Stage,
    calibrate,
    excess_of,
    over_floor,
    over_floor_with_own_zeros,
    shape_rng,
    short,
    size,
)
from tests.blind.taken import Taken

Truth = dict[str, object]
KINDS = ("single", "single_other", "crowded", "pair", "clean", "outside", "ambiguous")


@dataclass(frozen=True)
class Request:
    """What to make: kind, effect and form ('': drawn), plan, seed, strength over the floor (0: drawn)."""

    kind: str
    seed: int
    plan: str = "complete"
    effect: str = ""
    form: str = ""
    over_floor: float = 0.0


@dataclass(frozen=True)
class Part:
    """One hidden effect. `alone`: residual over floor it reaches by itself (foretold)."""

    form: Form
    strength: float
    role: str
    alone: float

    def described(self) -> dict[str, object]:
        return {
            "effect": self.form.effect,
            "form": self.form.name,
            "textbook": self.form.textbook,
            "role": self.role,
            "strength": self.strength,
            "size_alone": self.alone,
            "coordinates": list(self.form.coordinates),
        }


@dataclass(frozen=True)
class Case:
    """A campaign and what is hidden in it."""

    stage: Stage
    runs: list[Taken]
    truth: Truth


def any_of(rng: np.random.Generator, forms: tuple[Form, ...]) -> Form:
    """First an effect, then one of its forms: effects with many forms come no more often."""
    names = tuple(dict.fromkeys(form.effect for form in forms))
    name = names[int(rng.integers(len(names)))]
    own = [form for form in forms if form.effect == name]
    return own[int(rng.integers(len(own)))]


def asked(request: Request, rng: np.random.Generator, pool: tuple[Form, ...]) -> Form:
    """The form a request names, or one drawn from the pool."""
    if request.form:
        return form_of(request.effect, request.form)
    if request.effect:
        named = tuple(form for form in pool if form.effect == request.effect)
        return any_of(rng, named or forms_of(request.effect))
    return any_of(rng, pool)


def textbook(known: bool) -> tuple[Form, ...]:
    return tuple(form for form in LIBRARY if form.textbook == known)


def mains(request: Request, rng: np.random.Generator) -> list[Form]:
    """Forms that are to be found, by kind."""
    if request.kind == "clean":
        return []
    if request.kind == "outside":
        return [asked(request, rng, OUTSIDE)]
    if request.kind == "ambiguous":
        undecided = ("quadratic_drag", "thermal_friction_drift")
        return [asked(request, rng, tuple(form for form in LIBRARY if form.effect in undecided))]
    if request.kind == "single_other":
        return [asked(request, rng, textbook(False))]
    if request.kind == "single":
        return [asked(request, rng, textbook(True))]
    first = asked(request, rng, LIBRARY)
    if request.kind == "crowded":
        return [first]
    while True:
        second = any_of(rng, LIBRARY)
        if second.effect != first.effect and compatible([first, second]):
            return [first, second]


def compatible(forms: list[Form]) -> bool:
    """Whether the plant can hold these forms at once."""
    builder = Builder(rigs.draw(np.random.default_rng(0), 10.0, 30.0))
    try:
        for place, form in enumerate(forms):
            form.build(builder, shape_rng(0, place), 0.5)
    except ValueError:
        return False
    return True


def small_forms(main: Form, rng: np.random.Generator) -> list[Form]:
    """Eight other effects the plant can hold beside the main one."""
    chosen: list[Form] = []
    skip = {main.effect, "missed_counts", "torsional_mode", "presliding_friction"}  # these have no small size
    for name in rng.permutation([name for name in EFFECTS if name not in skip]):
        form = any_of(rng, forms_of(str(name)))
        if len(chosen) < 8 and compatible([main, *chosen, form]):
            chosen.append(form)
    return chosen


def small_parts(stage: Stage, main: Form, rng: np.random.Generator, clean: list[Taken]) -> list[Part]:
    """Eight effects at 1.01 to 1.12 times the floor, each by itself: there, and not worth a name."""
    out = []
    for place, form in enumerate(small_forms(main, rng), 1):
        excess = float(rng.uniform(0.14, 0.5))  # root of the ratio squared less one; grows with the strength
        whole = max(excess_of(stage, form, place, 1.0, clean), 0.05)
        out.append(Part(form, min(excess / whole, form.strongest), "small", float(np.hypot(1, excess))))
    return out


def make(request: Request) -> Case:
    """Draw, size, simulate. The same request gives the same case."""
    rng = np.random.default_rng([request.seed, 1])
    plan = PLANS[request.plan]()
    stage = Stage(rigs.draw(rng, *plan.resonance_hz), draw_noise(rng), plan, request.seed)
    found = mains(request, rng)
    clean = simulate(Builder(stage.rig), plan, stage.noise, stage.seed)
    kept = {run.name for run in short(plan).runs}
    brief = [run for run in clean if run.plan.name in kept]
    parts: list[Part] = []
    for place, form in enumerate(found):
        least = 4.0 if request.kind == "crowded" else 1.3
        target = request.over_floor or float(np.exp(rng.uniform(np.log(least), np.log(20.0))))
        strength, alone = calibrate(stage, form, place, target, brief)
        parts.append(Part(form, strength, "main", alone))
    if request.kind == "crowded":
        parts += small_parts(stage, found[0], rng, brief)
    return assemble(request, stage, parts, clean)


def assemble(request: Request, stage: Stage, parts: list[Part], clean: list[Taken]) -> Case:
    """Put all parts into one plant, run it, and write down what was done."""
    builder, described = Builder(stage.rig), []
    for place, part in enumerate(parts):
        parameters = part.form.build(builder, shape_rng(stage.seed, place), part.strength)
        described.append(part.described() | {"parameters": {k: float(v) for k, v in parameters.items()}})
    runs = clean if not parts else simulate(builder, stage.plan, stage.noise, stage.seed)
    excess = over_floor(runs, clean) | {"theta_l_own_zeros": over_floor_with_own_zeros(runs, clean)}
    floor = {channel: {name: rms(e) for name, e in by.items()} for channel, by in residuals(clean)[0].items()}
    inside = [d["effect"] for d in described if d["role"] == "main" and not d["coordinates"]]
    truth: Truth = {
        "kind": request.kind, "plan": stage.plan.name, "seed": request.seed, "effects": inside, "hidden": described,
        "over_floor": excess, "size": size(excess, tuple(inside), stage.plan.channels), "rig": stage.rig.as_truth(),
        "noise": asdict(stage.noise), "floor": floor, "resonance_hz": stage.rig.resonance_hz(),
    }  # fmt: skip
    return Case(stage, runs, truth)
