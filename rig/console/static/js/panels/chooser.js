// What to run, with which parameters: checked by the server as they are typed, with the dry run and its margins.

import { $, h, refill, say, show } from "../dom.js";
import { lasting, plain } from "../numbers.js";
import { get, headers } from "../token.js";
import { typed, written } from "./fields.js";
import { permit } from "./buttons.js";

const PAUSE = 150; // ms without a key before the server is asked

export class Chooser {
  catalogue = { procedures: [], plans: [] };
  left = []; // campaigns that were stopped before their end
  going; // folder of the one that goes on, null for none; undefined: not asked yet
  kind = "procedure";
  kept = new Map(); // what was typed, by procedure: changing one's mind loses nothing
  ok = false;
  #asked = 0;
  #timer = 0;

  constructor() {
    $("chosen").addEventListener("change", () => this.#choose());
    $("parameters").addEventListener("input", () => this.#typed());
    $("chooser").addEventListener("submit", (event) => event.preventDefault());
    for (const button of $("chooser").querySelectorAll("[data-kind]")) button.addEventListener("click", () => this.#kind(button.dataset.kind));
  }

  offer(catalogue) {
    this.catalogue = catalogue;
    this.#kind(this.kind);
  }

  /** What `start` or `campaign` sends. */
  get order() {
    const note = $("start-note").value;
    if (this.kind === "plan") return { act: "campaign", more: { ...this.#plan(), note } };
    return { act: "start", more: { procedure: $("chosen").value, parameters: this.#values(), note } };
  }

  /** The start button: what the station allows, and only with parameters that make sense. */
  permit(state, refused) {
    const act = this.kind === "plan" ? "campaign" : "start";
    const allowed = refused ? "this page has no valid token: it only looks" : state.allowed?.[act];
    permit($("start"), allowed === true && !this.ok ? "a parameter cannot be meant: see above" : allowed);
    say($("start"), this.#words);
    this.#look(state.campaign?.folder ?? null);
    const bench = state.bench?.source ?? null;
    if (bench !== this.bench) {
      this.bench = bench;
      this.#ask();
    }
  }

  get #words() {
    const chosen = this.#chosen;
    if (chosen?.plan) return `Go on with campaign ${chosen.plan}`;
    return this.kind === "plan" ? `Start campaign ${$("chosen").value}` : `Start ${$("chosen").value}`;
  }

  /** A new campaign by its plan, or one to go on with by its folder. */
  #plan() {
    const chosen = this.#chosen;
    return chosen?.plan ? { resume: chosen.name } : { plan: $("chosen").value, parameters: this.#values() };
  }

  /** A campaign that has ended may be one to go on with. */
  async #look(going) {
    if (going === this.going) return;
    this.going = going;
    if (going === null) this.#left(await get("/api/campaigns").catch(() => ({})));
  }

  #left({ campaigns = [] }) {
    const before = $("chosen").value;
    this.left = campaigns.map(unfinished);
    if (this.kind !== "plan") return;
    this.#fill();
    if (this.#offered.some((one) => one.name === before)) $("chosen").value = before;
    this.#choose();
  }

  #kind(kind) {
    this.kind = kind;
    for (const button of $("chooser").querySelectorAll("[data-kind]")) button.setAttribute("aria-pressed", String(button.dataset.kind === kind));
    this.#fill();
    this.#choose();
  }

  #fill() {
    $("chosen").replaceChildren(...grouped(this.#offered));
  }

  get #offered() {
    return this.kind === "plan" ? [...this.catalogue.plans, ...this.left] : this.catalogue.procedures;
  }

  get #chosen() {
    return this.#offered.find((one) => one.name === $("chosen").value);
  }

  #choose() {
    const chosen = this.#chosen;
    say($("summary"), chosen ? (chosen.summary ?? "").replace(/\s+\[[^\]]*\]\s*$/, "") + (chosen.needs_lock ? " Needs the output locked." : "") : "");
    const kept = this.kept.get(chosen?.name) ?? {};
    $("parameters").replaceChildren(...(chosen?.parameters ?? []).map((parameter) => field(parameter, kept[parameter.name])));
    this.#ask();
  }

  #typed() {
    const texts = {};
    for (const input of $("parameters").querySelectorAll("input")) texts[input.name] = input.value;
    this.kept.set($("chosen").value, texts);
    clearTimeout(this.#timer);
    this.ok = false; // until the server has seen it
    this.#timer = setTimeout(() => this.#ask(), PAUSE);
  }

  #values() {
    const values = {};
    for (const input of $("parameters").querySelectorAll("input")) {
      if (input.value !== input.defaultValue) values[input.name] = typed(input.value, input.dataset.type);
    }
    return values;
  }

  async #ask() {
    const number = ++this.#asked;
    const chosen = this.#chosen;
    if (!chosen) return;
    const question = this.kind === "plan" ? this.#plan() : { procedure: chosen.name, parameters: this.#values() };
    const said = await check({ ...question, ...(this.bench ? {} : { bench: $("bench-name").value }) });
    if (number === this.#asked) this.#tell(said); // an answer to what was typed before is none
  }

  #tell(said) {
    this.ok = said.ok;
    const problems = said.problems ?? {};
    for (const input of $("parameters").querySelectorAll("input")) {
      const wrong = problems[input.name] ?? "";
      input.setAttribute("aria-invalid", String(wrong !== ""));
      say(document.getElementById(`${input.id}-wrong`), wrong);
    }
    const known = new Set([...$("parameters").querySelectorAll("input")].map((input) => input.name));
    const general = Object.entries(problems).filter(([name]) => !known.has(name)).map(([, sentence]) => sentence);
    refill($("margins"), [said.margins, said.sums, general], () => [...general.map((sentence) => h("li", { className: "wrong" }, sentence)), ...(said.margins ?? []).map(bar), ...summed(said.sums)]);
    const list = $("plan").querySelector("ul");
    show($("plan"), (said.plan ?? []).length > 0);
    refill(list, said.plan, () => (said.plan ?? []).map((line) => h("li", {}, line)));
  }
}

