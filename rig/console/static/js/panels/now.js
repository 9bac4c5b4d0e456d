// The state in one word, what is wrong in one sentence, and what to do next.

import { $, say, show } from "../dom.js";

export function now(state) {
  const root = document.documentElement;
  root.dataset.state = state.state;
  say($("state"), state.state);
  $("now").dataset.kind = state.state === "fault" || state.fault ? "fault" : state.prompt ? "asked" : state.controller === "other" ? "other" : "calm";
  show($("fault"), Boolean(state.fault));
  say($("fault"), state.fault ?? "");
  const other = state.controller === "other" ? "Another page has control: this one only looks. Stop and halt work here too. " : "";
  say($("advice"), other + (state.advice ?? ""));
  show($("take-control"), state.controller === "other");
  const title = state.prompt ? "YOUR TURN" : state.fault ? "FAULT" : state.state;
  const done = state.run ? ` ${Math.round((100 * state.run.t) / state.run.duration)} %` : "";
  document.title = `${title}${done} · hdrig${state.bench ? ` ${state.bench.name}` : ""}${state.bench?.simulated ? " SIMULATED" : ""}`;
}
