// SPDX-License-Identifier: Apache-2.0
// From what stands in the form of an upload to a request: the file as it is, or JSON where the form says
// more.
import { submitMeasurement } from "/core/api.js";
import { nameOf } from "/core/format.js";
import { faultOfNumber, numberOr } from "/form/numbers.js";

/** @typedef {import("/measure/read_files.js").Draft} Draft */
/** @typedef {import("/measure/read_files.js").ChannelEntry} ChannelEntry */

const types = { csv: "text/csv", npz: "application/x-npz" };

/// Channels that are sent. @param draft  without the column of the time
/** @param {Draft} draft */
export const usedChannels = ({ channels, time }) =>
  channels.filter(({ column, isUsed }) => isUsed && column !== time);

/// Numbers of a sensor where nothing is entered.
const usual = { sign: 1, gain: 1, offset: 0, delay_s: 0, low_pass_hz: null };
const sensorKeys = /** @type {(keyof typeof usual)[]} */ (Object.keys(usual));

/// Numbers of the sensor of a channel; NaN where the entry is none.
/** @param {ChannelEntry} entry  @returns {Record<string, any>} */
export const sensorOf = (entry) =>
  Object.fromEntries(sensorKeys.map((key) => [key, numberOr(entry[key], usual[key])]));

/// A channel as JSON, without what is as usual.
/** @param {ChannelEntry} entry */
function channelOf(entry) {
  const { source } = entry;
  const name = entry.name.trim();
  const given = Object.entries(sensorOf(entry)).filter(([key, value]) => value !== usual[key]);
  return { name, ...(source === name ? {} : { column: source }), ...Object.fromEntries(given) };
}

const isPlain = (entry) => Object.keys(channelOf(entry)).every((key) => key === "name" || key === "column");

/// Whether the file can be sent as it is: JSON alone says more of sensors and runs than the names of
/// channels.
/** @param {Draft} draft */
function isFileEnough(draft) {
  return draft.file !== null && draft.runs[0].parameters.trim() === "" && usedChannels(draft).every((entry) =>
    isPlain(entry) && !/[:,]/.test(entry.column));
}

/** @param {Draft} draft */
function asJson(draft) {
  const used = usedChannels(draft);
  return { name: draft.name, channels: used.map(channelOf),
    runs: draft.runs.map(({ columns, parameters }) => ({
    ...(parameters.trim() ? { parameters: JSON.parse(parameters) } : {}), time_s: columns[draft.time],
    values: Object.fromEntries(used.map(({ column, name }) => [name.trim(), columns[column]])) })) };
}

/// Sends what stands in the form. @throws a SyntaxError of parameters that are no JSON
/** @param {Draft} draft */
export function sendDraft(draft) {
  const { kind, file, time, name } = draft;
  if (file === null || kind === "json" || !isFileEnough(draft)) {
    return submitMeasurement(JSON.stringify(asJson(draft)), "application/json", {});
  }
  const channels = usedChannels(draft).map((entry) => `${entry.column}:${entry.name.trim()}`).join(",");
  return submitMeasurement(file, types[kind], { name, time, channels });
}

/// Faults of channels that need no service to be found: [index among all channels, text].
/** @param {Draft} draft  @returns {[number, string][]} */
export function faultsOf(draft) {
  const used = usedChannels(draft);
  return used.flatMap((entry) => {
    const twice = used.filter(({ name }) => name.trim() === entry.name.trim()).length > 1;
    const faulty = sensorKeys.find((key) => faultOfNumber(entry[key]));
    const fault = twice ? "two channels have this name"
      : faulty ? `${nameOf(faulty)}: ${faultOfNumber(entry[faulty])}` : "";
    return fault ? [/** @type {[number, string]} */ ([draft.channels.indexOf(entry), fault])] : [];
  });
}
