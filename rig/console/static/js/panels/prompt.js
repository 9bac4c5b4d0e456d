// A change by hand that a campaign waits for. It stands over the charts until it is answered; the present values stay in sight, halt in reach, and notes can be made.

import { $, say, show } from "../dom.js";

let shown = null;

export function prompt(state) {
  const asked = state.prompt ?? null;
  const box = $("prompt");
  show(box, asked !== null);
  $("charts").inert = asked !== null;
  if (asked === null) shown = null;
  else say($("prompt-text"), asked.text);
  if (asked === null || asked.id === shown) return;
  shown = asked.id;
  $("tab-rig").click(); // from whatever else is being looked at
  box.focus(); // the box, not a button: a key on its way to something else must not answer
}

export const promptId = () => shown;
