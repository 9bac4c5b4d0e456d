"""Thresholds and settings of a trace, each with its reason: of reading, floor, fit, search, selection and verdict.

What belongs to one method alone (its bins, steps, draws, and now and then a limit of its own) stands in its module.
"""

from __future__ import annotations

from typing import Final

from rig.model.effects.channel_time_skew import FILTERED

RATE: Final = 250.0  # Hz, faster runs are brought down to about this first: 15 orders at 400 rpm end at 100 Hz
BANDWIDTH: Final = 36.0  # Hz, standard deviation of the low-pass: J_m·ω̇ of a 16-bit encoder is then 1 mN·m of noise
# times both, in a look at what rings above that; but for the motor's torque, whose J_m·ω̇ would be 6 mN·m of noise
FASTER: Final = 2.0
# rad/s of the motor; below it friction is not sliding friction: noise of a 16-bit encoder is a tenth
SLOWEST_TURNING: Final = 0.04
LOOSE: Final = 0.01  # s on both sides of a reversal in which the motor may stick: nothing is known of its friction
SETTLING: Final = 0.05  # s left out of the torque equations on both sides of a reversal: what stuck has come loose

MESH: Final = 3e-3  # N·m·s/rad, how large B_ml may be beside the torque sensor: twice the paper's kind of gear
SECOND: Final = 1e-6  # s², (B_sp/K)²: a damping ratio of 5 % at 16 Hz, the second order of the spring's damping
LATEST: Final = 1e-3  # s, how late at most; and no sensor is early
HEAVIER: Final = 0.25  # kg·m², by how much a load nobody stated is likely to differ from what it was taken for
LAG: Final = FILTERED  # s, how late a torque sensor's own low-pass may make it
ZERO: Final = 0.01  # N·m, how far a torque sensor's zero wanders between runs where no repeats show it

GAIN: Final = 5e-4  # of the torque: a torque sensor of accuracy class 0.05, where no repeats show it
TURNED_BACK: Final = 1.5  # of the motor torque's floor: single counts and channels read 0.1 ms apart tell there
FLOOR_LEAST: Final = 400  # rows that two repeats must share before their difference is believed
UNCORRELATED: Final = 0.05  # of the autocorrelation: below it rows count as independent

FAINTEST: Final = 1e-5  # share of a column that must be its own before it is solved for
NOISE_ALONE: Final = (
    1e-9  # of what noise adds to a column, its own at least: a column that is noise alone is not divided by
)
RELATIVE: Final = 3e-4  # of the first effect's evidence: below a sixtieth of its size lies what its law has wrong
CLEAR: Final = 0.5  # share of a column beside the model that must not be sensor noise
EVIDENCE: Final = 12.0  # nats; at 300 variants tried, chance gets there once in a thousand campaigns
OTHER_LAW: Final = 0.01  # of an effect's evidence and of the noise's: a tenth of either's size makes no other law

