export function openRuns() {}
