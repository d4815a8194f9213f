// SPDX-License-Identifier: Apache-2.0
// One column of a file in the form of an upload: whether it is sent, its channel and unit, and its sensor.
import { h } from "/core/dom.js";
import { unitOf } from "/core/format.js";

const sensorFields = /** @type {const} */ ([["sign", "Sign (1 or −1)"], ["gain", "Gain"], ["offset", "Offset"],
  ["delay_s", "Delay [s]"], ["low_pass_hz", "Low pass [Hz]"]]);

/// @param entry    what stands in it; is changed as the user types
/// @param fault    its place
/// @param names    id of the list of channels that are offered
/// @param changed  is called after each change
/**
 * @param {import("/measure/read_files.js").ChannelEntry} entry
 * @param {HTMLElement} fault
 * @param {string} names
 * @param {() => void} changed
 */
export function channelField(entry, fault, names, changed) {
  const unit = h("span", { class: "quiet" });
  const drawUnit = () => {
    unit.textContent = unitOf(entry.name) ? `[${unitOf(entry.name)}]` : "no unit yet";
  };
  const box = h("input", { type: "checkbox", onchange: () => { entry.isUsed = box.checked; changed(); } });
  box.checked = entry.isUsed;
  const name = h("input", { type: "text", value: entry.name, list: names,
    "aria-label": `Channel of the column ${entry.column}`,
    oninput: () => { entry.name = name.value; drawUnit(); changed(); } });
  drawUnit();
  const sensor = sensorFields.map(([key, label]) => {
    const input = h("input", { type: "text", inputmode: "decimal", size: 8, value: entry[key],
      oninput: () => { entry[key] = input.value; changed(); } });
    return h("label", { class: "choice" }, h("span", {}, label), input);
  });
  return h("div", { class: "field", role: "group", "aria-label": `Column ${entry.column}` },
    h("label", {}, box, ` ${entry.column}`), unit, h("div", { class: "values" }, name),
    h("details", { class: "whole" }, h("summary", { class: "small" }, "Sensor"),
      h("p", { class: "quiet small" }, "The signal is sign · gain · x(t + delay) + offset of the samples x."),
      h("p", { class: "actions" }, sensor)), fault);
}
