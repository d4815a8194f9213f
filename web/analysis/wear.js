// SPDX-License-Identifier: Apache-2.0
// Wear map of the bore in polar coordinates: a bar for the depth in each sector, a colour for each ring along the
// length.
import { depthAxis } from "/analysis/polar.js";
import { findWear } from "/core/api.js";
import { makeChart, saveButtons } from "/core/charts.js";
import { choice, h, tellTrouble } from "/core/dom.js";
import { exact, number } from "/core/format.js";
import { latest, retryWhileUnreachable } from "/core/live.js";
import { colour, lineColour } from "/core/theme.js";
import { faultOfNumber, numberOr } from "/form/numbers.js";

/**
 * @param {Api.Job} job
 * @param {{ name: string }[]} joints  with a bore  @param {AbortSignal} signal
 */
export function wearCard(job, joints, signal) {
  if (joints.length === 0) return null;
  const body = h("div");
  const details = h("details", { class: "card", ontoggle: () => {
    if (!details.open || body.hasChildNodes()) return;
    fill(body, job, joints.map(({ name }) => name), signal)
      .catch((error) => error.name !== "AbortError"
        && body.replaceChildren(h("p", { class: "trouble" }, error.message)));
  } }, h("summary", {}, "Wear of the bearing"), body);
  return details;
}

/** @param {HTMLElement} body  @param {Api.Job} job  @param {string[]} joints  @param {AbortSignal} signal */
async function fill(body, job, joints, signal) {
  const view = { joint: joints[0], wear_coefficient_m2_n: "1e-15", worn_clearance_mm: "", sectors: 72 };
  const drawing = h("div", { class: "chart tall" });
  const said = h("p", { role: "status" });
  /** @type {Api.Get<"/v1/jobs/{id}/wear">} */
  let rows = [];
  let chart = null;
  const load = latest(async (current) => {
    rows = await findWear(job.id, view, current);
    const worst = rows.reduce((most, row) => (row.depth_um > most.depth_um ? row : most));
    const life = worst.life_h === null ? ""
      : `; ${exact(Number(view.worn_clearance_mm))} mm after ${number(worst.life_h, 3)} h of this motion`;
    said.textContent = `Maximum depth: ${number(worst.depth_um)} µm in this run `
      + `at ${number((180 / Math.PI) * worst.angle_rad, 3)}°, ring at ${number(worst.position_mm)} `
      + `mm, ${number(worst.rate_um_h)} µm/h${life}.`;
    chart?.draw();
  }, signal);
  const retried = () => retryWhileUnreachable(load, tellTrouble, signal);
  const tryLoad = () => retried().catch((error) => { if (error.name !== "AbortError") tellTrouble(error.message); });
  const field = (label, key) => {
    const input = h("input",
      { type: "text", inputmode: "decimal", value: view[key],
        onchange: () => {
          const fault = faultOfNumber(input.value);
          if (fault) return tellTrouble(`${label}: ${fault}`);
          view[key] = numberOr(input.value, "");
          return tryLoad();
        } });
    return h("label", { class: "choice" }, h("span", {}, label), input);
  };
  body.replaceChildren(
    h("div", { class: "head" },
      h("p", { class: "quiet small" },
        "Archard's law: depth = coefficient × force × sliding distance / area. The coefficient depends on materials "
          + "and lubricant."),
    saveButtons(() => chart, () => `${job.id} wear`)),
  h("p", { class: "actions" }, joints.length > 1 ? choice("Joint", joints.map((name) => [name, name]), view.joint,
    (name) => { view.joint = name; tryLoad(); }) : null, field("Wear coefficient [m²/N]", "wear_coefficient_m2_n"),
    field("Worn clearance [mm]", "worn_clearance_mm")), said, drawing);
  await retried();
  chart = await makeChart(drawing, () => (rows.length > 0 ? optionOf(rows, drawing.clientWidth) : null),
    "Worn depth around the bearing", signal);
}

/// The bore is the circle in the middle; 0 degrees, the bearing's x, points right, and angles go against the clock.
/** @param {Api.Get<"/v1/jobs/{id}/wear">} rows  @param {number} width */
function optionOf(rows, width) {
  const rings = [...new Set(rows.map((row) => row.ring))];
  const sectors = rows.filter((row) => row.ring === rings[0])
    .map((row) => String(Math.round((180 / Math.PI) * row.angle_rad * 10) / 10));
  const text = { color: colour("text") };
  return {
    ...depthAxis(Math.max(...rows.map((row) => row.depth_um)), width),
    legend: { top: 0 }, polar: { radius: ["25%", "80%"] },
    tooltip: { formatter: ({ seriesName, name, value }) => `${seriesName}\n${name}°: ${number(value)} µm` },
    angleAxis: { type: "category", data: sectors, startAngle: 0, clockwise: false,
      axisLabel: { ...text, formatter: (angle) => `${angle}°`,
        interval: Math.max(0, Math.round(sectors.length / 12) - 1), hideOverlap: true },
      axisLine: { lineStyle: { color: colour("quiet") } } },
    series: rings.map((ring, index) =>
      ({ type: "bar", coordinateSystem: "polar",
        name: `ring at ${number(rows.find((row) => row.ring === ring)?.position_mm)} mm`, color: lineColour(index),
        barGap: "0%",
      data: rows.filter((row) => row.ring === ring).map((row) => row.depth_um) })),
  };
}
