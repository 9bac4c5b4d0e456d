// The token of the printed address: taken out of the address bar, kept for this tab only, so that a reload goes on.

const KEY = "hdrig-token";

function given() {
  const hash = new URLSearchParams(location.hash.slice(1));
  const query = new URLSearchParams(location.search);
  const token = hash.get("token") ?? query.get("token");
  if (token !== null) {
    sessionStorage.setItem(KEY, token);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem(KEY) ?? "";
}

export const token = given();

/** Who this page is, for as long as the tab lives: control stays with it over a reload. */
export const page = sessionStorage.getItem("hdrig-page") ?? crypto.randomUUID();
sessionStorage.setItem("hdrig-page", page);
