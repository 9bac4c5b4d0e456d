// How the last run ended, and its report.

import { $, say, show } from "../dom.js";
import { opened } from "../token.js";

export function lastRun(state) {
  const last = state.last_run;
  show($("last"), Boolean(last) && !state.run);
  if (!last) return;
  $("last").dataset.status = last.status;
  say($("last").querySelector(".said"), [last.title, last.sentence ?? last.verdict, last.status !== "completed" ? `${last.status}: ${last.reason}` : ""].filter(Boolean).join(": ") || last.status);
  const link = $("last").querySelector("a");
  show(link, Boolean(last.report));
  if (last.report) link.href = opened(last.report);
}
