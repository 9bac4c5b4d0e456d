"""The rig in space, turning as measured; only the flexspline is drawn deformed beyond measure, and the picture says so.

Along x: motor, wave generator inside the flexspline, torque sensor, load disc. The circular spline stands still; the
flexspline has two teeth less, so the output turns against the wave generator.      [ghorbel2001]
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rig.live.view import colours
from rig.live.view.about import About
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas, Pen, Solid
from rig.live.view.drawing import Drawing

Array = np.ndarray[Any, Any]

PATH = "/rig"
CUP = 30.0  # mm, mean radius of the flexspline as drawn
DEPTH = 34.0  # mm, length of the cup, open at x = 0
DRAWN = 4.0  # mm, radial deflection as drawn; the real one is CUP/N, half the difference of the pitch diameters
TOOTH = 2.2  # mm
MARKS = 12  # lines along the cup that belong to its material
DISC = 88.0, 50.0  # mm: where the load disc stands, its radius
RATE = 20.0  # pictures a second


class Space(Drawing):
    """Motor angle turns the wave generator and the flexspline's shape, load angle the cup's material and the disc."""

    def __init__(self, about: About) -> None:
        self._about = about
        self._times = DRAWN * about.ratio / CUP  # how much larger than real

    def draw(self, t: float, canvas: Canvas) -> None:
        """Everything that keeps its shape: it is drawn once and has no time."""
        _stand(canvas)
        _wave_generator(canvas)
        _flexspline(canvas)
        _output(canvas, self._about.locked)
        where = np.array([[-70, 0, 36], [2, 0, 60], [DISC[0], 0, 64], [16, 0, -56]], dtype=np.float32)
        words = [
            "motor",
            "circular spline",
            "load disc",
            f"deformation of the flexspline drawn {self._times:.0f} times",
        ]
        canvas.signs(f"{PATH}/words", where, words, colours.MUTED)
        if self._about.banner:
            above = np.array([[16, 0, 82]], dtype=np.float32)
            canvas.signs(f"{PATH}/banner", above, [self._about.banner], colours.MARK)

    def add(self, block: Block, canvas: Canvas) -> None:
        """Takes the rows of a run: angles [rad] turn the bodies, the material marks go with both."""
        shown = _pictures(block)
        theta_m, theta_l = _held(shown["theta_m"]), _held(shown["theta_l"])
        canvas.turn(f"{PATH}/wave_generator", shown.t, theta_m)
        canvas.turn(f"{PATH}/flexspline", shown.t, theta_m)
        canvas.turn(f"{PATH}/output", shown.t, -theta_l)
        marks = material(float(theta_m[-1]), float(-theta_l[-1]))
        canvas.wires(f"{PATH}/material", float(shown.t[-1]), marks, Pen(colours.WARN, 0.5))


def _pictures(block: Block) -> Block:
    """The rows at RATE, the last one among them."""
    every = max(int(len(block) / max(RATE * (block.t[-1] - block.t[0]), 1.0)), 1)
    return Block(block.rows[::-1][::every][::-1])


def _held(angle: Array) -> Array:
    """An angle that was not measured stays where it was; one that never was is zero."""
    there = np.isfinite(angle)
    last = np.maximum.accumulate(np.where(there, np.arange(len(angle)), 0))
    return np.nan_to_num(angle[last])


def deflection(phi: Array, theta_m: float, x: Array | float) -> Array:
    """Radius [mm] at angle `phi` [rad] and depth `x` [mm]: two waves that turn with the generator, less towards the
    cup's floor; in the shape the two have together.
    """
    return np.asarray(CUP + DRAWN * (1.0 - x / DEPTH) * np.cos(2 * (phi - theta_m)))


def ring(radius: Array | float, x: float, phi: Array) -> Array:
    """A line around the axis, shape (n, 3), mm."""
    r = np.broadcast_to(radius, phi.shape)
    points = np.stack((np.full_like(phi, x), r * np.sin(phi), r * np.cos(phi)), axis=1)
    return np.asarray(points, dtype=np.float32)


def material(theta_m: float, turned: float) -> list[Array]:
    """Lines along the cup at angles fixed to its material, which has `turned` [rad]; on the deformed shape."""
    x = np.linspace(0.0, DEPTH, 6)
    phi = (turned + np.arange(MARKS) * 2 * np.pi / MARKS)[:, None]
    r = deflection(phi, theta_m, x)
    return list(np.stack((np.broadcast_to(x, r.shape), r * np.sin(phi), r * np.cos(phi)), axis=2).astype(np.float32))


def _around(n: int = 121) -> Array:
    return np.linspace(0.0, 2 * np.pi, n)


def _stand(canvas: Canvas) -> None:
    """What never moves: the motor's housing, the circular spline with its teeth."""
    canvas.solid(f"{PATH}/motor", Solid(-70.0, 44.0, 24.0, colours.DARK_STEEL))
    outer, teeth = CUP + DRAWN + TOOTH, 204
    phi = _around(2 * teeth + 1)
    toothed = outer + TOOTH * 0.5 * np.where(np.arange(len(phi)) % 2, 1.0, -1.0)
    rims = [ring(toothed, x, phi) for x in (-3.0, 9.0)] + [ring(outer + 12.0, x, _around()) for x in (-3.0, 9.0)]
    canvas.wires(f"{PATH}/circular_spline", None, rims, Pen(colours.STEEL, 0.5))


