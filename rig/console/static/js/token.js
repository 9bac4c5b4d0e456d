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

/** A UUID; crypto.randomUUID is there on https and on this machine only. */
export function uuid() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = (bytes[6] & 0x0f) | 0x40; // version 4
  bytes[8] = (bytes[8] & 0x3f) | 0x80; // the variant of RFC 9562
  const hex = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  return [hex.slice(0, 8), hex.slice(8, 12), hex.slice(12, 16), hex.slice(16, 20), hex.slice(20)].join("-");
}

const PAGE = "hdrig-page";
if (sessionStorage.getItem(PAGE) === null) sessionStorage.setItem(PAGE, uuid());

/** Who this page is, for as long as the tab lives: control stays with it over a reload. */
export const page = sessionStorage.getItem(PAGE);

/** What every request carries. */
export const headers = { "Content-Type": "application/json", "X-Hdrig-Token": token, "X-Hdrig-Page": page };

/** A page of this server that is opened by a link, which cannot carry headers. Another server's is not opened. */
export function opened(path) {
  const url = new URL(path, location.origin);
  if (url.origin !== location.origin) return "about:blank";
  url.searchParams.set("token", token);
  return url.href;
}

/** A GET of this server's as JSON. Throws a sentence. */
export async function get(path) {
  const answer = await fetch(path, { headers });
  if (answer.ok) return answer.json();
  const said = await answer.json().catch(() => ({}));
  throw new Error(said.why ?? said.detail ?? `the server answered ${answer.status}`);
}
