// SPDX-License-Identifier: Apache-2.0
// Tables of a job: metrics, losses, provenance, parameters.
import { h } from "/core/dom.js";
import { exact, nameOf, number, plural, span, timeMetricOf, titleOf, unitOf } from "/core/format.js";
import { term } from "/core/quantities.js";
import { variedIn } from "/run/described.js";
import { labelsOf } from "/run/labels.js";

const mostListed = 6;  // values of a parameter

/// Peaks stand with their times.
/** @param {Api.Job[]} jobs  @param {string[]} axes  of their sweep */
export function metricsCard(jobs, axes) {
  const all = Object.keys(jobs[0].metrics ?? {});
  const times = new Set(all.map(timeMetricOf));
  const names = all.filter((name) => !times.has(name));
  const labels = labelsOf(jobs, axes);
  const head = h("tr", {}, h("th", { scope: "col" }, "Metric"),
    labels.flatMap((_, index) => [h("th", { scope: "col", class: "number" }, jobs.length === 1 ? "Value" : labels[index]),
      h("th", { scope: "col", class: "number" }, "At [s]")]),
    h("th", { scope: "col" }, "Unit"));
  return h("section", { class: "card scroll", tabindex: 0, "aria-label": "Metrics" }, h("h2", {}, "Metrics"),
    h("table", { class: "metrics" }, h("thead", {}, head), h("tbody", {},
    names.map((name) => h("tr", {}, h("td", {}, term("metrics", name, nameOf(name))),
      jobs.flatMap((job) => [h("td", { class: "number" }, number(job.metrics?.[name], 5)),
        h("td", { class: "number quiet" }, timeOf(job, name))]), h("td", {}, unitOf(name)))))),
      whyMissing(jobs));
}

/** @param {Api.Job} job  @param {string} metric */
function timeOf({ metrics }, metric) {
  const time = metrics?.[timeMetricOf(metric)];
  return typeof time === "number" ? number(time, 4) : "";
}

/// A dash without a word would look like a fault.
/** @param {Api.Job[]} jobs */
function whyMissing(jobs) {
  const early = jobs.filter(({ metrics, parameters }) => metrics && parameters.duration_s <= parameters.run_up_s);
  if (early.length === 0) return "";
  const which = jobs.length === 1
    ? `; this run ends at ${exact(early[0].parameters.duration_s)} s, at or before run_up_s `
    + `(${exact(early[0].parameters.run_up_s)} s)` : "; some of these runs have ended by then";
  return h("p", { class: "quiet small" }, `Values of the steady part count from run_up_s on${which}.`);
}

/// Table of the energy losses by kind, with the energy residual.
/** @param {Api.Job} job */
export function lossesCard({ metrics }) {
  const losses = ["friction_work_j", "impact_loss_j",
    "structural_loss_j"].map((name) => ({ name, value: metrics?.[name] }));
  const largest = Math.max(...losses.map(({ value }) => Math.abs(value ?? 0)), Number.MIN_VALUE);
  return h("div", {}, h("table", {}, h("caption", { class: "quiet small" }, "Losses over the whole run"),
    h("tbody", {}, losses.map(({ name, value }) =>
      h("tr", {}, h("th", { scope: "row" }, term("metrics", name, titleOf(name))),
    h("td", {}, h("progress", { value: Math.abs(value ?? 0) / largest, "aria-label": nameOf(name) })),
    h("td", { class: "number" }, number(value)))))),
    h("p", { class: "small" }, `Energy residual: ${number(metrics?.energy_residual, 2)} of the work turned over.`));
}

/// Time, machine and program of a run.
/** @param {NonNullable<Api.Job["run"]>} run */
function provenanceOf({ program, libm, ...run }) {
  return [`${span(run.wall_time_s)} on ${run.cpu}, ${run.host}`,
    `version ${program.version} (${program.commit}), ${program.compiler}`, libm && `${libm}, ${run.numerics} numerics`,
    run.reused && "reused from an earlier run"].filter(Boolean).join("; ");
}

/// Parameters of a job by their paths, those of its links one by one, without the linkage.
/** @param {Api.Job} job  @returns {[string, any][]} */
function parametersOf({ parameters: { linkage: _, links, ...others } }) {
  /** @type {[string, any][]} */
  const ofLinks = Object.entries(links ?? {}).flatMap(([link, values]) =>
    Object.entries(values).map(([key, value]) => /** @type {[string, any]} */ ([`links.${link}.${key}`, value])));
  return [...Object.entries(others), ...ofLinks].filter(([, value]) => value !== null && value !== undefined);
}

/// Value of a parameter in words: a drive as JSON, of a long list the number of its values.
/** @param {any} value */
function valueText(value) {
  if (!Array.isArray(value)) return typeof value === "object" ? JSON.stringify(value, null, 1) : exact(value);
  const values = value.flat(Infinity);
  return values.length > mostListed ? plural(values.length, "value") : values.map(exact).join(", ");
}

/// @param axes  of the job's sweep, of which those inside a linkage or drive are shown, too
/** @param {Api.Job} job  @param {any} schema  @param {string[]} axes */
export function runCard(job, schema, axes) {
  const schemaOf = (name) => name.split(".").reduce((inner, key) => inner?.properties?.[key], schema);
  const isDefault = ([name, value]) => JSON.stringify(schemaOf(name)?.default) === JSON.stringify(value);
  const all = parametersOf(job);
  const inside = variedIn(job, axes).filter(([axis]) => !all.some(([name]) => name === axis));
  const row = ([name, value]) => h("tr", {}, h("td", {}, nameOf(name)),
    h("td", { class: typeof value === "object" ? null : "number" }, valueText(value)),
    h("td", {}, schemaOf(name)?.["x-unit"] ?? (name.includes(".") ? unitOf(name) : "")));
  const facts = job.run ? provenanceOf(job.run) : "not completed";
  return h("section", { class: "card" }, h("h2", {}, "Parameters"), h("p", { class: "small quiet" }, `Run: ${facts}.`),
    h("table", {}, h("tbody", {},
      [...inside, ...all.filter((each) => !isDefault(each))].map(row))),
    h("details", {}, h("summary", {}, "Parameters at their defaults"),
      h("table", {}, h("tbody", {}, all.filter(isDefault).map(row)))));
}
