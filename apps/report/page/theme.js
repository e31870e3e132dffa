// Light and dark: the style sheet holds every colour; who draws on a canvas reads it here and is told when it changes.

const listeners = new Set();
const system = window.matchMedia("(prefers-color-scheme: dark)");
let colors = new Map();

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  colors = new Map();
  for (const listener of listeners) listener();
}

/// As the address asks (#theme=dark), else as the system does, until the reader chooses.
const asked = /[#&]theme=(light|dark)/.exec(location.hash);
setTheme(asked ? asked[1] : system.matches ? "dark" : "light");
system.addEventListener("change", () => setTheme(system.matches ? "dark" : "light"));

export function toggleTheme() {
  setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
}

export function onThemeChange(listener) {
  listeners.add(listener);
}

/// The value of the custom property --name.
export function color(name) {
  if (!colors.has(name)) colors.set(name, getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim());
  return colors.get(name);
}

export const kSeriesColors = 8;

/// The colour of the k-th series; they repeat.
export function seriesColor(k) {
  return color("series-" + (k % kSeriesColors));
}
