// What has to be done before a run: connect, checks, sign-and-scale proof, torque zero. Each with what it found.

import { $, h, refill, say, show } from "../dom.js";

const step = (name) => document.querySelector(`[data-step="${name}"]`);

export function benches(names) {
  $("bench-name").replaceChildren(...names.map((bench) => h("option", { value: bench.name ?? bench }, bench.name ?? bench)));
}

export function steps(state) {
  const connected = state.state !== "disconnected";
  mark("connect", connected);
  $("bench-name").disabled = connected;
  if (connected && state.bench) choose($("bench-name"), state.bench.name);
  show(step("connect").querySelector('[data-act="connect"]'), !connected);
  show(step("connect").querySelector('[data-act="disconnect"]'), connected);
  const checks = state.checks ?? [];
  const wrong = checks.filter((check) => !check.ok);
  mark("check", checks.length > 0, wrong.length > 0);
  tell("check", checks.length ? (wrong.length ? `${wrong.length} of ${checks.length} not passed` : `${checks.length} passed`) : "not made");
  show($("checks"), wrong.length > 0);
  refill($("checks"), wrong, () => wrong.map((check) => h("li", {}, h("b", {}, check.name), ` ${check.text}`)));
  mark("prove", Boolean(state.proof));
  tell("prove", state.proof ?? "not made");
  mark("tare", Boolean(state.tare));
  tell("tare", state.tare ?? "not made");
}

function choose(select, name) {
  if ([...select.options].some((option) => option.value === name)) select.value = name;
}

function mark(name, done, wrong = false) {
  step(name).dataset.done = wrong ? "wrong" : String(done);
}

function tell(name, text) {
  const said = step(name).querySelector(".said");
  say(said, text);
  said.title = text;
}
