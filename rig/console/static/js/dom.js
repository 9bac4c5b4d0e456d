// Elements and their text. Text is only ever set as text, never as markup: names and notes come from people and files.

export const $ = (id) => document.getElementById(id);

/** An element with properties and children; a string child becomes text. */
export function h(tag, props = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

/** Set the text, and leave the page alone where it says that already. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export function show(element, visible) {
  if (element.hidden === visible) element.hidden = !visible;
}

/** Rebuild a list only when what it says has changed. */
export function refill(element, key, make) {
  const told = JSON.stringify(key);
  if (element.dataset.key === told) return;
  element.dataset.key = told;
  element.replaceChildren(...make());
}
