// SPDX-License-Identifier: Apache-2.0
// Selects above the charts of a sweep: metric, axes, and another sweep beside it.
import { listSweeps } from "/core/api.js";
import { choice } from "/core/dom.js";
import { moment, titleOf } from "/core/format.js";
import { quantityChoice } from "/core/quantities.js";

/** @param {SweepPage} page */
export function drawPickers(page) {
  const { view, axes, metrics } = page;
  // A scale was chosen for the axis or the metric that it stood at, and curves for their axes.
  const forgotten = { x: { xScale: "", curves: null }, y: { curves: null }, panel: { curves: null },
    metric: { metricScale: "" } };
  const set = (key) => (value) => { Object.assign(view, { [key]: value,
    ...forgotten[key] }); page.changed(); };
  const named = axes.map((name) => [name, titleOf(name)]);
  page.pickers.replaceChildren(quantityChoice("Metric", "metrics", metrics, view.metric, set("metric")),
    ...(axes.length === 0 ? [] : [choice("x axis", named, view.x, set("x"))]),
    choice("y axis / series", [["", "none"], ...named], view.y, set("y")),
    choice("Facet by", [["", "none"], ...named], view.panel, set("panel")), page.compare);
  offerComparison(page);
}

/** @param {SweepPage} page */
async function offerComparison(page) {
  const found = await listSweeps({ limit: 100 }, page.signal).catch(() => null);
  const alike = (found?.items ?? []).filter(({ id, axes, study_id: study }) => id !== page.sweep.id && !study
    && axes.includes(page.view.x));
  // Equal names are told apart by their dates.
  const namesakes = (name) => alike.filter((sweep) => sweep.name === name).length;
  const titles = alike.map(({ id, name, created_at: created }) =>
    [id, name && namesakes(name) > 1 ? `${name}, ${moment(created)}` : name || id]);
  if (alike.length === 0) return;
  page.compare.replaceChildren(
    choice("Compare with", [["", "none"], ...titles], page.others?.id ?? "", (id) => page.compareWith(id)));
}
