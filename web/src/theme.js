// Colours in light and dark, of the palette that the package's pictures have.

let palette; // {light, dark}, which the page's CSS variables have too
const listeners = [];
const system = window.matchMedia("(prefers-color-scheme: dark)");

export function usePalette(given) {
  palette = given;
}

export function onTheme(listener) {
  listeners.push(listener);
}

export function dark() {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : system.matches;
}

/** The other of light and dark, until the page is closed. */
export function toggleTheme() {
  document.documentElement.dataset.theme = dark() ? "light" : "dark";
  for (const listener of listeners) listener();
}

system.addEventListener("change", () => listeners.forEach((listener) => listener()));

/** Colours by what they are for, and `lines`: those of lines one after the other. */
export function colors() {
  return dark() ? palette.dark : palette.light;
}
