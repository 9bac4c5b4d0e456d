// The picture of the rig: kinematic error over one turn of the wave generator, the last revolutions over the running mean.

import uPlot from "../../vendor/uplot/uPlot.esm.js";
import { axis, fitted, ink, steady } from "./ink.js";
import { BINS } from "./turns.js";

const ANGLES = Array.from({ length: BINS }, (_, k) => ((k + 0.5) * 360) / BINS);
const RECENT = 3;
const LINES = [
  { label: "mean, forward", colour: "forward" },
  { label: "mean, reverse", colour: "reverse", dash: [7, 4] },
  { label: "last turns", colour: "forward-soft" },
  { label: "this turn", colour: "fit" },
];

export class Wave {
  lines = LINES;
  latest = [];
  marker = null;

  constructor(box) {
    this.chart = fitted(box, (size) => new uPlot(this.#options(size), this.#none(), box));
  }

  restyle() {
    this.chart.build();
  }

  draw(turns) {
    const level = turns.level;
    const { forward, reverse } = turns.ways;
    const about = (curve) => curve.map((value) => (value === null ? null : value - level));
    this.latest = turns.latest;
    this.marker = turns.marker && { angle: turns.marker.angle, error: turns.marker.error - level };
    const recent = Array.from({ length: RECENT }, (_, k) => (turns.latest[k] ? about(turns.latest[k].curve) : ANGLES.map(() => null)));
    this.chart.plot.setData([
      ANGLES, forward.edge(forward.high, level), forward.edge(forward.low, level), reverse.edge(reverse.high, level), reverse.edge(reverse.low, level),
      ...recent.reverse(), forward.curve(level), reverse.curve(level), about(turns.present),
    ]);
  }

  #none() {
    return [ANGLES, ...Array.from({ length: 10 }, () => ANGLES.map(() => null))];
  }

  #options(size) {
    const c = ink();
    const bare = { width: 0, points: { show: false } };
    const line = (stroke, width, dash) => ({ stroke, width, dash, points: { show: false } });
    const way = (k) => () => (this.latest[RECENT - 1 - k]?.way === "reverse" ? c.reverseSoft : c.forwardSoft);
    return {
      ...size,
      scales: { x: { time: false, range: [0, 360] }, y: { range: steady(20) } },
      series: [{}, bare, bare, bare, bare, ...[0, 1, 2].map((k) => line(way(k), 1)), line(c.forward, 2.4), line(c.reverse, 2.4, [7, 4]), line(c.fit, 1.5)],
      bands: [{ series: [1, 2], fill: `${c.forwardSoft}55` }, { series: [3, 4], fill: `${c.reverseSoft}55` }],
      axes: [axis("wave-generator angle, deg", { size: 36, incrs: [15, 30, 45, 90], space: 50 }), axis("θ̃ about its mean, arcsec at the output", { size: 50 })],
      legend: { show: false }, cursor: { show: false }, padding: [10, 14, 0, 0],
      hooks: { draw: [(plot) => this.#mark(plot)] },
    };
  }

  /** Where the wave generator stands now. */
  #mark(plot) {
    if (!this.marker || !Number.isFinite(this.marker.error)) return;
    const [x, y] = [plot.valToPos(this.marker.angle, "x", true), plot.valToPos(this.marker.error, "y", true)];
    const c = plot.ctx;
    c.save();
    c.fillStyle = ink().fit;
    c.beginPath();
    c.arc(x, y, 4.5 * devicePixelRatio, 0, 2 * Math.PI);
    c.fill();
    c.restore();
  }
}
