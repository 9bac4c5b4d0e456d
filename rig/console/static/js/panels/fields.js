// A parameter as typed, turned into what is sent. What is not a number goes as text: the server words what is wrong.

const NUMBERS = new Set(["float", "int"]);
const DECIMAL = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i; // 0x10 is no number a person means
const LISTS = new Set(["tuple", "list"]);

export function typed(text, type) {
  const clean = text.trim().replace(/−/g, "-");
  if (LISTS.has(type)) return clean === "" ? [] : clean.split(/[\s;,]+/).filter(Boolean).map(number);
  if (NUMBERS.has(type)) return number(clean);
  if (type === "bool") return clean === "true";
  return text;
}

function number(text) {
  const value = Number(text);
  return DECIMAL.test(text) && Number.isFinite(value) ? value : text;
}

export function written(value) {
  return Array.isArray(value) ? value.join(", ") : value === null || value === undefined ? "" : String(value);
}
