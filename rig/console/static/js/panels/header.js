// The bar on top: which bench, simulated or not, the hard-wired chain, and whether the page hears anything.

import { $, say, show } from "../dom.js";
import { aged, plain } from "../numbers.js";

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

/** How old the picture is; `samples` is the age of the newest sample when the state was made [ms], null without one. */
export function freshness(link, samples) {
  const root = document.documentElement;
  const kind = root.dataset.link === "refused" ? "refused" : link.stale ? "stale" : "live";
  root.dataset.link = kind;
  show($("stale"), kind === "stale");
  say($("stale-age"), `no word from the station for ${aged(link.age)}`);
  const now = samples === null || samples === undefined ? null : samples + link.age;
  root.dataset.samples = now !== null && now > 500 ? "old" : "fresh"; // ms
  say($("link").querySelector(".text"), { live: `live, state ${aged(Math.min(link.age, 200))} old`, stale: `stale for ${aged(link.age)}`, refused: "look only: no valid token" }[kind]);
  return kind;
}
