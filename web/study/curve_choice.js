// SPDX-License-Identifier: Apache-2.0
// Choice of the curves that are drawn, where there are more than can be told apart.
import { h, keepFocus } from "/core/dom.js";
import { nameOf } from "/core/format.js";
import { nameOfCurve } from "/study/curves.js";
import { curvesOfSweep } from "/study/lines.js";

const mostListed = 200;  // at once: a search narrows more of them

/// @param changed  is called when the choice has changed
/** @param {SweepPage} sweep  @param {() => void} changed */
export function curveChoice(sweep, changed) {
  const summary = h("summary");
  const search = h("input", { type: "search", "aria-label": "Search curves", placeholder: "Search",
    oninput: () => drawList() });
  const list = h("div", { class: "list" });
  const more = h("p", { class: "quiet small" });
  const evenly = h("button", { onclick: () => set(null) }, "Evenly spread");
  const element = h("details", { class: "menu within", ontoggle: () => element.open && drawList() }, summary,
    h("div", { class: "card" }, h("p", { class: "actions" }, search, evenly), more, list));

  /** @param {string[] | null} keys */
  function set(keys) {
    sweep.view.curves = keys;
    changed();
  }

  function drawList() {
    const { drawn, most } = curvesOfSweep(sweep);
    const keys = drawn.map(({ key }) => key);
    const found = curvesNamed(search.value, sweep);
    more.textContent = limitsText(keys.length >= most ? most : null, found.length);
    evenly.disabled = sweep.view.curves === null;
    keepFocus(list, () => list.replaceChildren(...found.slice(0, mostListed)
      .map((curve) => curveBox(curve, keys, most, set))));
  }

  function draw() {
    const { own, drawn } = curvesOfSweep(sweep);
    element.hidden = own.length < (sweep.view.curves === null ? 3 : 2);
    summary.textContent = `Curves: ${drawn.length} of ${own.length.toLocaleString("en")}`;
    if (element.open) drawList();
  }

  return { element, draw };
}

/// Curves of the sweep whose names have the text in them.
/** @param {string} text  @param {SweepPage} sweep */
function curvesNamed(text, sweep) {
  const { own, roles } = curvesOfSweep(sweep);
  const nameIn = (curve) => nameOfCurve(curve, roles) || nameOf(sweep.view.metric);
  return own.map((curve) => ({ key: curve.key, name: nameIn(curve) }))
    .filter(({ name }) => name.toLowerCase().includes(text.trim().toLowerCase()));
}

/// Sentences on the limits that are reached. @param most  curves, if so many are drawn  @param found  curves
/** @param {number | null} most  @param {number} found */
function limitsText(most, found) {
  return [most !== null && `At most ${most} at once: take one out for another.`,
    found > mostListed && `The first ${mostListed} of ${found.toLocaleString("en")}: search for others.`]
    .filter(Boolean).join(" ");
}

/// Labelled box of a curve. The last one that is drawn stays, and no more are taken in than can be drawn.
/**
 * @param {{ key: string, name: string }} curve
 * @param {string[]} drawn  keys
 * @param {number} most
 * @param {(drawn: string[]) => void} set
 */
function curveBox({ key, name }, drawn, most, set) {
  const isDrawn = drawn.includes(key);
  const isFixed = isDrawn ? drawn.length === 1 : drawn.length >= most;
  const box = h("input", { type: "checkbox", "data-key": key, disabled: isFixed,
    onchange: () => set(isDrawn ? drawn.filter((each) => each !== key) : [...drawn, key]) });
  box.checked = isDrawn;
  return h("label", {}, box, ` ${name}`);
}
