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
