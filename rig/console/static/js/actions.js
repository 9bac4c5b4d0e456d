// What the operator does, sent to the server: every act has an id and the state it was based on.

import { headers, uuid } from "./token.js";

const URGENT = new Set(["halt", "stop", "hold"]);
const UNANSWERED = 1000; // ms after which an urgent act counts as not confirmed

/** {ok, text, ms}: the server's answer as a sentence. Never throws. `state`: what the page shows. */
export async function act(name, state, more = {}) {
  const began = performance.now();
  const body = { id: uuid(), based_on: state?.revision ?? 0, act: name, ...more };
  try {
    const answer = await fetch("/api/act", {
      method: "POST",
      headers,
      body: JSON.stringify(body),
      keepalive: URGENT.has(name),
      priority: URGENT.has(name) ? "high" : "auto",
      signal: URGENT.has(name) ? AbortSignal.timeout(UNANSWERED) : undefined,
    });
    const said = await answer.json().catch(() => ({}));
    if (URGENT.has(name) && state?.station === false) return { ok: false, text: unheard(name) };
    return told(name, answer.status, said, performance.now() - began);
  } catch (error) {
    return { ok: false, text: unheard(name, error) };
  }
}

function told(name, status, said, ms) {
  if (status === 200 && said.accepted !== false) return { ok: true, text: done(name, said, ms), ms };
  if (status === 401) return { ok: false, text: `${word(name)} refused: this page has no valid token. Open the address that hdrig serve printed.` };
  if (status === 403) return { ok: false, text: `${word(name)} refused: this page does not come from this server.` };
  return { ok: false, text: `${word(name)} refused: ${said.why ?? said.detail ?? `the server answered ${status}`}` };
}

function done(name, said, ms) {
  if (!URGENT.has(name)) return said.text ?? `${word(name)}: accepted`;
  const loop = said.seen_by_loop_ms;
  const seen = Number.isFinite(loop) ? `seen by the loop after ${loop.toFixed(1)} ms` : "taken; nothing was running";
  return `${word(name)}: ${seen} (answered in ${ms.toFixed(0)} ms)`;
}

function unheard(name, error) {
  if (URGENT.has(name)) return `${word(name).toUpperCase()} NOT CONFIRMED: use the hard-wired stop.`;
  return `${word(name)} not sent: ${error.name === "TypeError" ? "the server does not answer" : error.message}`;
}

export function word(name) {
  return { take_control: "Take control" }[name] ?? name[0].toUpperCase() + name.slice(1);
}
