// Binary frames of samples, as rig/console sends them.

const MAGIC = 0x48445247;
const HEADER = 16; // bytes

/** {t: Float64Array, columns: Float32Array[], skipped}; null for a frame of another kind or version. */
export function decode(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER || view.getUint32(0, true) !== MAGIC || view.getUint16(4, true) !== 1) return null;
  const [width, n] = [view.getUint16(6, true), view.getUint32(8, true)];
  if (buffer.byteLength !== HEADER + 8 * n + 4 * n * width) return null;
  const columns = Array.from({ length: width }, (_, k) => new Float32Array(buffer, HEADER + 8 * n + 4 * n * k, n));
  return { t: new Float64Array(buffer, HEADER, n), columns, skipped: view.getUint32(12, true) };
}

/** The last rows, by column name; old ones fall out. */
export class History {
  constructor(capacity) {
    this.capacity = capacity;
    this.clear();
  }

  clear() {
    this.length = 0;
    this.t = new Float64Array(2 * this.capacity);
    this.of = new Map();
  }

  /** The newest time; -Infinity before the first row. */
  get newest() {
    return this.length ? this.t[this.length - 1] : -Infinity;
  }

  /** `columns`: values by name. */
  add(columns, t) {
    if (this.length + t.length > this.t.length) this.#shift();
    this.t.set(t, this.length);
    for (const [name, values] of columns) this.#column(name).set(values, this.length);
    this.length += t.length;
  }

  #column(name) {
    if (!this.of.has(name)) this.of.set(name, new Float32Array(2 * this.capacity).fill(NaN));
    return this.of.get(name);
  }

  #shift() {
    const from = this.length - Math.min(this.capacity, this.length);
    for (const column of [this.t, ...this.of.values()]) column.copyWithin(0, from, this.length);
    this.length -= from;
  }
}

/** The first index whose time is not before `t`. */
export function firstFrom(times, length, t) {
  let [low, high] = [0, length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}
