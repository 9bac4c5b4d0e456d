// Which button may be pressed: exactly what the station allows in this state, and the reason beside each that may not.

const buttons = () => document.querySelectorAll("[data-act]");

export function permit(button, allowed) {
  const yes = allowed === true;
  button.setAttribute("aria-disabled", String(!yes));
  button.title = yes ? "" : String(allowed ?? "not possible now");
}

/** `refused`: the server does not know this page's token. */
export function permissions(state, refused) {
  const look = refused ? "this page has no valid token: it only looks" : null;
  for (const button of buttons()) permit(button, look ?? state.allowed?.[button.dataset.act]);
  const connect = document.querySelector('[data-act="connect"]');
  if (!document.getElementById("bench-name").value) permit(connect, look ?? "the list of benches is not here yet");
  for (const button of document.querySelectorAll("[data-jog]")) permit(button, look ?? state.allowed?.jog);
}

/** Nothing but stopping, for one reason. */
export function forbid(why) {
  for (const button of document.querySelectorAll("[data-act], [data-jog], [data-start]")) {
    if (!["hold", "stop"].includes(button.dataset.act)) permit(button, why);
  }
}

/** Called once per press: not for the second half of a double click, not while the first is on its way. */
export function onPress(button, press, refuse) {
  let waiting = false;
  button.addEventListener("click", async (event) => {
    event.preventDefault();
    if (event.detail > 1 || waiting) return;
    if (button.getAttribute("aria-disabled") === "true") return refuse(button.title);
    waiting = true;
    button.classList.add("waiting");
    try {
      await press(event);
    } finally {
      waiting = false;
      button.classList.remove("waiting");
    }
  });
}
