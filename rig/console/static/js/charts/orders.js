// Orders of the kinematic error, from the running mean over one turn: bars.

import uPlot from "../../vendor/uplot/uPlot.esm.js";
import { axis, fitted, ink } from "./ink.js";

export const MOST = 15; // orders in the paper's fit
const ORDERS = Array.from({ length: MOST }, (_, k) => k + 1);

export class Orders {
  constructor(figure) {
    this.chart = fitted(figure.querySelector(".plot"), (size, box) => new uPlot(options(size), [ORDERS, ORDERS.map(() => null)], box));
  }

  restyle() {
    this.chart.build();
  }

  /** Amplitudes [arcsec] or null. */
  draw(amplitudes) {
    this.chart.plot.setData([ORDERS, amplitudes ?? ORDERS.map(() => null)]);
  }
}

function options(size) {
  return {
    ...size,
    scales: { x: { time: false, range: [0.4, MOST + 0.6] }, y: { range: (plot, low, high) => [0, (high ?? 10) * 1.12 || 10] } },
    series: [{}, { fill: ink().bar, stroke: ink().bar, width: 0, paths: uPlot.paths.bars({ size: [0.62, 40] }), points: { show: false } }],
    axes: [axis("", { size: 22, incrs: [1, 2, 5], space: 16 }), axis("arcsec", { size: 46, space: 18 })],
    legend: { show: false }, cursor: { show: false }, padding: [8, 10, 0, 0],
  };
}
