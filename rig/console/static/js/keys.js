// Keys that work wherever the focus is. None of them writes a character, so none is typed into a field by accident.

const URGENT = { F2: "hold", F4: "stop", F8: "halt", Pause: "halt" };
const VIEWS = { 1: "tab-rig", 2: "tab-runs" };

export function keys(acts) {
  addEventListener(
    "keydown",
    (event) => {
      const name = URGENT[event.key];
      if (name && !event.ctrlKey && !event.altKey && !event.metaKey) {
        event.preventDefault();
        if (!event.repeat) acts[name]();
      } else if (event.altKey && VIEWS[event.key]) {
        event.preventDefault();
        document.getElementById(VIEWS[event.key]).click();
      }
    },
    { capture: true },
  );
}
