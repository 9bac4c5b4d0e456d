// Runs side by side: each figure with its interval, its difference to the first run, and whether that is a change.

import { h } from "../dom.js";
import { plain } from "../numbers.js";

const MARKS = { changed: "CHANGED", within: "within reproducibility", unknown: "no repeats to judge by" };

export function compared(said) {
  const heads = said.runs.map((run, k) => h("th", { scope: "col", title: run.path }, `${k + 1}: ${(run.started_utc ?? "").slice(0, 16).replace("T", " ")} ${run.gear ?? ""}`));
  const remarks = said.remarks.map((remark) => h("li", {}, remark));
  return h("div", { className: "comparison" }, h("h2", {}, "Side by side, the first run being the reference"),
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
  const parts = [h("b", {}, `${plain(value.value)}${shown}`), interval(value.ci95, shown)];
  if (value.rejected) parts.push(h("em", {}, " rejected"));
  if (!difference) return parts;
  const mark = h("span", { className: "change", title: difference.how ?? "" }, `${difference.value > 0 ? "+" : ""}${plain(difference.value)}${shown} ${MARKS[difference.mark] ?? ""}`);
  mark.dataset.mark = difference.mark ?? "";
  return [...parts, mark];
}

function interval(ends, unit) {
  if (!ends || ends[0] === null || ends[0] === ends[1]) return h("small", {}, "");
  return h("small", {}, ` 95 %: ${plain(ends[0])} to ${plain(ends[1])}${unit}`);
}
