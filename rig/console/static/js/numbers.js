// Numbers as people read them: always with their unit, a dash where nothing was measured.

const MINUS = "−";
const NARROW = "\u202f"; // within one quantity: 3 min 20 s
const GAP = "\u00a0"; // between number and unit

/** `digits` are those after the point. */
export function fixed(value, digits) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "—";
  const text = Math.abs(value).toFixed(digits);
  const zero = Number(text) === 0;
  return (value < 0 && !zero ? MINUS : "") + text;
}

export function withUnit(value, unit, digits) {
  const text = fixed(value, digits);
  return text === "—" || !unit || unit === "1" ? text : `${text}${GAP}${unit}`;
}

/** As short as it can be said, for limits and parameters: 400, 9.6, 0.25. */
export function plain(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "—";
  return String(Number(value.toPrecision(5))).replace("-", MINUS);
}

/** Seconds as a person counts them: 42 s, 3 min 20 s, 2 h 05 min. */
export function lasting(seconds) {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return "—";
  const s = Math.max(0, Math.round(seconds));
  if (s < 100) return `${s}${GAP}s`;
  if (s < 3600) return `${Math.floor(s / 60)}${NARROW}min ${String(s % 60).padStart(2, "0")}${NARROW}s`;
  return `${Math.floor(s / 3600)}${NARROW}h ${String(Math.floor((s % 3600) / 60)).padStart(2, "0")}${NARROW}min`;
}

/** An age in whatever unit makes it short: 12 ms, 3.4 s. */
export function aged(ms) {
  if (ms === null || ms === undefined || !Number.isFinite(ms)) return "—";
  return ms < 1000 ? `${Math.round(ms)}${GAP}ms` : lastingExactly(ms / 1000);
}

function lastingExactly(seconds) {
  return seconds < 60 ? `${seconds.toFixed(1)}${GAP}s` : lasting(seconds);
}
