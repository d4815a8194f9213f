// SPDX-License-Identifier: Apache-2.0
// Reads files of a lab in the browser, so that they can be looked at before they are sent.
import { readNpz } from "/measure/npz.js";

/**
 * @typedef {{ column: string, source: string, name: string, isUsed: boolean, sign: string, gain: string, offset: string,
 *   delay_s: string, low_pass_hz: string }} ChannelEntry
 * @typedef {{ name: string, parameters: string, columns: Record<string, number[]> }} RunEntry
 * @typedef {{ name: string, kind: "csv" | "npz" | "json", time: string, columns: string[], channels:
 * ChannelEntry[],
 *   runs: RunEntry[], file: File | null }} Draft
 */

const usualTimes = ["time_s", "t_s"];

/** @type {(column: string, known?: any) => ChannelEntry} */
const entryOf = (column, known = {}) => ({ column, source: known.column ?? column, name: known.name ?? column.trim(), isUsed: true,
  sign: String(known.sign ?? 1), gain: String(known.gain ?? 1), offset: String(known.offset ?? 0),
  delay_s: String(known.delay_s ?? 0), low_pass_hz: String(known.low_pass_hz ?? "") });

/// A measurement that is not sent yet: each CSV or NPZ file is a run, a JSON file has all runs.
/** @param {File[]} files  @returns {Promise<Draft>} */
export async function readFiles(files) {
  const kinds = files.map(kindOf);
  if (kinds.includes("json")) {
    if (files.length > 1) throw new Error("A JSON file has all runs of a measurement: choose it alone.");
    return readJson(files[0]);
  }
  const runs = await Promise.all(files.map(async (file, index) => ({ name: file.name, parameters: "",
    columns: kinds[index] === "npz" ? await readNpz(await file.arrayBuffer())
      : columnsOf(await file.text()) })));
  const columns = Object.keys(runs[0].columns);
  const other = runs.find((run) => columns.some((column) => !(column in run.columns)));
  if (other) throw new Error(`${other.name} has other columns than ${runs[0].name}: runs have the same `
    + `channels.`);
  const time = usualTimes.find((name) => columns.includes(name)) ?? columns[0];
  return { name: files[0].name, kind: kinds[0], time, columns, runs, file: files.length === 1 ? files[0]
    : null,
    channels: columns.map((column) => entryOf(column)) };
}

/** @param {File} file  @returns {Draft["kind"]} */
function kindOf({ name }) {
  if (/\.json$/i.test(name)) return "json";
  return /\.np[zy]$/i.test(name) ? "npz" : "csv";
}

/** @param {File} file  @returns {Promise<Draft>} */
async function readJson(file) {
  let request;
  try {
    request = JSON.parse(await file.text());
  } catch (error) {
    throw new Error(`${file.name} is no JSON: ${error.message}`);
  }
  const { channels, runs, name = file.name } = request ?? {};
  if (!Array.isArray(channels) || !Array.isArray(runs) || runs.length === 0) {
    throw new Error(`${file.name} has no lists of channels and runs.`);
  }
  return { name, kind: "json", time: "time_s", columns: ["time_s", ...channels.map((each) => each.name)],
    file: null,
    channels: channels.map((each) => entryOf(each.name, each)),
    runs: runs.map((run, index) => ({ name: `run ${index}`, columns: { time_s: run.time_s, ...run.values },
      parameters: run.parameters ? JSON.stringify(run.parameters, null, 1) : "" })) };
}

/// Cells of a line, parted by commas that are not in quotes. A cell in quotes loses them; of two quotes in it
/// one stays.
/** @param {string} line */
function cellsOf(line) {
  const cells = [""];
  line.split("\"").forEach((part, index, parts) => {
    const isQuote = part === "" && index > 0 && index < parts.length - 1;
    const [first, ...more] = index % 2 === 1 ? [part] : isQuote ? ["\""] : part.split(",");
    cells[cells.length - 1] += first;
    cells.push(...more);
  });
  return cells;
}

/// Columns of a CSV text; a cell that is no number becomes NaN, and the service says which one it is.
/** @param {string} content */
function columnsOf(content) {
  const lines = content.split(/\r\n|\n|\r/);
  const names = cellsOf(lines[0].replace(/^\uFEFF/, "")).map((name) => name.trim());
  /** @type {number[][]} */
  const values = names.map(() => []);
  for (const line of lines.slice(1)) {
    if (line === "") continue;
    const cells = cellsOf(line);
    values.forEach((column, index) => column.push(cells[index]?.trim() ? Number(cells[index]) : NaN));
  }
  return Object.fromEntries(names.map((name, index) => [name, values[index]]));
}
