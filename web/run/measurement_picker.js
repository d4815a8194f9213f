// SPDX-License-Identifier: Apache-2.0
// Chooses a measured signal, to be laid over a job: measurement, run, channel, and where its time begins.
import { findMeasurement, listMeasurements } from "/core/api.js";
import { choice, h, notify } from "/core/dom.js";
import { titleOf } from "/core/format.js";
import { latest } from "/core/live.js";
import { faultOfNumber, numberOr } from "/form/numbers.js";

const mostOffered = 100;

/// Elements of the choice; none if no measurement has a channel of the job.
/**
 * @param {string[]} columns  of the job
 * @param {(overlay: import("/run/measured.js").Overlay) => void} chosen
 * @param {AbortSignal} signal
 * @returns {Promise<HTMLElement[]>}
 */
export async function measurementPicker(columns, chosen, signal) {
  const { items } = await listMeasurements({ limit: mostOffered }, signal);
  const fitting = items.filter(({ channels }) => channels.some(({ name }) => columns.includes(name)));
  if (fitting.length === 0) return [];
  const details = h("span", { class: "actions" });
  const show = latest(async (current, /** @type {string} */ id) => {
    details.replaceChildren();
    if (id) details.replaceChildren(...detailsOf(await findMeasurement(id, current), columns, chosen));
  }, signal);
  const pick = choice("Overlay measurement",
    [["", "choose …"], ...fitting.map(({ id, name }) => [id, name || id])], "",
    (id) => show(id).catch((error) => notify(error.message, "trouble")));
  return [pick, details];
}

/** @param {Api.Measurement} measurement  @param {string[]} columns  @param {(overlay: any) => void} chosen */
function detailsOf({ id, runs, channels }, columns, chosen) {
  const names = channels.map(({ name }) => name).filter((name) => columns.includes(name));
  const overlay = { id, run: 0, channel: names[0], shift: 0 };
  const shift = h("input", { type: "text", inputmode: "decimal", size: 6, value: "0" });
  const run = runs.length < 2 ? [] : [choice("Run", runs.map((_, index) => String(index)), "0",
    (index) => { overlay.run = Number(index); })];
  return [...run, choice("Channel", names.map((name) => [name, titleOf(name)]), names[0],
    (channel) => { overlay.channel = channel; }),
  h("label", { class: "choice" }, h("span", {}, "Shift [s]"), shift),
  h("button", { onclick: () => {
    const fault = faultOfNumber(shift.value);
    if (fault) notify(`Shift: ${fault}`, "trouble");
    else chosen({ ...overlay, shift: numberOr(shift.value, 0) });
  } }, "Lay over")];
}
