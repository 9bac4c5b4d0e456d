"""What an effect is: the columns it adds to the equations at its ports, and the shapes and signs it may have."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from rig.model.effect.fit import Fit, Parameter, Shape
from rig.model.effect.known import Known
from rig.model.effect.port import Port
from rig.model.effect.reach import Reach
from rig.model.effect.signals import Signals
from rig.model.gloss import gloss

Array = npt.NDArray[np.float64]


class Effect(ABC):
    """One physical effect the paper's model lacks. Members are stateless; the catalogue holds one of each."""

    name: ClassVar[str]  # also the file's name
    in_short: ClassVar[str]  # one line for people
    glosses: ClassVar[Mapping[str, str]] = {}  # what its parameters are, by name; see rig/model/gloss.py
    source: ClassVar[str]  # key in rig/model/references.py, with the equation where there is one
    shape_names: ClassVar[tuple[str, ...]] = ()
    adds: ClassVar[frozenset[str]] = frozenset()  # parameters that several terms of it have `together`
    remembers: ClassVar[bool] = False  # its state when a run begins is unknown: beside it every run has its own zero
    backbone: ClassVar[bool] = False  # a loop in torque against wind-up has a mean curve that looks like it
    in_the_spring: ClassVar[bool] = False  # the wind-up alone shows it, of a motor that is held too
    needs: ClassVar[frozenset[str]] = frozenset()  # channels without which it cannot be told from the baseline
    comes_round: ClassVar[bool] = False  # a wave of the motor's angle, the order of which is its first shape parameter
    of_reading: ClassVar[str] = ""  # the torque it is a function of, and whose reading it corrects: tau_m or torque
    each_run: ClassVar[bool] = False  # every run has coefficients of its own: a phase, an instant
    modes_apart: ClassVar[float] = np.inf  # of its first loose shape parameter: so much higher, a term is another mode
    loose: ClassVar[tuple[bool, ...]] = ()  # which shape parameters a refit may move; the others are chosen, not fitted
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType({})  # shape of textbook laws, by name

    @abstractmethod
    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """The shapes worth trying on such a campaign; `((),)` when the effect has none; () when it cannot show."""

    def shapes_beside(self, reach: Reach) -> tuple[Shape, ...]:
        """Shapes that mean something beside another term of the effect alone; no search tries them by themselves."""
        return ()

    @abstractmethod
    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Columns (n, k) at each port the effect acts on, one set of k coefficients for all of them."""

    @abstractmethod
    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """The coefficients in the words of the field."""

    def gloss(self, name: str) -> str:
        """What its parameter of that name is, a short phrase; "" where nothing is said of it."""
        return gloss(self.glosses, name)

    def plausible(self, fit: Fit) -> bool:
        """False when the coefficients have a sign or size no such effect can have."""
        return True

    def plausible_together(self, fits: Sequence[Fit]) -> bool:
        """False when several terms of it, each of which may be, make what no such effect is."""
        return True

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Range of each shape parameter in a refit."""
        grid = np.array(self.shapes(reach), dtype=float)
        if grid.size == 0:
            return ()
        return tuple((float(low), float(high)) for low, high in zip(grid.min(0) / 3, grid.max(0) * 3, strict=True))

    def has_state(self) -> bool:
        """Whether what it does at a row depends on more than that row and its neighbours: then its columns in a part of
        a piece have to be cut from those of the whole. Not of one that asks for `Signals.states`."""
        return False

    def swings(self, shape: Shape) -> tuple[float, float] | None:
        """ω [rad/s] and ζ of a mode of its own that a run may begin with in full swing; None of one without."""
        return None

    def holds(self, shape: Shape) -> bool:
        """Whether a term of that shape leaves nothing to a second one of the effect but what its law has wrong."""
        return False

    def moved_by_noise(self, shape: Shape) -> bool:
        """True when in this shape noise of a reading moves a state of its own, and does not add to its columns."""
        return False

    def sizes(self, parameters: Sequence[Parameter]) -> Sequence[Parameter]:
        """Those that tell how large it is, whichever is known best; `parameters` as `parameters` gives them."""
        return parameters[:1]

    def is_scaled(self, scale: Parameter, reach: Reach) -> bool:
        """Whether the number that scales the law (a speed, a torque, a time), with its interval, says anything of it;
        else what it explains is a difference between some runs and others, which many laws make."""
        return not scale.holds_zero

    def beyond(self, shape: Shape, reach: Reach) -> bool:
        """True when a fit ended where the campaign shows nothing of the law itself, a resonance above its band."""
        return False

    def together(self, name: str, fits: Sequence[Fit]) -> float:
        """One of those that it `adds`, of several terms: the sum of what each says of it by itself."""
        return float(sum(p.value for fit in fits for p in self.parameters(fit) if p.name == name))

    def unloaded(self, order: int, known: Known, shape: Shape) -> Array:
        """Cosine and sine of an order of θ̃_p that each coefficient adds to the baseline's without load, (2, k) or, of
        one that adds none, (2, 0)."""
        return np.zeros((2, 0))

    def softens(self, fit: Fit) -> tuple[float, Array]:
        """The compliance of its own that the baseline's 1/K holds as well, rad/(N·m), and its gradient by coefficients
        (k,)."""
        return 0.0, np.zeros(fit.coefficients.size)

    def gives(self, torque: Array, shape: Shape) -> Array:
        """By what each coefficient adds to the spring's compliance at `torque` (n,), (n, k); (n, 0) of one that is no
        curve of the spring."""
        return np.zeros((torque.size, 0))

    def drags(self, shape: Shape) -> float:
        """How much of what it does to dφ/dT counts twice in what the damper beside the spring delays, B_sp·(dφ/dT)²·Ṫ:
        1 of a curve or a loop in the whole torque, a half in that which the spring holds, 0 where it is no part of the
        spring or comes as late as the damper makes it."""
        return 0.0

    def expands(self, shape: Shape) -> bool:
        """True when the columns are an expansion about a shape that should equal the coefficients."""
        return False

    def about(self, shape: Shape, coefficients: Array) -> Shape:
        """The shape to expand about, once the coefficients are known."""
        return shape
