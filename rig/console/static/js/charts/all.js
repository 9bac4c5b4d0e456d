// All charts of the page: fed by rows, drawn once a frame at most, never more often than there is something new.

import { $, say, show } from "../dom.js";
import { History } from "../rows.js";
import { legend } from "./legend.js";
import { Loop } from "./loop.js";
import { MOST, Orders } from "./orders.js";
import { Strip } from "./time.js";
import { Turns } from "./turns.js";
import { Wave } from "./wave.js";

const EVERY = { strips: 40, picture: 90, orders: 450 }; // ms between two drawings: samples come every 50
const REST = 0.5; // s: rows that follow so soon are the last of a run; idle ones have another clock
const ROWS = 12_000; // 20 s of 250 pairs a second, and some more

export class Charts {
  constructor() {
    this.history = new History(ROWS);
    this.present = new Map(); // the newest value of each column, of a run or not
    this.turns = new Turns();
    this.strips = [
      new Strip($("chart-angle"), [{ column: "reference", label: "reference", colour: "axis", scale: "deg", width: 3 }, { column: "motor_angle", label: "measured", colour: "forward", scale: "deg" }], [{ scale: "deg", label: "deg", least: 5 }], legend),
      new Strip($("chart-following"), [{ column: "following", label: "reference less motor", colour: "forward", scale: "deg" }], [{ scale: "deg", label: "deg, motor", least: 0.5 }], legend),
      new Strip($("chart-torque"), [{ column: "tau_m", label: "motor", colour: "forward", scale: "m" }, { column: "tau_l", label: "shaft (right)", colour: "reverse", scale: "l", dash: [5, 3] }], [{ scale: "m", label: "motor, N·m", least: 0.5 }, { scale: "l", label: "shaft, N·m", least: 1, side: 1 }], legend),
    ];
    this.orders = new Orders($("chart-orders"));
    const box = (name) => $("chart-picture").querySelector(`.plot.${name}`);
    this.pictures = { wave: new Wave(box("wave")), loop: new Loop(box("loop")) };
    this.fresh = new Set();
    this.drawn = {};
    this.choose("wave");
    this.run = null;
    this.bench = null;
    requestAnimationFrame(() => this.#frame());
  }

  /** A new run begins a new picture, another bench an empty one; a run that is over stays until then. */
  follow(run, bench) {
    const uid = run?.uid ?? null;
    if ((bench?.source ?? null) !== this.bench) {
      this.bench = bench?.source ?? null;
      this.run = null;
      this.present.clear();
      this.clear();
    }
    const over = uid === null && this.run !== null;
    if (over && $("charts").dataset.over !== "true") this.turns.over();
    $("charts").dataset.over = String(over);
    if (uid === null || uid === this.run) return;
    this.run = uid;
    this.clear();
    this.choose(run.locked ? "loop" : "wave");
  }

  add(names, rows, running) {
    if (!rows.t.length) return;
    const of = new Map(names.map((name, k) => [name, rows.columns[k]]));
    const [angle, following, error, torque] = ["motor_angle", "following", "kinematic_error", "tau_l"].map((name) => of.get(name));
    if (angle && following) of.set("reference", angle.map((value, k) => value + following[k]));
    for (const [name, values] of of) this.present.set(name, values[values.length - 1]);
    const gap = rows.t[0] - this.history.newest;
    if (!running && this.run !== null && !(gap >= 0 && gap < REST)) return; // idle: what led to the end of a run stays
    if (gap < 0) this.clear(); // another clock: another stream
    this.history.add(of, rows.t);
    this.#renew();
    if (!running || !angle || !error) return;
    for (let k = 0; k < rows.t.length; k++) this.turns.add(angle[k], error[k]);
    for (let k = 0; torque && k < rows.t.length; k++) this.pictures.loop.add(error[k] / 60, torque[k]);
  }

  clear() {
    this.turns.clear();
    this.pictures.loop.clear();
    this.history.clear();
    this.#renew();
  }

  /** Everything is to be drawn again. */
  #renew() {
    for (const name of Object.keys(EVERY)) this.fresh.add(name);
  }

  /** Which picture stands in the large box. */
  choose(picture) {
    this.picture = picture;
    for (const button of document.querySelectorAll("[data-picture]")) button.setAttribute("aria-pressed", String(button.dataset.picture === picture));
    for (const box of $("chart-picture").querySelectorAll(".plot")) show(box, box.classList.contains(picture));
    legend($("picture-legend"), this.pictures[picture].lines);
    this.#renew();
  }

  restyle() {
    for (const chart of [...this.strips, this.orders, ...Object.values(this.pictures)]) chart.restyle();
    this.#renew();
  }

  #frame() {
    requestAnimationFrame(() => this.#frame());
    if (document.hidden || $("view-rig").hidden) return;
    if (this.#due("strips")) for (const strip of this.strips) strip.draw(this.history);
    if (this.#due("picture")) this.pictures[this.picture].draw(this.turns);
    if (this.#due("orders")) this.#drawOrders();
  }

  /** Whether there is something new to draw, and the last drawing long enough ago. */
  #due(name) {
    const now = performance.now();
    if (!this.fresh.has(name) || now - (this.drawn[name] ?? -Infinity) < EVERY[name]) return false;
    this.fresh.delete(name);
    this.drawn[name] = now;
    return true;
  }

  #drawOrders() {
    const { forward, reverse } = this.turns.ways;
    const way = forward.whole ? "forward" : "reverse";
    const amplitudes = this.turns.ways[way].orders(MOST);
    this.orders.draw(amplitudes);
    this.#explain(amplitudes, way);
  }

  #explain(amplitudes, way) {
    const { forward, reverse } = this.turns.ways;
    const nothing = this.picture === "wave" ? forward.n + reverse.n === 0 : !this.pictures.loop.twist.length;
    const empty = $("chart-picture").querySelector(".empty");
    show(empty, nothing);
    say(empty, this.picture === "wave" ? "The error is drawn here while a run turns the motor." : "Torque is drawn here over wind-up while the output is locked.");
    const orders = $("chart-orders");
    show(orders.querySelector(".empty"), amplitudes === null);
    say(orders.querySelector(".empty"), "after one whole turn clear of turning round");
    say(orders.querySelector(".legend"), amplitudes ? `of the mean, ${way}, ${count(this.turns.ways[way].revolutions)}` : "");
  }
}

const count = (turns) => `${turns} turn${turns === 1 ? "" : "s"}`;
