// SPDX-License-Identifier: Apache-2.0
// One measurement: its signals run by run, and what is known of sensors and runs.
import { deleteMeasurement, findMeasurement, fits, measurementDataUrl } from "/core/api.js";
import { confirmed } from "/core/dialog.js";
import { choice, h, notify, tableCard } from "/core/dom.js";
import { bytes, moment, number, plural, titleOf } from "/core/format.js";
import { rememberQuery, routeTo } from "/core/route.js";
import { lineColour } from "/core/theme.js";
import { measuredTrace } from "/run/measured.js";
import { plotCard } from "/run/plot_card.js";
import { TimeWindow } from "/run/time_window.js";

const mostSearched = 100;

/**
 * @param {HTMLElement} main
 * @param {string} id
 * @param {URLSearchParams} query
 * @param {AbortSignal} signal
 */
export async function showMeasurement(main, id, query, signal) {
  const measurement = await findMeasurement(id, signal);
  const name = measurement.name || id;
  document.title = `RPSUP: ${name}`;
  const trouble = h("p", { class: "trouble", role: "alert" });
  const plots = h("div");
  const csv = h("a", { class: "button", download: `${name}.csv` }, "CSV");
  let shown = new AbortController();
  const showRun = (run) => {
    shown.abort();
    shown = new AbortController();
    plots.replaceChildren(...plotsOf(measurement, run, AbortSignal.any([signal, shown.signal])));
    csv.href = measurementDataUrl(id, { run, format: "csv" });
  };
  const first = Math.min(Number(query.get("run")) || 0, measurement.runs.length - 1);
  const runs = measurement.runs.map((run, index) => [String(index),
    `${index}: ${knownText(run) || plural(run.samples, "sample")}`]);
  main.replaceChildren(headOf(measurement, name, csv, trouble, signal), trouble, await usersOf(id, signal),
    measurement.runs.length > 1 ? h("p", { class: "actions" }, choice("Run", runs, String(first),
      (run) => { rememberQuery({ run }); showRun(Number(run)); })) : "", plots, channelTable(measurement),
    runTable(measurement));
  showRun(first);
}

/// @param csv  link to the samples
/**
 * @param {Api.Measurement} measurement
 * @param {string} name
 * @param {HTMLElement} csv
 * @param {HTMLElement} trouble
 * @param {AbortSignal} signal
 */
function headOf({ id, created_at: created, samples, duration_s: duration, bytes: size }, name, csv, trouble, signal) {
  return h("div", { class: "head" }, h("div", {}, h("h1", {}, name),
    h("p", { class: "quiet" }, `${plural(samples, "sample")}, ${number(duration)} s, ${bytes(size)}; stored `
      + `${moment(created)}`)),
  h("p", { class: "actions" },
    h("a", { class: "button main", href: routeTo("fits", "new", { measurement: id }) }, "Fit"), csv,
    h("button", { class: "danger", onclick: () => removeMeasurement(id, name, trouble,
      () => { if (!signal.aborted) location.hash = routeTo("measurements"); }) }, "Delete")));
}

/// Deletes a measurement if that is wanted; a refusal is told at its place.
/**
 * @param {string} id
 * @param {string} name
 * @param {HTMLElement} trouble
 * @param {() => unknown} done
 */
export async function removeMeasurement(id, name, trouble, done) {
  trouble.replaceChildren();
  if (!(await confirmed(`Delete “${name}”?`, "Delete"))) return;
  try {
    await deleteMeasurement(id);
    done();
  } catch (error) {
    const told = `“${name}” cannot be deleted: ${error.message}`;
    if (!trouble.isConnected) notify(told, "trouble");
    const user = /fit_\w+/.exec(error.message)?.[0];
    trouble.replaceChildren(`${told}. `,
      user ? h("a", { href: routeTo("fits", user) }, "Open the fit") : "");
  }
}

/// Links to the fits that use a measurement.
/** @param {string} id  @param {AbortSignal} signal */
async function usersOf(id, signal) {
  const { items } = await fits.list({ limit: mostSearched }, signal);
  const users = items.filter(({ measurement_ids: ids }) => ids.includes(id));
  return users.length === 0 ? "" : h("p", {}, `Used by ${plural(users.length, "fit")}: `,
    users.flatMap((fit, index) =>
    [index > 0 ? ", " : "", h("a", { href: routeTo("fits", fit.id) }, fit.name || fit.id)]));
}

/// Known parameters of a run in words; empty if there are none.
/** @param {Api.Measurement["runs"][number]} run */
function knownText({ parameters }) {
  return Object.entries(parameters).map(([key, value]) =>
    `${titleOf(key)} ${typeof value === "object" ? "…" : value}`).join(", ");
}

/** @param {Api.Measurement} measurement  @param {number} run  @param {AbortSignal} signal */
function plotsOf(measurement, run, signal) {
  const { start_s: start, end_s: end, sampling } = measurement.runs[run];
  const times = new TimeWindow(end, Math.min(end - start, 5 * sampling.largest_step_s), start);
  return measurement.channels.map(({ name }, index) => {
    const trace = measuredTrace(measurement, { run, channel: name, shift: 0 }, "measured",
      () => lineColour(index));
    return plotCard(titleOf(name), { traces: trace ? [trace] : [], times, height: 220, signal });
  });
}

const cell = (value) => h("td", { class: "number" }, number(value));

/** @param {Api.Measurement} measurement */
function channelTable({ channels }) {
  const numbers = ["Sign", "Gain", "Offset", "Delay [s]", "Low pass [Hz]"].map((text) => [text, "number"]);
  return tableCard("Channels", "The plots show sign · gain · x(t + delay) + offset of the samples x.",
    [["Channel"], ["Unit"], ["Column"], ...numbers],
      channels.map((each) => h("tr", {}, h("td", {}, each.name),
      h("td", {}, each.unit || "1"), h("td", {}, each.column), cell(each.sign), cell(each.gain),
        cell(each.offset),
      cell(each.delay_s), cell(each.low_pass_hz))));
}

/** @param {Api.Measurement} measurement */
function runTable({ runs }) {
  const numbers = ["Run", "Samples", "From [s]", "To [s]", "Mean rate [Hz]"].map((text) => [text, "number"]);
  return tableCard("Runs", "Extremes are those of the samples as they were sent.",
    [...numbers, ["Least, largest, RMS"], ["Known parameters"]],
      runs.map((run, index) => h("tr", {}, cell(index),
      cell(run.samples), cell(run.start_s), cell(run.end_s), cell(run.sampling.rate_hz),
      h("td", {}, run.statistics.map(({ channel, min, max, rms }) => h("div", { class: "small" },
        `${channel}: ${number(min)}, ${number(max)}, ${number(rms)}`))),
          h("td", {}, knownText(run) || "none"))));
}
