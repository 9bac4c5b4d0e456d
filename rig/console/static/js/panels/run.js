// How far the run is, and the present values: one tile each, with its unit and what it is measured against.

import { $, h, say, show } from "../dom.js";
import { fixed, lasting, plain, withUnit } from "../numbers.js";

const TILES = [
  ["peak", "Error, peak to peak", "last whole turn"],
  ["following", "Following error", "motor, rms so far"],
  ["angle", "Motor angle", "from encoder zero"],
  ["speed", "Motor speed", ""],
  ["motor", "Motor torque", ""],
  ["shaft", "Shaft torque", ""],
  ["lateness", "Loop lateness", "50 % / 99 % of ticks"],
  ["missed", "Missed ticks", "in this run"],
];
const tiles = new Map();

export function makeTiles() {
  $("tiles").replaceChildren(...TILES.map(([name, title, basis]) => {
    const tile = { number: h("span", {}, "—"), unit: h("small", {}), value: h("dd", { className: "value live" }), basis: h("dd", { className: "basis" }, basis), box: null };
    tile.value.append(tile.number, tile.unit);
    tile.box = h("div", { className: "tile" }, h("dt", {}, title), tile.value, tile.basis);
    tile.box.dataset.tile = name;
    tiles.set(name, tile);
    return tile.box;
  }));
}

function put(name, text, abnormal = false, basis = null) {
  const tile = tiles.get(name);
  const [number, ...unit] = text.split(/(?=\u00a0)/);
  say(tile.number, number);
  say(tile.unit, unit.join(""));
  tile.box.classList.toggle("abnormal", abnormal);
  if (basis !== null) say(tile.basis, basis);
}

/** `present`: the newest value of each column by name. */
export function tilesOf(state, present) {
  const { run, bench } = state;
  const limits = bench?.limits ?? {};
  const late = run?.lateness;
  put("peak", run ? withUnit(run.peak_to_peak_arcsec, "arcsec", 1) : "—");
  put("following", run ? withUnit(run.rms_following_deg, "deg", 3) : "—");
  const last = (name) => (bench ? present.get(name) ?? NaN : NaN);
  put("angle", withUnit(last("motor_angle"), "deg", 1));
  gauge("speed", last("speed"), "rpm", 1, limits.speed_rpm);
  gauge("motor", last("tau_m"), "N·m", 2, limits.torque);
  gauge("shaft", last("tau_l"), "N·m", 2, limits.shaft_torque);
  put("lateness", late && Number.isFinite(late.p50_us) ? `${fixed(late.p50_us, 0)} / ${withUnit(late.p99_us, "µs", 0)}` : "—");
  put("missed", late && Number.isFinite(late.missed) ? withUnit(late.missed, late.missed === 1 ? "tick" : "ticks", 0) : "—", late?.missed > 0, run?.rows ? `of ${run.rows}` : "in this run");
}

/** Abnormal from nine tenths of the bench's limit on. */
function gauge(name, value, unit, digits, limit) {
  const close = Number.isFinite(limit) && Math.abs(value) > 0.9 * limit;
  put(name, withUnit(value, unit, digits), close, Number.isFinite(limit) ? `limit ±${plain(limit)} ${unit}` : "");
}

export function progress(state) {
  const { run, campaign } = state;
  say($("run-title"), run ? run.title : state.job || "nothing runs");
  say($("run-folder"), run ? short(run.folder) : "");
  const share = run && run.duration ? Math.min(run.t / run.duration, 1) : 0;
  $("run-meter").setAttribute("aria-valuenow", String(Math.round(100 * share)));
  $("run-meter").firstElementChild.style.transform = `scaleX(${share.toFixed(4)})`;
  const left = run && Number.isFinite(run.left_s) ? `   ${lasting(run.left_s)} left` : "";
  say($("run-time"), run ? `${Math.round(100 * share)} %   ${lasting(run.t)} of at most ${lasting(run.duration)}${left}` : "");
  show($("campaign"), Boolean(campaign));
  if (campaign) say($("campaign"), `campaign ${campaign.plan}: run ${campaign.done + 1} of ${campaign.total}, ${campaign.current ?? ""}${Number.isFinite(campaign.left_s) ? `, about ${lasting(campaign.left_s)} left` : ""}`);
}


/** A run folder without the way to it. */
const short = (folder) => (folder ?? "").split("/").slice(-2).join("/");
