// Colours, type and axes of the charts, from the style sheet, so that the three looks need no second table.

import { plain } from "../numbers.js";

export function ink() {
  const style = getComputedStyle(document.body);
  const of = (name) => style.getPropertyValue(`--${name}`).trim();
  return {
    text: of("muted"), grid: of("grid"), axis: of("axis"), ink: of("ink"), fit: of("fit"), level: of("level"),
    forward: of("forward"), reverse: of("reverse"), forwardSoft: of("forward-soft"), reverseSoft: of("reverse-soft"),
    bar: of("bar"), bad: of("bad"), font: `12px ${style.fontFamily}`,
  };
}

/** An axis with its unit written along it. */
export function axis(label, more = {}) {
  const { text, grid, font } = ink();
  return {
    label, stroke: text, font, labelFont: font, labelSize: label ? 16 : 0, labelGap: 0, gap: 3, values: (plot, ticks) => ticks.map(plain),
    grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1, size: 4 }, ...more,
  };
}

/** A range that holds the data with some room, ends on round numbers and does not shake with every sample. */
export function steady(least) {
  let kept = null;
  return (plot, low, high) => {
    if (low === null || !Number.isFinite(low)) return [-least, least];
    const room = Math.max((high - low) * 0.08, least * 0.05);
    const fits = kept && low >= kept[0] && high <= kept[1] && high - low > 0.35 * (kept[1] - kept[0]);
    if (!fits) kept = round(low - room, high + room, least);
    return kept;
  };
}

function round(low, high, least) {
  const middle = (low + high) / 2;
  const span = Math.max(high - low, least);
  const step = 10 ** Math.floor(Math.log10(span)) / (span / 10 ** Math.floor(Math.log10(span)) < 4 ? 5 : 2);
  return [Math.floor((middle - span / 2) / step) * step, Math.ceil((middle + span / 2) / step) * step];
}

/** A plot as large as `box`, drawn again when the box changes. */
export function fitted(box, make) {
  const chart = { plot: null };
  const size = () => ({ width: Math.max(box.clientWidth, 60), height: Math.max(box.clientHeight, 60) });
  chart.build = () => {
    chart.plot?.destroy();
    chart.plot = make(size(), box);
  };
  chart.build();
  new ResizeObserver(() => box.clientWidth && chart.plot.setSize(size())).observe(box);
  return chart;
}
