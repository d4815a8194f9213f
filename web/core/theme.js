// SPDX-License-Identifier: Apache-2.0
// Colours: light or dark, and the palettes of values. Both are kept for the next visit.
import { part } from "/core/dom.js";

const palettes = {
  viridis: ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b",
    "#fde725"],
  cividis: ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55",
    "#fee838"],
};

// Okabe and Ito's, for lines: told apart with every kind of colour vision. The bright ones come first on dark ground.
const lineColours = {
  light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d1f"],
  dark: ["#56b4e9", "#e69f00", "#2fbf94", "#cc79a7", "#f0e442", "#e2703a", "#b9c4cf"],
};

/// Frame of what is selected, and its ring.
export const frame = { borderColor: "#e6007a", borderWidth: 3 };
export const ring = { color: "transparent", ...frame };

const changed = new EventTarget();

/** @type {(id: string) => HTMLSelectElement} */
const selectOf = (id) => part(`select#${id}`);

/** @param {HTMLSelectElement} select */
function restore(select, key) {
  const kept = localStorage.getItem(key);
  if (kept !== null && [...select.options].some((option) => option.value === kept)) select.value = kept;
}

export function startTheme() {
  const [theme, colours] = [selectOf("theme"), selectOf("palette")];
  restore(theme, "theme");
  restore(colours, "palette");
  const apply = () => {
    localStorage.setItem("theme", theme.value);
    localStorage.setItem("palette", colours.value);
    if (theme.value === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme.value;
    changed.dispatchEvent(new Event("change"));
  };
  theme.addEventListener("change", apply);
  colours.addEventListener("change", apply);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
  apply();
}

/// Calls back whenever the colours change, until the signal is given.
export function onColours(callback, signal) {
  changed.addEventListener("change", callback, { signal });
}

export function isDark() {
  const { theme } = document.documentElement.dataset;
  return theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

/// The value of a colour of the style sheet: colour("text").
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

export function palette() {
  return palettes[selectOf("palette").value];
}

/// The palette for lines: without its dark end on dark ground, and without its bright end on bright ground.
/// These would not be seen.
export function linePalette() {
  return isDark() ? palette().slice(3) : palette().slice(0, 7);
}

export function lineColour(index) {
  const colours = lineColours[isDark() ? "dark" : "light"];
  return colours[index % colours.length];
}

const channels = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/// The colour for lines at a part of the palette's length, 0 to 1.
export function paletteColour(place) {
  const stops = linePalette();
  const at = Math.min(Math.max(place, 0), 1) * (stops.length - 1);
  const left = Math.min(Math.floor(at), stops.length - 2);
  const [from, to] = [channels(stops[left]), channels(stops[left + 1])];
  return `rgb(${from.map((value, i) => Math.round(value + (to[i] - value) * (at - left))).join(" ")})`;
}
