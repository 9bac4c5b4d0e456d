// Kinematic error sorted by wave-generator angle: one curve per revolution and the running mean of all, each way apart.

export const BINS = 360; // of one motor turn: one degree, 17 ms at 9.6 rpm
const BACK = 2; // deg the motor has to come back before that counts as the other direction
const CATCH = 60; // deg after turning round: the gear winds up the other way and rings for a second; kept out of the mean
const LEAVE = 20; // deg before turning round, or stopping: kept out as well, so a row counts when the motor is past it
const JUMP = 30; // deg between two rows that are still joined by a straight line: 600 rpm makes 7 deg
const KEPT = 3; // revolutions shown beside the mean
const BIN = 360 / BINS;
const BEHIND = 0.1; // deg behind the farthest so far: it stands, or turns round, and the gear winds up the other way

const empty = () => new Array(BINS).fill(null);

export class Turns {
  constructor() {
    this.clear();
  }

  clear() {
    this.ways = { forward: new Mean(), reverse: new Mean() };
    this.latest = []; // the last whole revolutions, newest first: {way, curve}
    this.present = empty();
    this.filled = 0;
    this.way = null;
    this.extreme = NaN;
    this.turn = NaN;
    this.turned = NaN; // where it turned round last [deg]
    this.before = null; // the row before
    this.pending = []; // rows the motor is not yet LEAVE past: {angle, bin, error}
    this.marker = null; // {angle, error}: where the wave generator is now
  }

  /** One row: motor angle [deg, unwrapped], error [arcsec]. */
  add(angle, error) {
    if (!Number.isFinite(angle) || !Number.isFinite(error)) return;
    this.#follow(angle);
    if (this.way === null || Math.abs(angle - this.extreme) > BEHIND) return;
    if (this.before && Math.abs(angle - this.before.angle) < BIN / 4) return; // one that stands does not weigh more
    this.marker = { angle: angle - 360 * Math.floor(angle / 360), error }; // standing, the gear unwinds: no error of it
    this.#join(angle, error);
    this.before = { angle, error };
  }

  /** No row follows: where the motor came to rest the gear unwound, and that is no error of a turn. */
  over() {
    for (const { bin } of this.pending) this.present[bin] = null;
    this.marker = null;
  }

  /** Every bin from the row before to this one, in the direction of turning. */
  #join(angle, error) {
    const from = this.before ?? { angle, error };
    const gone = angle - from.angle;
    const steps = Math.abs(gone) > JUMP ? 0 : Math.floor(Math.abs(gone) / BIN);
    for (let k = 1; k <= steps; k++) this.#put(from.angle + (gone * k) / (steps + 1), from.error + ((error - from.error) * k) / (steps + 1));
    this.#put(angle, error);
  }

  #put(angle, error) {
    const turn = Math.floor(angle / 360);
    if (turn !== this.turn) this.#finish(turn);
    const bin = Math.min(Math.floor((angle - 360 * turn) / BIN), BINS - 1);
    if (this.present[bin] === null) this.filled += 1;
    this.present[bin] = error;
    if (Math.abs(angle - this.turned) > CATCH) this.pending.push({ angle, bin, error });
    while (this.pending.length && Math.abs(angle - this.pending[0].angle) > LEAVE) {
      const past = this.pending.shift();
      this.ways[this.way].add(past.bin, past.error);
    }
  }

  /** The level all curves are drawn about: the mean of what was measured, both ways. */
  get level() {
    const { forward, reverse } = this.ways;
    const n = forward.n + reverse.n;
    return n ? (forward.sum + reverse.sum) / n : 0;
  }

  /** Direction of turning; standstill and its noise change nothing. */
  #follow(angle) {
    if (Number.isNaN(this.extreme)) this.extreme = angle;
    const gone = angle - this.extreme;
    const forward = this.way !== "reverse";
    if (this.way !== null && (forward ? gone > 0 : gone < 0)) this.extreme = angle;
    else if (Math.abs(gone) > BACK) this.#turnRound(gone > 0 ? "forward" : "reverse", angle);
  }

  #turnRound(way, angle) {
    this.pending = [];
    this.before = null;
    this.#finish(Math.floor(angle / 360));
    this.way = way;
    this.turned = this.extreme;
    this.extreme = angle;
  }

  #finish(turn) {
    if (this.way !== null && this.filled > 0.9 * BINS) {
      this.latest.unshift({ way: this.way, curve: this.present });
      this.latest.length = Math.min(this.latest.length, KEPT);
      this.ways[this.way].revolutions += 1;
    }
    this.present = empty();
    this.filled = 0;
    this.turn = turn;
  }
}

/** Mean, smallest and largest per bin. */
class Mean {
  revolutions = 0;
  n = 0;
  sum = 0;
  sums = new Float64Array(BINS);
  counts = new Uint32Array(BINS);
  low = new Float64Array(BINS).fill(Infinity);
  high = new Float64Array(BINS).fill(-Infinity);

  add(bin, error) {
    this.n += 1;
    this.sum += error;
    this.sums[bin] += error;
    this.counts[bin] += 1;
    if (error < this.low[bin]) this.low[bin] = error;
    if (error > this.high[bin]) this.high[bin] = error;
  }

  /** Per bin, about `level`; null where nothing was measured yet. */
  curve(level) {
    return Array.from(this.sums, (sum, k) => (this.counts[k] ? sum / this.counts[k] - level : null));
  }

  edge(values, level) {
    return Array.from(values, (value, k) => (this.counts[k] ? value - level : null));
  }

  get whole() {
    return this.counts.every((count) => count > 0);
  }

  /** Amplitude of orders 1 to `most`: C_n of the mean over one whole turn [ghorbel2001, Eq. 8]; null before one. */
  orders(most) {
    if (!this.whole) return null;
    return Array.from({ length: most }, (_, k) => this.#amplitude(k + 1));
  }

  #amplitude(order) {
    let [a, b] = [0, 0];
    for (let k = 0; k < BINS; k++) {
      const phase = (2 * Math.PI * order * (k + 0.5)) / BINS;
      a += (this.sums[k] / this.counts[k]) * Math.cos(phase);
      b += (this.sums[k] / this.counts[k]) * Math.sin(phase);
    }
    return (2 / BINS) * Math.hypot(a, b);
  }
}
