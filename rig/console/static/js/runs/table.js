// The list itself. A click on a column's head sorts by it.

import { h } from "../dom.js";
import { lasting } from "../numbers.js";
import { opened } from "../token.js";

const COLUMNS = [
  ["Started, UTC", (row) => (row.started_utc ?? "").slice(0, 16).replace("T", " ")],
  ["Procedure", (row) => (row.procedure ?? "").replace(/_/g, "-")],
  ["Gear", (row) => row.gear ?? ""],
  ["Status", (row) => row.status ?? ""],
  ["Verdict", (row) => (row.verdict === "MEASURED" ? "no-limit" : row.verdict ?? "")],
  ["Duration", (row) => row.duration_s ?? -1, (row) => lasting(row.duration_s)],
  ["Origin", (row) => row.origin ?? row.backend ?? ""],
];
const MOST = 500; // rows shown; the filters narrow the rest
let order = { column: 0, down: true };

export function table(rows, chosen, changed) {
  const box = h("div", { className: "scrolling" });
  const fill = () => box.replaceChildren(built(rows, chosen, changed, (column) => {
    order = { column, down: order.column === column ? !order.down : false };
    fill();
  }));
  fill();
  return box;
}

function built(rows, chosen, changed, sort) {
  const value = COLUMNS[order.column][1];
  const sorted = [...rows].sort((a, b) => compare(value(a), value(b)) * (order.down ? -1 : 1));
  const heads = COLUMNS.map(([name], k) => {
    const button = h("button", { type: "button" }, name + (order.column === k ? (order.down ? " ▾" : " ▴") : ""));
    button.addEventListener("click", () => sort(k));
    return h("th", { scope: "col", ariaSort: order.column === k ? (order.down ? "descending" : "ascending") : "none" }, button);
  });
  const more = rows.length > MOST ? [h("p", { className: "hint" }, `the first ${MOST} of ${rows.length}: narrow the list by the fields above`)] : [];
  return h("div", {}, h("table", {}, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, h("span", { className: "vh" }, "compare")), ...heads, h("th", { scope: "col" }, "Page"))), h("tbody", {}, ...sorted.slice(0, MOST).map((row) => line(row, chosen, changed)))), ...more);
}

const compare = (a, b) => (typeof a === "number" ? a - b : a.localeCompare(b));

function line(row, chosen, changed) {
  const box = h("input", { type: "checkbox", checked: chosen.has(row.path), ariaLabel: `compare ${row.path}` });
  box.addEventListener("change", () => {
    if (box.checked) chosen.set(row.path, row);
    else chosen.delete(row.path);
    changed();
  });
  const cells = COLUMNS.map(([, sorted, shown]) => h("td", {}, String((shown ?? sorted)(row))));
  const report = row.report ? h("a", { href: opened(row.report), target: "_blank", rel: "noopener" }, "report") : "";
  const item = h("tr", { title: [row.path, row.reason, row.problem].filter(Boolean).join("\n") }, h("td", { className: "tick" }, h("label", {}, box)), ...cells, h("td", {}, report));
  item.dataset.status = row.status ?? "";
  return item;
}