def _wave_generator(canvas: Canvas) -> None:
    """An ellipse, its long axis marked, on the motor's shaft."""
    long, short = CUP + DRAWN - 2.0, CUP - DRAWN - 2.0
    canvas.disc(f"{PATH}/wave_generator/plug", (5.0, short, long), colours.FORWARD_SOFT)
    mark = np.array([[-5.5, 0, -long], [-5.5, 0, long]], dtype=np.float32)
    canvas.wires(f"{PATH}/wave_generator/mark", None, [mark], Pen(colours.FORWARD, 1.0))
    canvas.solid(f"{PATH}/wave_generator/shaft", Solid(-26.0, 44.0, 5.0, colours.STEEL))


def _flexspline(canvas: Canvas) -> None:
    """The cup's shape, which turns with the wave generator; its material does not."""
    phi = _around()
    rings = [ring(deflection(phi, 0.0, x), x, phi) for x in (0.0, 6.0, 12.0, 20.0, DEPTH)]
    canvas.wires(f"{PATH}/flexspline/shape", None, rings, Pen(colours.REVERSE, 0.6))


def _output(canvas: Canvas, locked: bool) -> None:
    """Floor of the cup, torque sensor, load disc with a mark; a pin where the output is locked."""
    x, radius = DISC
    canvas.solid(f"{PATH}/output/floor", Solid(DEPTH + 1.5, 3.0, CUP, colours.REVERSE_SOFT))
    canvas.solid(f"{PATH}/output/shaft", Solid(60.0, 50.0, 7.0, colours.STEEL))
    canvas.solid(f"{PATH}/output/sensor", Solid(60.0, 14.0, 14.0, colours.BRASS))
    canvas.solid(f"{PATH}/output/disc", Solid(x, 8.0, radius, colours.DARK_STEEL))
    spoke = np.array([[x - 5, 0, 0], [x - 5, 0, radius], [x + 5, 0, radius], [x + 5, 0, 0]], dtype=np.float32)
    canvas.wires(f"{PATH}/output/mark", None, [spoke], Pen(colours.WARN, 1.2))
    if locked:
        pin = np.array([[x - 14, 0, -radius + 9], [x + 22, 0, -radius + 9]], dtype=np.float32)
        canvas.wires(f"{PATH}/pin", None, [pin], Pen(colours.BAD, 3.0))
        canvas.signs(f"{PATH}/pin_word", pin[1:] + np.float32(6), ["locked"], colours.BAD)
