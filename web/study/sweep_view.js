// SPDX-License-Identifier: Apache-2.0
// View of the page of a sweep: read from its address, and written into it.
import { usualMetric, valuesOf } from "/study/data.js";

const mostInAddress = 20;  // selected jobs

/** @param {string | null} text */
function curvesIn(text) {
  try {
    const keys = JSON.parse(text ?? "null");
    return Array.isArray(keys) ? keys.map((values) => JSON.stringify(values)) : null;
  } catch {
    return null;
  }
}

/// View of a sweep as an address tells it; what the address leaves out is chosen by how many values an axis
/// has.
/**
 * @param {URLSearchParams} query
 * @param {{ sweep: Api.Sweep, rows: Api.Row[], axes: string[], metrics: string[] }} shown
 */
export function viewFrom(query, { sweep, rows, axes, metrics }) {
  const varied = [...axes].sort((a, b) => valuesOf(rows, b).length - valuesOf(rows, a).length);
  /** @type {(key: string, allowed: string[], otherwise?: string) => string} */
  const pick = (key, allowed, otherwise) => allowed.find((each) => each === query.get(key)) ?? otherwise
    ?? "";
  const all = [...axes, ...metrics];
  return { metric: pick("metric", metrics, usualMetric(metrics, rows, sweep)),
    x: pick("x", axes, varied[0] ?? "job_id"),
    y: pick("y", axes, query.has("x") ? "" : varied[1]),
    panel: pick("panel", axes, query.has("x") ? "" : varied[2]),
    xScale: pick("x_scale", ["linear"]), metricScale: pick("metric_scale", ["log"]),
      curves: curvesIn(query.get("curves")),
    scatterX: pick("scatter_x", all), scatterY: pick("scatter_y", all),
      scatterColour: pick("scatter_colour", ["none", ...all]) };
}

/// The same as keys of an address. @param selected  jobs
/** @param {ReturnType<typeof viewFrom>} view  @param {string[]} selected */
export function queryOf(view, selected) {
  return { metric: view.metric, x: view.x, y: view.y, panel: view.panel, x_scale: view.xScale === "linear"
    ? "linear" : "",
    metric_scale: view.metricScale === "log" ? "log" : "", curves: view.curves ? `[${view.curves.join(",")}]`
      : "",
    scatter_x: view.scatterX, scatter_y: view.scatterY, scatter_colour: view.scatterColour,
    jobs: selected.length <= mostInAddress ? selected.join(",") : "" };
}
