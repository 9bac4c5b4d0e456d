// How the last run ended, and its report.

import { $, say, show } from "../dom.js";
import { opened } from "../token.js";

export function lastRun(state) {
  const last = state.last_run;
  const over = Boolean(last) && !state.run;
  show($("last"), over);
  show($("run-meter"), !over);
  if (!last) return;
  $("last").dataset.status = last.status;
  const said = $("last").querySelector(".said");
  say(said, [last.title, last.sentence ?? last.verdict, last.status !== "completed" ? `${last.status}: ${last.reason}` : ""].filter(Boolean).join(": ") || last.status);
  said.title = said.textContent;
  const link = $("last").querySelector("a");
  show(link, Boolean(last.report));
  if (last.report) link.href = opened(last.report);
}
