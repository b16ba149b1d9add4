// Colours in light and dark, of the palette that the package's pictures have.

let palette = {};
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

/** Colours of lines, one after the other. */
export function lineColors() {
  const { blue, vermilion, green, purple, orange, sky, yellow, black } = palette;
  return dark()
    ? [sky, orange, green, purple, yellow, vermilion, "#f2f4f7"]
    : [blue, vermilion, green, purple, orange, sky, black];
}

/** Everything else that is drawn by hand. */
export function colors() {
  const { blue, vermilion, sky, orange, green } = palette;
  return dark()
    ? { back: "#171c24", ink: "#e8ecf2", faint: "#8d98a8", grid: "#2b333f", shadow: "#0d1117", ball: "#243140", minor: orange, major: sky, axis: "#2fc795",
        momentum: orange, path: "#77859a" }
    : { back: "#ffffff", ink: "#18212c", faint: "#66727f", grid: "#e3e8ee", shadow: "#d3d9e0", ball: "#dfe9f3", minor: vermilion, major: blue, axis: green,
        momentum: vermilion, path: "#8c99a8" };
}
