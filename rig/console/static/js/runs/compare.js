// Runs side by side: each figure with its interval, its difference to the first run, and whether that is a change.

import { h } from "../dom.js";
import { fixed, plain } from "../numbers.js";

const MARKS = { changed: "CHANGED", within: "within reproducibility", unknown: "no repeats to judge by" };

export function compared(said) {
  const heads = said.runs.map((run, k) => h("th", { scope: "col", title: run.path }, `${k + 1}: ${(run.started_utc ?? "").slice(0, 16).replace("T", " ")} ${run.gear ?? ""}`));
  const remarks = said.remarks.map((remark) => h("li", {}, remark));
  return h("div", { className: "comparison" }, h("h2", {}, "Side by side: ± is half of the 95 % interval; differences are to the first run"),
    remarks.length ? h("ul", { className: "remarks" }, ...remarks) : null,
    h("div", { className: "scrolling" }, h("table", {}, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Figure"), ...heads)), h("tbody", {}, ...said.figures.map(line)))));
}

function line(figure) {
  const cells = figure.values.map((value, k) => h("td", {}, ...cell(value, figure.differences[k], figure.unit)));
  return h("tr", {}, h("th", { scope: "row" }, figure.label || figure.name), ...cells);
}

function cell(value, difference, unit) {
  if (value === null) return ["—"];
  const shown = unit === "1" ? "" : `\u00a0${unit}`;
  const parts = [h("b", {}, measured(value.value, value.ci95) + shown)];
  if (value.rejected) parts.push(h("em", {}, "rejected"));
  if (!difference || !difference.mark) return parts;
  const mark = h("span", { className: "change", title: difference.how ?? "" }, `${signed(difference)}${shown}: ${MARKS[difference.mark]}`);
  mark.dataset.mark = difference.mark;
  return [...parts, mark];
}

/** Value and half of its 95 % interval, to two digits of the latter; both ends where they lie unevenly. */
function measured(value, ends) {
  const [low, high] = ends ?? [null, null];
  if (low === null || high === null || low === high) return plain(value);
  const half = (high - low) / 2;
  const digits = after(half);
  const even = Math.abs(high + low - 2 * value) < 0.2 * half;
  return even ? `${fixed(value, digits)} ± ${fixed(half, digits)}` : `${fixed(value, digits)} (${fixed(low, digits)} to ${fixed(high, digits)})`;
}

function signed({ value, ci95 }) {
  const digits = ci95 && ci95[0] !== null && ci95[1] > ci95[0] ? after((ci95[1] - ci95[0]) / 2) : 3;
  return (value > 0 ? "+" : "") + fixed(value, digits);
}

/** Digits after the point that show two of `half`. */
const after = (half) => Math.min(Math.max(1 - Math.floor(Math.log10(half)), 0), 9);