async function check(question) {
  try {
    const answer = await fetch("/api/check-parameters", { method: "POST", headers, body: JSON.stringify(question) });
    if (answer.ok) return await answer.json();
    return { ok: false, problems: { "": answer.status === 401 ? "not checked: this page has no valid token" : `not checked: the server answered ${answer.status}` } };
  } catch {
    return { ok: false, problems: { "": "not checked: the server does not answer" } };
  }
}

function grouped(offered) {
  const groups = new Map();
  for (const one of offered) groups.set(one.group ?? "", [...(groups.get(one.group ?? "") ?? []), one]);
  const option = (one) => h("option", { value: one.name }, one.title ?? one.name);
  return [...groups].flatMap(([group, members]) => (group ? [h("optgroup", { label: group }, ...members.map(option))] : members.map(option)));
}

/** A campaign that was left, among the plans. */
function unfinished({ folder, plan, done, total, started_utc, why }) {
  const begun = (started_utc ?? "").slice(0, 16).replace("T", " ");
  return { name: folder, plan, group: "Go on with", title: `${plan}, ${done} of ${total} done, begun ${begun} UTC`, summary: `${done} of ${total} runs are done; ${why}. It goes on in its own order, on the bench it began with.` };
}

/** Name, field, unit; the problem below it. */
function field({ name, type, unit, default: value, meaning }, kept) {
  const id = `parameter-${name}`;
  const input = h("input", { id, name, defaultValue: written(value), inputMode: type === "str" ? "text" : "decimal", autocomplete: "off", spellcheck: false, title: meaning ?? "" });
  input.setAttribute("aria-describedby", `${id}-wrong`);
  input.dataset.type = type;
  if (kept !== undefined) input.value = kept;
  const shown = name.replace(/_(deg|rpm|s|mm|hz)$/i, "").replace(/_/g, " ");
  return h("div", { className: "parameter" }, h("label", { htmlFor: id, title: meaning ?? "" }, shown), input, h("span", { className: "unit" }, unit === "1" || !unit ? "" : unit), h("p", { className: "wrong", id: `${id}-wrong` }));
}

/** How long it takes, what it stores, and which limit it comes nearest to: in sight without opening anything. */
function summed(sums) {
  if (!sums) return [];
  const told = [["stored energy", `≤ ${plain(Number(sums.stored_j.toPrecision(2)))}\u00a0J`], ["duration", `≤ ${lasting(sums.duration_s)}`], ["tightest margin", `${sums.nearest}, ${Math.floor(100 * sums.left)}\u00a0%`]];
  return [h("li", { className: "sums" }, ...told.map(([what, value]) => h("span", {}, h("small", {}, what), h("b", {}, value))))];
}

/** How much of a limit the run asks for. */
function bar({ what, asked, limit, unit, fraction, clamped }) {
  const share = Number.isFinite(fraction) ? fraction : 0;
  const fill = h("i", {});
  fill.style.transform = `scaleX(${Math.min(Math.max(share, 0), 1).toFixed(4)})`;
  const item = h("li", {}, h("span", { className: "what" }, what), h("span", { className: "track" }, fill), h("span", { className: "value" }, `${clamped ? "at most " : ""}${plain(asked)} of ${plain(limit)} ${unit}`));
  item.dataset.margin = share > 1 ? "beyond" : share > 0.9 && !clamped ? "thin" : "wide";
  return item;
}
