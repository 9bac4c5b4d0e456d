// What has to be done before a run: connect, checks, sign-and-scale proof, torque zero. Each with what it found.

import { $, h, refill, say, show } from "../dom.js";

const step = (name) => document.querySelector(`[data-step="${name}"]`);

export function benches(names) {
  $("bench-name").replaceChildren(...names.map((name) => h("option", { value: name, title: name }, stem(name))));
}

/** A bench file by its name, without the way to it. */
const stem = (name) => name.split("/").pop().replace(/\.toml$/, "");

export function steps(state) {
  const connected = state.state !== "disconnected";
  mark("connect", connected);
  $("bench-name").disabled = connected;
  if (connected && state.bench) choose($("bench-name"), state.bench.source);
  show(step("connect").querySelector('[data-act="connect"]'), !connected);
  show(step("connect").querySelector('[data-act="disconnect"]'), connected);
  const checks = state.checks ?? [];
  const wrong = checks.filter((check) => !check.ok);
  mark("check", checks.length > 0, wrong.length > 0);
  const listed = [...wrong, ...checks.filter((check) => check.health === "doubtful")];
  tell("check", count(checks.length, wrong.length, listed.length - wrong.length));
  show($("checks"), listed.length > 0);
  refill($("checks"), listed, () => listed.map((check) => h("li", {}, h("b", {}, check.name), ` ${check.text}`)));
  mark("prove", Boolean(state.proof));
  tell("prove", state.proof ?? "not made");
  mark("tare", Boolean(state.tare));
  tell("tare", state.tare ?? (state.proof ? "not made" : "not made; the proof comes first"));
}

/** How many passed, with what a person should know before starting all the same. */
function count(all, wrong, doubtful) {
  if (!all) return "not made";
  if (wrong) return `${wrong} of ${all} not passed`;
  return doubtful ? `${all} passed, ${doubtful} doubtful` : `${all} passed`;
}

function choose(select, source) {
  const found = [...select.options].find((option) => option.value === source || stem(option.value) === stem(source));
  if (found) select.value = found.value;
}

function mark(name, done, wrong = false) {
  step(name).dataset.done = wrong ? "wrong" : String(done);
}

function tell(name, text) {
  const said = step(name).querySelector(".said");
  say(said, text);
  said.title = text;
}
