// SPDX-License-Identifier: Apache-2.0
// From what stands in the form of an upload to a request: the file as it is, or JSON where the form says
// more.
import { submitMeasurement } from "/core/api.js";

/** @typedef {import("/measure/read_files.js").Draft} Draft */
/** @typedef {import("/measure/read_files.js").ChannelEntry} ChannelEntry */

const types = { csv: "text/csv", npz: "application/x-npz" };

/// Channels that are sent. @param draft  without the column of the time
/** @param {Draft} draft */
export const usedChannels = ({ channels, time }) =>
  channels.filter(({ column, isUsed }) => isUsed && column !== time);

/// A channel as JSON, without what is as usual.
/** @param {ChannelEntry} entry */
function channelOf({ source, name, sign, gain, offset, delay_s: delay, low_pass_hz: low }) {
  /** @type {Record<string, [string, number | string]>} */
  const numbers = { sign: [sign, 1], gain: [gain, 1], offset: [offset, 0], delay_s: [delay, 0],
    low_pass_hz: [low, ""] };
  const given = Object.entries(numbers)
    .filter(([, [text, usual]]) => text.trim() !== "" && Number(text) !== usual);
  return { name: name.trim(), ...(source === name.trim() ? {} : { column: source }),
    ...Object.fromEntries(given.map(([key, [text]]) => [key, Number(text)])) };
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
    const numbers = [entry.gain, entry.offset, entry.delay_s, entry.low_pass_hz];
    const fault = twice ? "two channels have this name"
      : numbers.some((text) => !Number.isFinite(Number(text))) ? "must be numbers" : "";
    return fault ? [/** @type {[number, string]} */ ([draft.channels.indexOf(entry), fault])] : [];
  });
}
