// The bar on top: which bench, simulated or not, the hard-wired chain, and whether the page hears anything.

import { $, say, show } from "../dom.js";
import { aged, plain } from "../numbers.js";

const OLD = 500; // ms after which a sample is no present value

export function header(state) {
  const bench = state.bench;
  say($("bench"), bench ? [bench.name, bench.gear && `gear ${bench.gear}`, bench.ratio && `N = ${plain(bench.ratio)}`].filter(Boolean).join(" · ") : "no bench connected");
  show($("simulated"), Boolean(bench?.simulated));
  const chain = state.chain ?? { known: false, text: "" };
  $("chain").dataset.chain = chain.known ? (chain.closed ? "closed" : "open") : "unknown";
  say($("chain").querySelector(".text"), chain.known ? `hard-wired chain ${chain.closed ? "closed" : "OPEN"}` : "hard-wired chain: not known");
  $("chain").title = chain.text ?? "";
  show($("viewer"), Boolean(state.viewer_url));
  if (state.viewer_url) $("viewer").href = local(state.viewer_url);
}

/** A viewer runs on this machine or this server: any other address is not followed. */
function local(url) {
  const target = new URL(url, location.href);
  const near = ["127.0.0.1", "localhost", location.hostname].includes(target.hostname);
  return near && /^https?:$/.test(target.protocol) ? target.href : "about:blank";
}

/** How old the picture is. Stale is a page that hears nothing, and one whose control process has died; before the first
 * state there is no picture, and none is claimed. */
export function freshness(link, state) {
  const root = document.documentElement;
  const dead = state?.station === false;
  const kind = root.dataset.link === "refused" ? "refused" : link.stale || dead ? "stale" : link.waiting ? "waiting" : "live";
  root.dataset.link = kind;
  root.dataset.station = dead && !link.stale ? "gone" : "there"; // what is said of its end is new, whatever else is old
  show($("stale"), kind === "stale" || kind === "refused");
  say($("stale").firstElementChild, kind === "refused" ? "NO TOKEN" : "STALE");
  if (kind === "refused") say($("stale-age"), "this page hears nothing, and its halt is refused");
  else say($("stale-age"), dead && !link.stale ? "the control process has ended: nobody looks after the rig" : `no word from the station for ${aged(link.age)}`);
  const samples = state?.live?.age_ms ?? null; // when the state was made; null without any
  root.dataset.samples = samples !== null && samples + link.age > OLD ? "old" : "fresh";
  say($("link").querySelector(".text"), { waiting: "waiting for the state", live: `live, state ${aged(link.age)} old`, stale: `stale for ${aged(link.age)}`, refused: "look only: no valid token" }[kind]);
  return kind;
}
