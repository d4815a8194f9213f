// SPDX-License-Identifier: Apache-2.0
// Choice of the curves that are drawn, where there are more than can be told apart.
import { h } from "/core/dom.js";
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
    const { own, drawn, most, roles } = curvesOfSweep(sweep);
    const keys = drawn.map(({ key }) => key);
    const named = own.map((curve) => ({ key: curve.key, name: nameOfCurve(curve, roles)
      || nameOf(sweep.view.metric) }))
      .filter(({ name }) => name.toLowerCase().includes(search.value.trim().toLowerCase()));
    const isFull = keys.length >= most;
    more.textContent = [isFull && `At most ${most} at once: take one out for another.`,
      named.length > mostListed
        && `The first ${mostListed} of ${named.length.toLocaleString("en")}: search for others.`].filter(Boolean).join(" ");
    evenly.disabled = sweep.view.curves === null;
    const focused = list.contains(document.activeElement) ? document.activeElement?.getAttribute("data-key")
      : null;
    list.replaceChildren(...named.slice(0, mostListed).map(({ key, name }) => {
      const isDrawn = keys.includes(key);
      const box = h("input", { type: "checkbox", "data-key": key, disabled: (isFull && !isDrawn)
        || (isDrawn && keys.length === 1),
        onchange: () => set(isDrawn ? keys.filter((each) => each !== key) : [...keys, key]) });
      box.checked = isDrawn;
      return h("label", {}, box, ` ${name}`);
    }));
    if (focused) [...list.querySelectorAll("input")].find((box) => box.dataset.key === focused)?.focus();
  }

  function draw() {
    const { own, drawn, most } = curvesOfSweep(sweep);
    element.hidden = own.length <= 1 || (own.length <= most && sweep.view.curves === null && own.length < 3);
    summary.textContent = `Curves: ${drawn.length} of ${own.length.toLocaleString("en")}`;
    if (element.open) drawList();
  }

  return { element, draw };
}