NAMED: Final = 0.6  # of the held-out excess an effect must remove; true ones 0.73 and more, mimics 0.21 at most
EXPLAINED: Final = 1.3  # held-out RMS over floor below which nothing more is looked for
NOTEWORTHY: Final = (
    1.15  # the same where one coordinate foretells all of it; 29 clean campaigns of seven exams end at 1.15
)
WHATEVER: Final = 5.0  # of the floor, RMS: twice such a floor would still be far below
MOST: Final = 10  # terms: a rig with more effects than that is not explained by adding another
SMALLEST: Final = 0.35  # of the floor, RMS where it matters most: smaller ones move no error by 6 %
PLAIN_TO_SEE: Final = 0.7  # the same where the baseline alone is at the floor: half of a floor's variance
VOUCHED_FOR: Final = 0.4  # the same where repeats tell how much of it chance makes: of 17 false ones one had 0.2
SEEN: Final = 1.2  # the same of a fitted run that it makes half as loud again, unseen ones following in what they have
LITTLE: Final = 1.4  # floors, of which a coordinate must foretell a part to be more than friction that scatters
QUIET: Final = 1.1  # RMS over floor: a floor from a dozen repeats is not known better
REAL: Final = 0.6  # of its own sum of squares an effect must take away on unseen runs; 1 when it is what it says
UNREAL: Final = 1.4  # the same from above: unseen runs want it a fifth larger than the seen ones did, so it is not that
UNSTEADY: Final = 1 / 3  # relative, how much an effect's size may differ from run to run; true ones 0.3, mimics more
APART: Final = 0.5  # the same within one channel, where there is less of it to tell by
FAIR: Final = 0.04  # of an effect's work, in a channel: a fifth of its size; with less it is not asked how steady it is
FAINT: Final = 0.05  # of the floor, RMS: what a run has less of is its columns' own sensor noise, and wants no size
LESS: Final = 0.97  # RMS over the baseline's where names act, that must be left where the baseline is at the floor
ALL: Final = 0.95  # of the excess: with so much explained, sizes may be LOOSELY times as unsteady
LOOSELY: Final = 2.0  # because little is left of the run to tell a size by
# one-way analysis of variance of the sizes that runs want, where the baseline alone is at the floor
FREE: Final = 8  # degrees of freedom that repeats must have between them: from fewer no variance is known
BY_CHANCE: Final = 0.01  # probability above which conditions differ by no more than repeats do
OF_ONE_SIZE: Final = 2.5  # standard deviations between what unseen runs want and what seen ones do
PLAIN_AMONG_REPEATS: Final = 50.0  # squared size over variance between repeats: 7 σ of what they differ by
SHADOW: Final = 10.0  # times its size: a law is seldom better than a tenth, and what it has wrong looks like another
FAIRLY: Final = 0.2  # relative: what is fair takes so nearly what it should, in all runs
PLAINLY: Final = 0.8  # of the excess, for what is plain to see: a law a little off leaves a sixth, mimics a third
ABOUT: Final = 0.25  # relative, the same: what it takes of its own sum of squares, and how it differs between runs
SEVERAL: Final = 3  # fitted runs, from which on one size in all of them says something
STRETCHES: Final = 8  # of each run, which stand for several where there are fewer: half a minute of a log of four
ASTRAY: Final = 0.05  # relative, of what columns lean on: a twentieth of an effect's size
NEARLY: Final = 0.85  # of the most evidence in the bank: shapes there are a step apart
LAWS: Final = 0.5  # of the most evidence of its effect in the bank: a law to be tried before another effect is
CLOSEST: Final = 3  # laws with nearly the most evidence, each refined before one is chosen
ALIKE: Final = 0.8  # of the evidence of the effect that stands: a look-alike that may be what it is
OUTDONE: Final = (
    2.0  # times its evidence another effect must have: of 64 right lone names in five exams none is outdone
)
# largest half-width of a 95 % interval, relative to its value: of the scale of an effect tried second, of the stiffness
KNOWN: Final = 1 / 3
UNKNOWN: Final = 10.0  # of itself: a warming of 12 000 ± 790 000 s explains nothing; true laws had 3 at most
TRIED: Final = 2  # candidates tried again, each by itself: each costs a selection
TURNS: Final = 4  # prefixes of what the search found, each selected from anew
HARMFUL: Final = 1.1  # RMS of a loud channel over that without the effect: what explains one sensor spoils no other
# of the best coordinate's share: a simpler one that does nearly as well is said instead: times and memories have many
# bins, and predict a part of whatever differs from run to run
PLAIN_ENOUGH: Final = 0.8
# of the evidence for another coordinate, and what speaks for the one that is said is less. Of 26 unknown cases of exams
# 88 to 91 one was said wrongly with less (half), and right ones have three quarters; in a campaign of seven runs in
# which an angle was all the way since a reversal, memory outdid the load that was in it
FAR_LESS: Final = 0.6
AS_WELL: Final = 1.02  # of what is left: a name without which no more is left is needed no more
AT_THE_FLOOR: Final = 1.0  # of what is left: there is no excess to remove
WORSE: Final = 1.25  # times: laws fitted again that leave so much more of unseen runs foretell them no more
MISSING: Final = 1.4  # RMS over floor in a single held-out run: its floor is known to a tenth, its rows are few
# the same at reversals, beside what was named: friction that builds up within three samples left three floors there
TURNED: Final = 3.5
# the same where nothing was found to explain any of it: the floor of one condition is that of one pair
ALONE: Final = 2.0
IN_ONE_RUN: Final = 2.5  # RMS over floor of a fitted run that is no noise any more, though unseen runs leave nothing
BURST: Final = 3.0  # RMS of half a second over the usual one of its run: clean campaigns have 2.5 at most
BURST_RUN: Final = 1.5  # RMS of that run over its usual half second: 1.23 at most
LOCKS_DIFFER: Final = 3.0  # times as much as runs that turn freely: on clean campaigns 0.8 to 1.4
CHANCE: Final = 0.998  # of single runs that are no more than noise: a campaign has thirty blocks
LENIENT: Final = 1.5  # how much more than that at most: from few repeats no spread is known
RUBS_ANEW: Final = 2.0  # the same of a run by its friction, another one in each: half a dozen pairs tell little of it
MOSTLY: Final = 0.9  # of the excess: with so much explained a remainder is said, and the effects stand
PART: Final = 0.25  # of a channel's excess: names that take no more are none beside all the rest
AMISS: Final = 2.8  # RMS over floor where an effect acts: with more left there it is not what it is called
CLOSE: Final = 0.95  # of what an effect explains alone another one must reach to be called a rival
STILL: Final = 1.02  # RMS over floor of a channel below which only what is certain is said
STILL_RUN: Final = 1.25  # the same of a single run
# times the noise of its sensors, RMS, as the quietest run has it: what turns or repeats of the load torque differ by is
# no noise any more. Over the white noise of its readings it is up to 1.3 of clean rigs, or 2.2 where friction and gains
# are restless too, and 3 and more of missing effects that begin anew
BEYOND: Final = 3.0
LINE: Final = 15.0  # power over its surroundings: chance gets there in one of three million lines
LINE_RUNS: Final = 0.5  # of the runs that must show the line
LINE_SPEEDS: Final = 1.5  # highest over lowest speed among them: else it may be an order
LINE_WIDE: Final = 2.0  # highest over lowest frequency of a line that wanders: an octave; wider is no line
LINE_FREE: Final = 2.0  # speeds of the runs that show it must lie so much further apart than its frequencies
LOUD_LINE: Final = 0.2  # of a channel's residual power: a fainter line makes no floor a tenth too high
STEP: Final = 7.0  # times the usual difference of neighbouring windows: above all drift and wander
STEP_AGAIN: Final = 4.0  # the same for steps of a size that is known by then
STEP_ALIKE: Final = 0.05  # rad of the motor: two repeats that jump so near each other jump because of the angle
OWN: Final = 0.7  # of the excess of the runs that jump, which their jumps must take to be lost counts; true ones 0.98
WANDERS: Final = 1.3  # RMS over what neighbouring turns differ by: above it repeats are off by more than noise
FORETOLD: Final = 0.4  # of that excess in unseen runs: what must be foretold to be said; on clean campaigns 0.03
ONE_SIDED: Final = 0.5  # of friction along a turn: what keeps its sign is its difference between the ways, not cogging
IN_PHASE: Final = 0.1  # rad between those two, beside their intervals: chance gets there in 6 of 100 orders
