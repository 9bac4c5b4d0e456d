// What happened, newest first: state changes quiet, trips loud.

import { $, h, refill } from "../dom.js";

const SHOWN = 60;

export function events(state) {
  const latest = (state.events ?? []).slice(-SHOWN).reverse();
  const newest = latest[0];
  refill($("events"), [latest.length, newest?.t, newest?.text], () => latest.map(line));
}

function line(event) {
  const at = new Date(event.utc);
  const time = Number.isNaN(at.getTime()) ? "" : at.toLocaleTimeString("en-GB");
  const item = h("li", {}, h("time", { dateTime: event.utc ?? "" }, time), h("b", {}, event.kind), h("span", {}, event.text));
  item.dataset.kind = event.kind;
  return item;
}
