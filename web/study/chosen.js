// SPDX-License-Identifier: Apache-2.0
// Bar above charts that tells how much is selected, and opens the jobs of a selection.
import { h } from "/core/dom.js";
import { plural } from "/core/format.js";
import { routeTo } from "/core/route.js";

const mostOverlaid = 6;

/// Fills the bar. @param noun  for what is selected: "job"
/**
 * @param {HTMLElement} bar
 * @param {import("/study/selection.js").Selection} selection
 * @param {string} noun
 */
export function drawChosen(bar, selection, noun = "job") {
  const { ids } = selection;
  bar.hidden = ids.length === 0;
  const [first, ...more] = ids;
  bar.replaceChildren(h("span", {}, `${plural(ids.length, noun)} selected`),
    ids.length > 0 && ids.length <= mostOverlaid
      ? h("a", { class: "button main", href: routeTo("jobs", first, { with: more.join(",") }) },
        ids.length === 1 ? "Open" : "Overlay") : "",
    h("button", { onclick: () => selection.set([]) }, "Clear selection"));
}
