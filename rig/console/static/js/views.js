// Two views, one page: the rig, and the runs. Halt, stop and hold stand beside both.

import { $, show } from "./dom.js";

export function views(openRuns) {
  const tabs = [...document.querySelectorAll("[data-view]")];
  const open = (view) => {
    for (const tab of tabs) tab.setAttribute("aria-selected", String(tab.dataset.view === view));
    show($("view-rig"), view === "rig");
    show($("view-runs"), view === "runs");
    document.documentElement.dataset.view = view;
    if (view === "runs") openRuns();
  };
  for (const tab of tabs) tab.addEventListener("click", () => open(tab.dataset.view));
  open("rig");
}

/** On a small screen the controls to prepare and to measure take turns. */
export function panels() {
  const buttons = [...document.querySelectorAll("button[data-panel]")];
  const open = (panel) => {
    $("side").dataset.panel = panel;
    for (const button of buttons) button.setAttribute("aria-pressed", String(button.dataset.panel === panel));
  };
  for (const button of buttons) button.addEventListener("click", () => open(button.dataset.panel));
}
