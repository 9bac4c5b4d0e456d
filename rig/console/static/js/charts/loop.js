// Shaft torque against wind-up while the output is locked: a true x-y line, drawn in the order it was measured.

import uPlot from "../../vendor/uplot/uPlot.esm.js";
import { axis, fitted, ink, steady } from "./ink.js";

const MOST = 6000; // points kept; every second one is dropped beyond
const STEP = 0.002; // of the range seen so far: nearer points add nothing

export class Loop {
  lines = [{ label: "since the run began, or this page; the last tenth dark", colour: "forward" }];

  constructor(box) {
    this.clear();
    this.chart = fitted(box, (size) => new uPlot(this.#options(size), [null, [[], []]], box));
  }

  clear() {
    this.twist = [];
    this.torque = [];
    this.span = [1e-3, 1e-2]; // arcmin, N·m
  }

  restyle() {
    this.chart.build();
  }

  /** Wind-up [arcmin at the output], torque at the sensor [N·m]. */
  add(twist, torque) {
    if (!Number.isFinite(twist) || !Number.isFinite(torque)) return;
    const last = this.twist.length - 1;
    const moved = last < 0 || Math.abs(twist - this.twist[last]) > STEP * this.span[0] || Math.abs(torque - this.torque[last]) > STEP * this.span[1];
    if (!moved) return;
    this.twist.push(twist);
    this.torque.push(torque);
    this.span = [Math.max(this.span[0], Math.abs(twist - this.twist[0])), Math.max(this.span[1], Math.abs(torque))];
    if (this.twist.length > MOST) {
      this.twist = this.twist.filter((_, k) => k % 2 === 0);
      this.torque = this.torque.filter((_, k) => k % 2 === 0);
    }
  }

  draw() {
    this.chart.plot.setData([null, [this.twist, this.torque]]);
  }

  #options(size) {
    return {
      ...size, mode: 2,
      scales: { x: { time: false, auto: true, range: steady(0.5) }, y: { auto: true, range: steady(2) } },
      series: [{}, { facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }], paths: (plot) => this.#line(plot) }],
      axes: [axis("wind-up at the output, arcmin", { size: 36 }), axis("shaft torque, N·m", { size: 50 })],
      legend: { show: false }, cursor: { show: false }, padding: [10, 14, 0, 0],
    };
  }

  #line(plot) {
    const old = Math.floor(this.twist.length * 0.9);
    stroke(plot, this.twist, this.torque, 0, old + 1, ink().forwardSoft, 1.2);
    stroke(plot, this.twist, this.torque, old, this.twist.length, ink().forward, 2.2);
    return null;
  }
}

function stroke(plot, xs, ys, from, to, colour, width) {
  const c = plot.ctx;
  c.save();
  c.beginPath();
  for (let k = from; k < Math.min(to, xs.length); k++) c.lineTo(plot.valToPos(xs[k], "x", true), plot.valToPos(ys[k], "y", true));
  c.strokeStyle = colour;
  c.lineWidth = width * devicePixelRatio;
  c.stroke();
  c.restore();
}
