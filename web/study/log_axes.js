// SPDX-License-Identifier: Apache-2.0
// Boxes for logarithmic axes of the lines, offered where values lie decades apart.
import { h, part } from "/core/dom.js";
import { nameOf } from "/core/format.js";
import { valuesOf } from "/study/data.js";
import { spansDecades } from "/study/span.js";

/// Axes that may be logarithmic.
/** @param {Pick<SweepPage, "rows" | "others" | "view">} sweep */
function offeredLogs({ rows, others, view }) {
  const both = others ? [rows, others.rows] : [rows];
  const metrics = both.flat().map((row) => row[view.metric]).filter((value) => value !== null && value !== undefined);
  return { x: spansDecades(both.flatMap((some) => valuesOf(some, view.x))), metric: spansDecades(metrics) };
}

/// Logarithmic axes. An axis with values decades apart is one unless the user says otherwise.
/// The metric's axis is one only if the user says so.
/** @param {Pick<SweepPage, "rows" | "others" | "view">} sweep */
export function chosenLogs(sweep) {
  const offered = offeredLogs(sweep);
  return { x: offered.x && sweep.view.xScale !== "linear", metric: offered.metric && sweep.view.metricScale === "log" };
}

/// A box for each axis that may be logarithmic. @param changed  is called when one has been ticked
/** @param {SweepPage} sweep  @param {() => void} changed */
export function logBoxes(sweep, changed) {
  const box = (key) =>
    h("input", { type: "checkbox",
      onchange: ({ target }) => { sweep.view[key] = target.checked ? "log" : "linear"; changed(); } });
  const boxes = { x: box("xScale"), metric: box("metricScale") };
  const labels = Object.fromEntries(Object.entries(boxes)
    .map(([key, input]) => [key, h("label", { class: "small" }, input, h("span"))]));

  function draw() {
    const [offered, chosen] = [offeredLogs(sweep), chosenLogs(sweep)];
    for (const [key, label] of Object.entries(labels)) {
      label.hidden = !offered[key];
      boxes[key].checked = chosen[key];
      part("span", label).textContent = ` log scale: ${nameOf(sweep.view[key]).toLowerCase()}`;
    }
  }

  return { element: h("span", { class: "actions" }, labels.x, labels.metric), draw };
}
