// SPDX-License-Identifier: Apache-2.0
// Measurements in the form of a fit: channels, windows that are fitted or held back, runs, and the shift of
// time.
import { choice, h } from "/core/dom.js";
import { nameOf, number, unitOf } from "/core/format.js";
import { itemRow, itemText, listFields, textOf } from "/form/list_fields.js";
import { addNumber } from "/form/study_form.js";

/**
 * @typedef {{ name: string, isUsed: boolean, weight: string, noise: string }} ChannelEntry
 * @typedef {{ id: string, fitted: string, held_back: string, runs: string, held_back_runs: string,
 *   time_shift_s: string, channels: ChannelEntry[] }} Entry
 */

const windowsText = (windows = []) => windows.map(([from, to]) => `${from} to ${to}`).join("; ");

/// Windows of a text such as "2 to 4.5; 5 to 6"; null if it is none.
/** @param {string} text */
function windowsOf(text) {
  const windows = text.split(";").filter((part) => part.trim() !== "")
    .map((part) => part.split(/\s+to\s+|\s*[–…]\s*/).map((each) => Number(each.trim() || NaN)));
  return windows.every((window) => window.length === 2 && window.every(Number.isFinite)) ? windows : null;
}

export class FittedMeasurements {
  /** @type {Entry[]} */
  items;

  /// @param known  measurements that are offered  @param given  of the request
  /**
   * @param {import("/form/request_form.js").RequestForm} form
   * @param {Api.Listed<"/v1/measurements">[]} known
   * @param {Api.Schemas["FittedMeasurement"][]} given
   */
  constructor(form, known, given) {
    this.form = form;
    this.known = known;
    this.items = given.map((each) => this.entryOf(each));
  }

  /** @param {Api.Schemas["FittedMeasurement"]} given  @returns {Entry} */
  entryOf({ id, fitted, held_back: heldBack, runs, held_back_runs: heldBackRuns, time_shift_s: shift,
    channels }) {
    const names = this.known.find((each) => each.id === id)?.channels.map(({ name }) => name)
      ?? Object.keys(channels ?? {});
    return { id, fitted: windowsText(fitted), held_back: windowsText(heldBack),
      runs: textOf(runs?.join(", ")),
      held_back_runs: textOf(heldBackRuns?.join(", ")), time_shift_s: textOf(shift),
      channels: names.map((name) => ({ name, isUsed: channels === undefined || name in channels,
        weight: textOf(channels?.[name]?.weight), noise: textOf(channels?.[name]?.noise) })) };
  }

  element() {
    const fresh = () => this.entryOf({ id: this.known[0]?.id ?? "" });
    return listFields(this.form, { title: "Measurements", noun: "Measurement", items: this.items, fresh,
      help: "Windows are times of the measurement in s, such as 2 to 4.5; 5 to 6. Without windows the "
        + "samples from "
        + "run_up_s on are fitted. What is held back is predicted, not fitted.",
      draw: (item, index) => this.draw(item, index) });
  }

  /** @param {Entry} item  @param {number} index  @returns {HTMLElement[]} */
  draw(item, index) {
    const { form } = this;
    const options = this.known.map(({ id, name, duration_s: duration }) =>
      [id, `${name || id} (${number(duration)} s)`]);
    if (!this.known.some(({ id }) => id === item.id)) options.unshift([item.id, item.id || "choose …"]);
    const channels = h("div");
    const drawChannels = () => channels.replaceChildren(...item.channels.map((channel) =>
      this.drawChannel(channel)));
    drawChannels();
    return [...itemRow(form, `measurements.${index}`, [choice("Measurement", options, item.id, (id) => {
      Object.assign(item, { id, channels: this.entryOf({ id }).channels });
      drawChannels();
      form.update();
    }), itemText(form, "Fitted windows [s]", item, "fitted", { size: 16 }),
    itemText(form, "Windows held back [s]", item, "held_back", { size: 16 }),
    itemText(form, "Runs", item, "runs", { placeholder: "all" }),
    itemText(form, "Runs held back", item, "held_back_runs"),
    itemText(form, "Time shift [s]", item, "time_shift_s", { placeholder: "0" })]), channels];
  }

  /** @param {ChannelEntry} channel */
  drawChannel(channel) {
    const unit = unitOf(channel.name);
    const box = h("input", { type: "checkbox",
      onchange: () => { channel.isUsed = box.checked; this.form.update(); } });
    box.checked = channel.isUsed;
    const name = nameOf(channel.name);
    return h("div", { class: "actions" }, h("label", {}, box, ` ${name}`),
      itemText(this.form, "Weight", channel, "weight",
        { placeholder: "1", "aria-label": `Weight of ${name}` }),
      itemText(this.form, `Noise${unit ? ` [${unit}]` : ""}`, channel, "noise",
        { placeholder: "estimated", "aria-label": `Noise of ${name}` }));
  }

  /** @param {{ path: string, detail: string }[]} problems */
  build(problems) {
    return this.items.map((item, index) => {
      const row = `measurements.${index}`;
      /** @type {any} */
      const request = { id: item.id };
      for (const key of ["fitted", "held_back"]) {
        const windows = windowsOf(item[key]);
        if (windows === null) problems.push({ path: row, detail: "windows are written as 2 to 4.5; 5 to 6" });
        else if (windows.length > 0) request[key] = windows;
      }
      for (const key of ["runs", "held_back_runs"]) {
        const numbers = item[key].split(/[\s,;]+/).filter(Boolean).map(Number);
        if (!numbers.every(Number.isInteger)) problems.push({ path: row, detail: "runs are whole numbers" });
        else if (numbers.length > 0) request[key] = numbers;
      }
      addNumber(item.time_shift_s, "time_shift_s", row, request, problems);
      const channels = this.#channelsOf(item, row, problems);
      if (channels) request.channels = channels;
      return request;
    });
  }

  /// Channels of a request; null if all are compared as usual.
  /** @param {Entry} item  @param {string} row  @param {{ path: string, detail: string }[]} problems */
  #channelsOf({ channels }, row, problems) {
    const used = channels.filter(({ isUsed }) => isUsed).map(({ name, weight, noise }) => {
      const channel = {};
      addNumber(weight, "weight", row, channel, problems);
      addNumber(noise, "noise", row, channel, problems);
      return [name, channel];
    });
    const isUsual = used.length === channels.length
      && used.every(([, channel]) => Object.keys(channel).length === 0);
    return isUsual ? null : Object.fromEntries(used);
  }

  /** @param {string} pointer */
  rowOf(pointer) {
    const index = pointer.split("/")[2];
    return `measurements.${index ?? 0}`;
  }
}
