// The second view: runs as a list with filters, chosen ones side by side, one figure over days and assemblies.

import { $, h, say, show } from "../dom.js";
import { get } from "../token.js";
import { compared } from "./compare.js";
import { table } from "./table.js";
import { Trend } from "./trend.js";

const FIGURES = ["peak-to-peak", "C_2", "K1", "hysteresis-loss", "friction"];
const STATUSES = ["", "completed", "stopped", "tripped", "interrupted", "running", "unreadable"];
const VERDICTS = ["", "PASS", "FAIL", "INCONCLUSIVE", "no-limit", "none"];
const PAUSE = 200; // ms without a key before the list is asked for again

const chosen = new Map(); // runs to compare, by path
let built = null;

export function openRuns() {
  built ??= build();
  built.list();
}

function build() {
  const root = $("view-runs");
  const filters = h("form", { className: "filters", autocomplete: "off" }, ...fields());
  const message = h("p", { className: "message", role: "status" });
  const body = h("div", { className: "listing" });
  const panel = h("section", { className: "beside", ariaLabel: "Comparison and trend" });
  const compare = h("button", { type: "button" }, "Compare");
  const trend = trendForm();
  root.replaceChildren(h("div", { className: "left" }, filters, message, body, h("div", { className: "below" }, compare, trend)), panel);
  const parts = { filters, message, body, panel, compare, trend };
  wire(parts);
  panel.replaceChildren(h("p", { className: "hint" }, "Choose two runs or more and compare them, or draw one figure over time."));
  return { list: () => list(parts) };
}

function fields() {
  const text = (name, label, hint) => h("label", {}, label, h("input", { name, placeholder: hint, maxLength: 200 }));
  const pick = (name, label, values) => h("label", {}, label, h("select", { name }, ...values.map((value) => h("option", { value }, value || "any"))));
  return [
    text("gear", "Gear", "serial, * and ? allowed"), text("procedure", "Procedure", "kinematic-error"),
    pick("status", "Status", STATUSES), pick("verdict", "Verdict", VERDICTS),
    text("since", "Since", "2026-11-20"), text("until", "Until", "2026-11-20"),
  ];
}

function trendForm() {
  const figure = h("select", { name: "figure" }, ...FIGURES.map((name) => h("option", { value: name }, name)));
  return h("form", { className: "trend" }, h("label", {}, "Figure", figure), h("button", {}, "Trend"));
}

function wire(parts) {
  let timer = 0;
  parts.filters.addEventListener("input", () => {
    clearTimeout(timer);
    timer = setTimeout(() => list(parts), PAUSE);
  });
  parts.filters.addEventListener("submit", (event) => event.preventDefault());
  parts.compare.addEventListener("click", () => compare(parts));
  parts.trend.addEventListener("submit", (event) => {
    event.preventDefault();
    trend(parts);
  });
  count(parts);
}

function query(form) {
  const asked = new URLSearchParams();
  for (const [name, value] of new FormData(form)) if (value.trim()) asked.set(name, value.trim());
  return asked;
}

async function list(parts) {
  await telling(parts.message, async () => {
    const said = await get(`/api/runs?${query(parts.filters)}`);
    const rows = said.runs ?? said;
    say(parts.message, rows.length === 1 ? "1 run" : `${rows.length} runs`);
    parts.body.replaceChildren(table(rows, chosen, () => count(parts)));
  });
}

function count({ compare }) {
  compare.setAttribute("aria-disabled", String(chosen.size < 2));
  say(compare, chosen.size ? `Compare ${chosen.size} ${chosen.size === 1 ? "run" : "runs"}` : "Compare");
  compare.title = chosen.size < 2 ? "choose two runs or more" : "";
}

async function compare(parts) {
  if (chosen.size < 2) return say(parts.message, "Comparing needs two runs or more: choose them in the list.");
  const asked = new URLSearchParams([...chosen.keys()].map((path) => ["run", path]));
  await telling(parts.message, async () => parts.panel.replaceChildren(compared(await get(`/api/compare?${asked}`))));
}

async function trend(parts) {
  const asked = query(parts.trend);
  const gear = query(parts.filters).get("gear");
  if (gear) asked.set("gear", gear);
  await telling(parts.message, async () => {
    const said = await get(`/api/trends?${asked}`);
    parts.panel.replaceChildren();
    for (const series of said.series) new Trend(parts.panel, series);
    if (said.left_out) parts.panel.append(h("p", { className: "hint" }, `${said.left_out} more with this figure left out: not completed, or rejected`));
  });
}

/** Do it, and say it in words where it does not work. */
async function telling(message, work) {
  show(message, true);
  message.dataset.ok = "true";
  try {
    await work();
  } catch (error) {
    message.dataset.ok = "false";
    say(message, error.message);
  }
}
