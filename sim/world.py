"""The twin's world: plant and virtual clock in one. Time passes only when someone waits."""

from __future__ import annotations

import heapq
import itertools
import math
import time
from collections.abc import Callable

from rig.core.clock import Clock
from rig.core.errors import UsageError
from sim.assembly import assembled
from sim.energy import Ledger
from sim.noise import generator, normal
from sim.parameters import TwinParameters
from sim.plant import Plant, Truth

UNPLANNED = math.inf
RELAX = 0.001  # s of wall time, for other processes to catch up
WANDER_SHARE = 0.05  # of its correlation time: friction is held constant for this long at most
CREEPING = 1e-4  # rad/s, 20 arcsec/s: nobody sees it, and after a halt the load comes to rest through it
MOST_LOAD = 1000.0  # N·m, more than a gear of this size survives
MOST_DEPTH = 10.0  # mm, farther the wave generator is out of the gear


class World(Clock):
    """The rig that is not there: at rest at first, at angles drawn from `seed`, its spring relaxed.

    Held by one thread. `wait_until` is the virtual clock; behind a wall clock, `advance_to` lets the world catch up.
    Raises PlantFailure when the plant cannot be followed; time then stands still.
    """

    def __init__(self, parameters: TwinParameters, seed: int) -> None:
        self.parameters = self._as_made = parameters
        self.seed = seed
        self._assemblies = 0  # since then
        self.t = 0.0  # s, now
        turns = float(generator(seed, "start").uniform(0.0, parameters.gear.ratio))  # of the motor: one of the output
        self.plant = Plant(parameters, theta_m=2.0 * math.pi * turns)
        self._wander = normal(seed, "friction")
        self._longest = WANDER_SHARE * parameters.friction_noise_s
        self._tau = 0.0  # N·m, commanded
        self._lapse = UNPLANNED  # when the command lapses
        self._on_lapse: Callable[[], None] = lambda: None
        self._plans: list[tuple[float, int, Callable[[], None]]] = []
        self._order = itertools.count()
        self._next = UNPLANNED  # the earliest of all that will happen by itself

    def now(self) -> float:
        """s since the world began."""
        return self.t

    def wait_until(self, t: float) -> float:
        """Let time pass until `t` s."""
        while self.t < t:
            until = t
            if until - self.t > self._longest:
                until = self.t + self._longest
            if until > self._next:
                until = self._next
            self.plant.advance(until - self.t, self._tau, self._wander(), self._wander())
            self.t = until
            if until >= self._next:
                self._happen()
        return self.t

    def advance_to(self, t: float) -> None:
        """Catch up with a wall clock that shows `t` s; nothing when the world is already there."""
        self.wait_until(t)

    def relax(self) -> bool:
        """Time is held here; other processes get a moment."""
        time.sleep(RELAX)
        return True

    def command(self, tau: float, lapse: float = UNPLANNED, on_lapse: Callable[[], None] = lambda: None) -> None:
        """From now on the drive aims at `tau` N·m; at `lapse` s, unless commanded again, it lets go and says so."""
        self._tau, self._lapse, self._on_lapse = tau, lapse, on_lapse
        plans = self._plans
        self._next = lapse if not plans or lapse < plans[0][0] else plans[0][0]

    def at(self, t: float, act: Callable[[], None]) -> None:
        """Have `act` called when the world reaches `t` s, between two steps of the plant: a fault, a load, a lock."""
        heapq.heappush(self._plans, (max(t, self.t), next(self._order), act))
        self._next = min(self._lapse, self._plans[0][0])

    def _happen(self) -> None:
        if self.t >= self._lapse:
            on_lapse = self._on_lapse
            self.command(0.0)
            on_lapse()
        while self._plans and self._plans[0][0] <= self.t:
            heapq.heappop(self._plans)[2]()
        self._next = min(self._lapse, self._plans[0][0] if self._plans else UNPLANNED)

    def load_torque(self, tau_ext: float) -> None:
        """Put `tau_ext` N·m on the load, positive drives it forward: a dead weight on a pulley. Raises UsageError."""
        if not abs(tau_ext) <= MOST_LOAD:  # nor what is no number
            raise UsageError(f"a weight of {tau_ext:g} N·m: expected a number from {-MOST_LOAD:g} to {MOST_LOAD:g} N·m")
        self.plant.tau_ext = tau_ext

    def lock_output(self) -> None:
        """Clamp the output where it is; a hand stops one that only creeps. Raises UsageError while it turns."""
        omega_l = self.truth().omega_l
        if abs(omega_l) > CREEPING:
            raise UsageError(f"the output turns at {omega_l:.3g} rad/s, it can be locked at rest only")
        self.plant.lock()

    def unlock_output(self) -> None:
        """Let the output turn again; a wound-up spring will move it."""
        self.plant.locked = False

    def reassemble(self, depth_mm: float) -> None:
        """Take the gear apart and together again, wave generator `depth_mm` mm from the reference depth.

        What chance makes of the kinematic error this time comes from the seed; `parameters` then says it. The spring is
        relaxed afterwards, so angles read before do not compare; the energy ledger starts anew. Raises UsageError while
        it turns, and for what is no depth.
        """
        if not abs(depth_mm) <= MOST_DEPTH:  # nor what is no number
            raise UsageError(f"a depth of {depth_mm:g} mm: expected a number from {-MOST_DEPTH:g} to {MOST_DEPTH:g} mm")
        x = self.truth()
        if x.omega_m != 0.0 or x.omega_l != 0.0:
            raise UsageError(f"the motor turns at {x.omega_m:.3g} rad/s, the gear can be reassembled at rest only")
        self._assemblies += 1
        chance = generator(self.seed, f"assembly {self._assemblies}")
        self.parameters = assembled(self._as_made, depth_mm, chance)
        self.plant.rebuild(self.parameters)

    def truth(self) -> Truth:
        """What really happens now, SI."""
        return self.plant.truth()

    def ledger(self) -> Ledger:
        """Where the energy went since the world began."""
        return self.plant.ledger()
