// The three looks. High contrast also comes by itself where the system asks for it.

import { $ } from "../dom.js";

const KEY = "hdrig-look";

export function themes(changed) {
  const wanted = localStorage.getItem(KEY) ?? (matchMedia("(prefers-contrast: more)").matches ? "contrast" : "calm");
  $("theme").value = wanted;
  document.documentElement.dataset.theme = $("theme").value;
  $("theme").addEventListener("change", () => {
    document.documentElement.dataset.theme = $("theme").value;
    localStorage.setItem(KEY, $("theme").value);
    changed();
  });
}
