// The one websocket to the server. Says what it hears, and how long ago it last heard anything; comes back by itself.

import { page, token } from "./token.js";
import { decode } from "./rows.js";

const AGAIN = 500; // ms between two attempts
const STALE = 500; // ms without a state after which nothing on the page may pass for the present
const FIRST = 5000; // ms the first state may take: a loaded machine still sends the page then

export class Link extends EventTarget {
  #socket = null;
  heard = performance.now(); // when the last state came; before the first, when the page began to wait
  waiting = true; // for the first state

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = (this.#socket = new WebSocket(`${scheme}://${location.host}/api/live`));
    socket.binaryType = "arraybuffer";
    socket.onopen = () => socket.send(JSON.stringify({ token, page }));
    socket.onmessage = (message) => this.#hear(message.data);
    socket.onclose = (event) => this.#closed(event.code);
  }

  get age() {
    return performance.now() - this.heard;
  }

  get stale() {
    return this.age > (this.waiting ? FIRST : STALE);
  }

  #hear(data) {
    if (data instanceof ArrayBuffer) {
      const rows = decode(data);
      if (rows) this.dispatchEvent(new CustomEvent("rows", { detail: rows }));
      return;
    }
    this.heard = performance.now();
    this.waiting = false;
    const state = JSON.parse(data);
    this.#socket?.send(JSON.stringify({ seen: state.seq })); // the page's sign of life
    this.dispatchEvent(new CustomEvent("state", { detail: state }));
  }

  #closed(code) {
    this.#socket = null;
    this.dispatchEvent(new CustomEvent("closed", { detail: code }));
    const refused = code === 4401 || code === 4403; // trying again would be refused again
    if (!refused) setTimeout(() => this.open(), AGAIN);
  }
}
