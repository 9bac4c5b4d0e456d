// What became of an act after it was accepted: told by the station as an event, shown where the act was answered.

const BAD = new Set(["refused", "error"]);
let seen = null; // the newest event there was; null before the first look

/** {ok, text} when something came since the last look; null otherwise. */
export function outcome(events = []) {
  const before = seen;
  seen = name(events.at(-1));
  if (before === null || seen === before) return null;
  const last = events.slice(events.findLastIndex((event) => name(event) === before) + 1).findLast(tells);
  return last ? { ok: !BAD.has(last.kind), text: last.text } : null;
}

const name = (event) => (event ? `${event.utc} ${event.kind} ${event.text}` : "");

/** What failed, and what was pressed while nothing ran: in a run the state says it. */
const tells = (event) => BAD.has(event.kind) || (event.kind === "operator" && event.t === null);
