// What the lines of a chart are, said above it with a piece of each line.

import { h } from "../dom.js";

export function legend(element, lines) {
  element.replaceChildren(...lines.map(({ label, colour, dash }) => h("span", { className: "key" }, h("i", { className: `line ${colour}${dash ? " dashed" : ""}` }), label)));
}
