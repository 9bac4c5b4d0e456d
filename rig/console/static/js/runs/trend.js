// One figure over time: each run with its interval, the band an unchanged gear stays in, a mark where it left it.

import uPlot from "../../vendor/uplot/uPlot.esm.js";
import { axis, fitted, ink } from "../charts/ink.js";
import { h } from "../dom.js";

export class Trend {
  constructor(panel, series) {
    this.points = series.points.filter((point) => point.value !== null && point.started_utc);
    this.unit = series.unit;
    const box = h("div", { className: "plot" });
    panel.append(h("figure", { className: "trending" }, h("figcaption", {}, h("b", {}, `${series.label}: ${series.title}`), series.simulated ? h("span", { className: "simulated" }, "SIMULATED") : ""), box, h("p", { className: "hint" }, series.sentence)));
    this.chart = fitted(box, (size) => new uPlot(this.#options(size, series.label), this.#data(), box));
  }

  #data() {
    const at = (value) => this.points.map(value);
    const band = (sign) => at((p) => (p.level === null || p.reproducibility === null ? null : p.level + sign * p.reproducibility));
    return [at((_, k) => k + 1), band(1), band(-1), at((p) => p.value)];
  }

  #options(size, label) {
    const c = ink();
    const named = (plot, ticks) => ticks.map((k) => (this.points[k - 1] ? this.points[k - 1].started_utc.slice(5, 16).replace("T", " ") : ""));
    const unit = this.unit === "1" ? "" : `, ${this.unit}`;
    return {
      ...size,
      scales: { x: { time: false, range: [0.5, this.points.length + 0.5] }, y: { range: (plot) => this.#range() } },
      series: [{}, { width: 0, points: { show: false } }, { width: 0, points: { show: false } }, { stroke: c.forward, width: 1.2, points: { show: true, size: 8, fill: c.forward } }],
      bands: [{ series: [1, 2], fill: c.grid }],
      axes: [axis("run, by its start (UTC)", { size: 38, incrs: [1, 2, 5, 10, 20, 50, 100], space: 90, values: named }), axis(`${label}${unit}`, { size: 60 })],
      legend: { show: false }, cursor: { show: false }, padding: [10, 14, 0, 0],
      hooks: { draw: [(plot) => this.#whiskers(plot, c)] },
    };
  }

  /** Of values and intervals; the band, which two repeats leave very wide, takes no more room than they do. */
  #range() {
    const measured = this.points.flatMap((p) => [p.value, ...p.ci95.filter((end) => end !== null)]);
    const band = this.points.filter((p) => p.level !== null && p.reproducibility !== null);
    const [least, most] = [Math.min(...measured), Math.max(...measured)];
    const span = most - least;
    const low = Math.max(Math.min(least, ...band.map((p) => p.level - p.reproducibility)), least - span);
    const high = Math.min(Math.max(most, ...band.map((p) => p.level + p.reproducibility)), most + span);
    const room = Math.max((high - low) * 0.12, Math.abs(high) * 1e-3, 1e-9);
    return [low - room, high + room];
  }

  /** The 95 % intervals, and a square where the gear changed. */
  #whiskers(plot, c) {
    const draw = plot.ctx;
    draw.save();
    this.points.forEach((point, k) => {
      const x = plot.valToPos(k + 1, "x", true);
      draw.strokeStyle = point.changed ? c.bad : c.forward;
      draw.lineWidth = 2 * devicePixelRatio;
      const [low, high] = point.ci95;
      if (low !== null && high !== null) draw.strokeRect(x, plot.valToPos(high, "y", true), 0, plot.valToPos(low, "y", true) - plot.valToPos(high, "y", true));
      const reach = 9 * devicePixelRatio;
      if (point.changed) draw.strokeRect(x - reach, plot.valToPos(point.value, "y", true) - reach, 2 * reach, 2 * reach);
    });
    draw.restore();
  }
}
