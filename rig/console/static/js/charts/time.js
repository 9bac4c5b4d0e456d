// A strip of the last seconds: a few columns over the time in the run, peaks kept.

import uPlot from "../../vendor/uplot/uPlot.esm.js";
import { axis, fitted, ink, steady } from "./ink.js";
import { plain } from "../numbers.js";
import { firstFrom } from "../rows.js";

export const WINDOW = 20; // s shown

/** lines: [{column, label, colour (a name of ink), scale, width}]; axes: [{scale, label, least, side}]. */
export class Strip {
  constructor(figure, lines, axes, legend) {
    this.lines = lines;
    this.axes = axes;
    this.chart = fitted(figure.querySelector(".plot"), (size, box) => new uPlot(this.#options(size), this.#none(), box));
    legend(figure.querySelector(".legend"), lines);
  }

  restyle() {
    this.chart.build();
  }

  draw(history) {
    if (!history.length) return this.chart.plot.setData(this.#none());
    const end = Math.max(history.newest, history.t[0] + WINDOW);
    const from = firstFrom(history.t, history.length, end - WINDOW);
    const t = history.t.subarray(from, history.length);
    const rows = this.lines.map((line) => history.of.get(line.column)?.subarray(from, history.length));
    const [x, ys] = thinned(t, rows, Math.max(2 * this.chart.plot.width, 200));
    this.chart.plot.setData([x, ...ys], false);
    this.chart.plot.setScale("x", { min: end - WINDOW, max: end });
  }

  #none() {
    return [[], ...this.lines.map(() => [])];
  }

  #options(size) {
    const colours = ink();
    const scales = { x: { time: false, auto: false } };
    for (const { scale, least } of this.axes) scales[scale] = { range: steady(least) };
    const y = this.axes.map(({ scale, label, side }) => axis(label, { scale, side: side ?? 3, size: 46, grid: side === 1 ? { show: false } : undefined, space: 18 }));
    const series = this.lines.map(({ label, colour, scale, width, dash }) => ({ label, scale, stroke: colours[colour], width: width ?? 1.4, dash, points: { show: false }, spanGaps: true }));
    return {
      ...size, scales, series: [{}, ...series], axes: [axis("", { size: 22, space: 70, values: (plot, ticks) => ticks.map((t) => `${plain(t)} s`) }), ...y],
      legend: { show: false }, cursor: { show: false }, padding: [8, 10, 0, 0],
    };
  }
}

/** The smallest and the largest of every stretch, in time order, so that no peak is shown low. */
function thinned(t, rows, most) {
  if (t.length <= most) return [Array.from(t), rows.map((row) => (row ? Array.from(row, finite) : Array(t.length).fill(null)))];
  const every = Math.ceil((2 * t.length) / most);
  const x = [];
  for (let k = 0; k < t.length; k += every) x.push(t[k], t[Math.min(k + every - 1, t.length - 1)]);
  return [x, rows.map((row) => (row ? extremes(row, every) : Array(x.length).fill(null)))];
}

function extremes(row, every) {
  const out = [];
  for (let k = 0; k < row.length; k += every) {
    let [low, high] = [k, k];
    for (let i = k + 1; i < Math.min(k + every, row.length); i++) {
      if (row[i] < row[low]) low = i;
      if (row[i] > row[high]) high = i;
    }
    out.push(finite(row[Math.min(low, high)]), finite(row[Math.max(low, high)]));
  }
  return out;
}

const finite = (value) => (Number.isFinite(value) ? value : null);
