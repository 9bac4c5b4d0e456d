"""The compiled inner loop of the plant: equations 6-7 with true sticking, fourth-order steps, events inside a step.

`advance` lets time pass, `advance_full` with what the paper's model lacks (the first is the second compiled without
it), `kinematic_error` is Eq. 8 with what load makes of it; the numbers of `layout` say what stands
where in their vectors. With numba switched off the same source runs as plain Python.

Numba's disk cache looks at the file a function is written in and not at the files of those it calls. So only the
functions of `entries` are cached, and the text of all files of this package is part of their key.

Substeps. Explicit Runge-Kutta turns wrong in silence before it turns infinite, so each substep keeps within a bound on
every rate: C_MODE on the fastest linear one, C_ORDER on the angle of the highest order, C_STRIBECK on falling friction.
What that leaves, as the largest error of θ_m/N − θ_l [rad] and of τ_l [N·m] at 1 kHz on the rig of benches/twin.toml
(a count of its load encoder is 7e-6 rad, a step of its torque sensor 1.5e-3 N·m):

    starting at                       as chosen       half            a quarter       against
    9.6 rpm, torque step, 1 s         7e-9   5e-5     4e-10  3e-6     3e-11  2e-7     DOP853 on the Lagrangian's forces
    120 rpm                           8e-9   5e-5     5e-10  3e-6     3e-11  2e-7     DOP853
    300 rpm                           1e-9   7e-6     8e-11  5e-7     7e-12  5e-8     DOP853
    500 rpm                           2e-10  1e-6     1e-11  9e-8     1e-12  8e-9     DOP853
    both sides reversing, 2 s         1e-8   1e-4     9e-10  7e-6     6e-11  4e-7     substeps a 64th as long
    stick and slip, 2 s               9e-8   4e-4     5e-9   2e-5     3e-10  2e-6     substeps a 64th as long

With what the paper's model lacks (2 s of both sides reversing under ±8 N·m, against substeps a 64th as long; the last
column what the energy ledger is open by, of the throughput, as chosen):

    spring of pieces, dead zone       8e-9   9e-5     1e-9   1e-5     7e-11  7e-7     2e-9
    hysteresis                        9e-9   7e-5     5e-10  4e-6     5e-11  4e-7     3e-9
    creep                             1e-8   9e-5     6e-10  4e-6     5e-11  4e-7     2e-9
    kinematic error by load           1e-8   9e-5     8e-10  5e-6     8e-11  6e-7     4e-9
    orders 2.04, 102, 0.02            8e-9   1e-4     2e-9   2e-5     9e-11  1e-6     8e-10
    friction by load, angle, heat     3e-8   2e-4     5e-9   4e-5     1e-9   8e-6     2e-9
    cogging, ripple                   1e-8   9e-5     1e-9   9e-6     1e-10  7e-7     9e-10
    unbalance, vibration              7e-8   6e-4     1e-9   1e-5     8e-11  6e-7     4e-9
    benches/twin-paper.toml           3e-8   3e-4     5e-9   5e-5     1e-9   1e-5     2e-9
    everything at once                4e-9   8e-5     8e-9   9e-5     4e-9   4e-5     4e-11

Friction converges more slowly where |T| and |ω|^(2/3) have a kink at zero: nobody looks for those.

Not looked for: a speed that touches zero, a held torque that touches its limit, or a φ that touches the end of its
piece, and turns back within one substep. Friction would have held, or let go, for less than that substep.
"""

from sim.kernel.entries import entries, text_of_the_package
from sim.kernel.layout import *  # noqa: F403

advance, advance_full, kinematic_error = entries(text_of_the_package())
