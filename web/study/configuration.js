// SPDX-License-Identifier: Apache-2.0
// Configuration of a sweep: what is varied, which parameters differ from their defaults, when and by which program it
// was computed.
import { findJob } from "/core/api.js";
import { h } from "/core/dom.js";
import { moment, nameOf, number, plural, span, unitOf } from "/core/format.js";

const mostListed = 8;  // values of an axis

/** @type {(value: number) => string} */
const shown = (value) => number(value, 6);

/** @type {(value: any, key: string) => string} */
function valueText(value, key) {
  if (typeof value === "number") return [shown(value), unitOf(key)].filter(Boolean).join(" ");
  if (typeof value === "string") return value;
  if (key === "linkage") return value.name ?? `of ${plural(Object.keys(value.joints ?? {}).length, "joint")}`;
  if (typeof value.law === "string") return value.law.replaceAll("_", " ");
  return JSON.stringify(value);
}

/// "5 to 15 rad/s, 25 values", or the values themselves.
/** @type {(axis: any, key: string) => string} */
function axisText(axis, key) {
  if (Array.isArray(axis)) {
    const listed = axis.slice(0, mostListed)
      .map((value) => (typeof value === "number" ? shown(value) : valueText(value, key)));
    const more = axis.length > mostListed ? `, … (${axis.length} values)` : "";
    const unit = typeof axis[0] === "number" ? unitOf(key) : "";
    return [`${listed.join(", ")}${more}`, unit].filter(Boolean).join(" ");
  }
  const { from, to, count, scale } = axis;
  const how = scale === "log" ? " in equal ratios" : "";
  return `${[`${shown(from)} to ${shown(to)}`, unitOf(key)].filter(Boolean).join(" ")}`
    + `${count === undefined ? "" : `, ${count} values${how}`}`;
}

/// Parameters of the request that differ from their defaults.
/** @param {any} request  @param {any} schema */
function fixedParameters({ parameters = {} }, schema) {
  return Object.entries(parameters).filter(([key, value]) =>
    JSON.stringify(value) !== JSON.stringify(schema.properties?.[key]?.default));
}

/** @param {any} replicates */
function replicatesText({ count, perturbation, tolerance_factor: factor }) {
  return [`${count} of each set`,
    perturbation === undefined ? "" : `contact stiffness within ± ${shown(100 * perturbation)} %`,
    factor === undefined ? "" : `tolerances × ${shown(factor)}`].filter(Boolean).join(", ");
}

/** @param {Api.Sweep} sweep */
function durationText({ started_at: started, ended_at: ended }) {
  if (!started) return "";
  const seconds = (Date.parse(ended ?? new Date().toISOString()) - Date.parse(started)) / 1000;
  return ended ? span(seconds) : `${span(seconds)} so far`;
}

/// Name and text of a line; without a text there is no line.
/** @type {(name: string, text: string) => [string, string]} */
const entry = (name, text) => [name, text];

/** @param {any} design */
const designEntries = (design) => Object.entries(design?.over ?? {})
  .map(([key, axis]) => entry(nameOf(key), `${axisText(axis, key)}, ${design.type.replaceAll("_", " ")}`));

/// The card, which asks for the program of the first job that has one.
/**
 * @param {SweepPage} page
 * @returns {{ element: HTMLElement, draw: () => void }}
 */
export function configurationCard(page) {
  const list = h("dl", { class: "configuration" });
  const programText = h("dd");
  const program = h("div", { hidden: true }, h("dt", {}, "Program"), programText);
  let isAsked = false;

  async function learnProgram() {
    const row = page.rows.find(({ state }) => state === "succeeded" || state === "failed");
    if (!row || isAsked) return;
    isAsked = true;
    const { run } = await findJob(row.job_id, page.signal).catch(() => ({ run: null }));
    if (!run) return;
    programText.textContent = `RPSUP ${run.program.version}, engine ${run.program.engine}, on ${run.host}`;
    program.hidden = false;
  }

  function draw() {
    const { sweep, schema } = page;
    const { request } = sweep;
    const entries = [
      ...Object.entries(request.sweep ?? {}).map(([key, axis]) => entry(nameOf(key), axisText(axis, key))),
      ...designEntries(request.design),
      entry("Cases", request.cases ? String(request.cases.length) : ""),
      entry("Replicates", request.replicates ? replicatesText(request.replicates) : ""),
      ...fixedParameters(request, schema).map(([key, value]) => entry(nameOf(key), valueText(value, key))),
      entry("Everything else", "defaults"), entry("Submitted", moment(sweep.created_at)),
      entry("Computing time", durationText(sweep))];
    list.replaceChildren(...entries.filter(([, text]) => text !== "")
      .map(([name, text]) => h("div", {}, h("dt", {}, name), h("dd", {}, text))), program);
    learnProgram();
  }

  const request = h("pre", { class: "small" });
  const element = h("details", { class: "card", open: true, "aria-label": "Configuration" },
    h("summary", {}, "Configuration"), list,
    h("details", { ontoggle: () => { request.textContent = JSON.stringify(page.sweep.request, null, 1); } },
      h("summary", {}, "Request"), request));
  return { element, draw };
}
