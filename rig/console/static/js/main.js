// The page: what comes from the server goes to the panels, what the operator does goes to the server.

import { act } from "./actions.js";
import { Charts } from "./charts/all.js";
import { $, say } from "./dom.js";
import { keys } from "./keys.js";
import { Link } from "./link.js";
import { forbid, onPress, permissions } from "./panels/buttons.js";
import { Chooser } from "./panels/chooser.js";
import { events } from "./panels/events.js";
import { typed } from "./panels/fields.js";
import { freshness, header } from "./panels/header.js";
import { lastRun } from "./panels/last.js";
import { now } from "./panels/now.js";
import { outcome } from "./panels/outcome.js";
import { prompt, promptId } from "./panels/prompt.js";
import { makeTiles, progress, tilesOf } from "./panels/run.js";
import { benches, steps } from "./panels/steps.js";
import { themes } from "./panels/theme.js";
import { openRuns } from "./runs/view.js";
import { get, token } from "./token.js";
import { panels, views } from "./views.js";

const LOOK_AT_AGE = 100; // ms

let state = null; // the newest the server sent
let refused = token === "";
let came = null; // {ok, text}: what became of the last act, where it is known
let notNow = null; // the revision a button was refused at, while the answer still says so

makeTiles();
const charts = new Charts();
const chooser = new Chooser();
const link = new Link();
themes(() => charts.restyle());
views(openRuns);
panels();

function draw(next) {
  state = next;
  document.documentElement.dataset.revision = String(state.revision);
  header(state);
  now(state);
  charts.follow(state.run, state.bench);
  progress(state);
  tilesOf(state, charts.present);
  steps(state);
  events(state);
  lastRun(state);
  prompt(state);
  permissions(state, refused);
  chooser.permit(state, refused);
  const fresh = outcome(state.events);
  if (fresh) answer((came = fresh));
  else if (notNow !== null && notNow !== state.revision) answer({ ok: true, text: "" }); // what refused it may be over
  look(); // last: live is a page that shows the state it heard
}

/** How old the page is; where that is too old, or nothing came yet, nothing but stopping may be pressed. */
function look() {
  const unsure = { stale: "the page is stale: what may be done now is not known", waiting: "waiting for the first state" };
  const why = unsure[freshness(link, state)];
  if (why) forbid(why);
}

function answer({ ok, text }) {
  const box = $("answer");
  box.dataset.ok = String(ok);
  say(box, text);
  notNow = null;
}

/** Send one act, based on what the page shows now. */
async function send(name, more = {}) {
  came = null;
  const said = await act(name, state, more);
  answer(said.ok && came ? came : said); // what became of it may be here before its answer
}

const urgent = (name) => () => send(name);
function refuse(why) {
  answer({ ok: false, text: `Not possible now: ${why}` });
  notNow = state?.revision ?? null;
}

function jog(direction) {
  const turns = typed($("jog-turns").value, "float");
  return send("jog", { turns: typeof turns === "number" ? direction * turns : turns, speed_rpm: typed($("jog-speed").value, "float") });
}

const more = {
  connect: () => ({ bench: $("bench-name").value }),
  note: () => ({ text: $("note-text").value }),
};

async function press(button) {
  const name = button.dataset.act;
  await send(name, more[name]?.() ?? {});
  if (name === "note" && $("answer").dataset.ok === "true") $("note-text").value = "";
}

for (const button of document.querySelectorAll("[data-act]")) onPress(button, () => press(button), refuse);
for (const button of document.querySelectorAll("[data-jog]")) onPress(button, () => jog(Number(button.dataset.jog)), refuse);
onPress($("start"), () => send(chooser.order.act, chooser.order.more), refuse);
onPress($("prompt-done"), () => send("answer", { prompt_id: promptId(), done: true }), refuse);
onPress($("prompt-not"), () => send("answer", { prompt_id: promptId(), done: false }), refuse);
$("halt").addEventListener("pointerdown", urgent("halt"));
$("halt").addEventListener("click", (event) => event.detail === 0 && send("halt")); // by keyboard or assistive technology
for (const button of document.querySelectorAll("[data-picture]")) button.addEventListener("click", () => charts.choose(button.dataset.picture));
keys({ hold: urgent("hold"), stop: urgent("stop"), halt: urgent("halt") });

link.addEventListener("state", ({ detail }) => draw(detail));
link.addEventListener("rows", ({ detail }) => charts.add((state?.live?.columns ?? []).map((column) => column.name), detail, Boolean(state?.run)));
link.addEventListener("closed", ({ detail }) => {
  if (detail !== 4401 && detail !== 4403) return;
  refused = true;
  document.documentElement.dataset.link = "refused";
  answer({ ok: false, text: "This page has no valid token: it shows nothing live. Open the address that hdrig serve printed." });
});
link.open();
look();
setInterval(look, LOOK_AT_AGE);

const offered = await get("/api/catalogue");
benches(offered.benches ?? []);
chooser.offer(offered);
if (state) draw(state);
