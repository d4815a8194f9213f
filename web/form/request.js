// SPDX-License-Identifier: Apache-2.0
// From what stands in the form to a request, and back.
import { faultOf, isContact, isInside, isOfRpsup, writtenAsJson } from "/form/fields.js";
import { jsonText } from "/form/json_text.js";
import { doubtOf, factorOf, readList, readNumber } from "/form/numbers.js";

/// Entry of a field at first. The unit is that of entry, empty for the unit of the field.
export const emptyEntry = () =>
  ({ mode: "one", text: "", from: "", to: "", count: "5", scale: "linear", chosen: [], unit: "" });

/// @param state  {name, priority, reuse, keep, executor, described, linkage, inside, cases, design,
/// replicates: {count, perturbation, seed, only, tolerance_factor}, entries: {path: entry}}
/// @returns {request, problems: [{path, detail}]}
export function buildRequest(fields, state) {
  const problems = [];
  /** @type {any} */
  const request = { name: state.name.trim() || undefined, parameters: {}, sweep: {} };
  const clearances = clearancesIn(state.linkage);
  for (const field of fields) {
    const entry = state.entries[field.path];
    const applies = !isDescription(state.linkage)
      || !(isOfRpsup(field.path) || isIdle(field.path, clearances));
    const refuse = (detail) => problems.push({ path: field.path, detail });
    if (entry && applies) addEntry(field, entry, request, refuse);
  }
  addJson("linkage", state.linkage, request.parameters, problems);
  const others = { described: {} };
  addJson("described", state.described, others, problems);
  Object.assign(request.parameters, others.described);
  const inside = {};
  addJson("inside", state.inside, inside, problems);
  Object.assign(request.sweep, inside.inside);
  if (Object.keys(request.parameters).length === 0) delete request.parameters;
  if (Object.keys(request.sweep).length === 0) delete request.sweep;
  addJson("cases", state.cases, request, problems);
  addJson("design", state.design, request, problems);
  addReplicates(state, request, problems);
  if (Number(state.priority) !== 0) request.priority = Number(state.priority);
  if (!state.reuse) request.reuse = false;
  if (state.keep) request.keep = state.keep;
  if (state.executor) request.executor = state.executor;
  return { request: JSON.parse(JSON.stringify(request)), problems };
}

/// The clearances of the joints that a text describes; null if it is no description, or cannot be read.
/** @param {string} text  @returns {any[] | null} */
export function clearancesIn(text) {
  try {
    return Object.values(JSON.parse(text).joints).map((joint) => joint.clearance)
      .filter((each) => each !== undefined);
  } catch {
    return null;
  }
}

/// Whether a parameter of the contact counts for no joint: all that have clearance give their own number.
/** @param {string} path  @param {any[] | null} clearances */
export function isIdle(path, clearances) {
  return clearances !== null && isContact(path) && clearances.every((each) => path in Object(each));
}

/// Whether a text describes a linkage, be it faulty.
/** @type {(text: string) => boolean} */
export const isDescription = (text) => text.trim().startsWith("{");

function addReplicates(state, request, problems) {
  if (Number(state.replicates.count) > 1) {
    const { count, perturbation, seed, only, tolerance_factor: factor } = state.replicates;
    const number = (name, value) => {
      const read = readNumber(String(value));
      if (!Number.isFinite(read)) problems.push({ path: `replicates: ${name}`, detail: "must be a number" });
      return read;
    };
    request.replicates = { count: Number(count), perturbation: number("perturbation", perturbation),
      seed: number("seed", seed) };
    addJson("only", only, request.replicates, problems);
    const tolerance = number("factor of the tolerances", factor);
    if (tolerance !== 1) request.replicates.tolerance_factor = tolerance;
  }
}

function addEntry(field, entry, request, refuse) {
  if (field.kind === "words") {
    if (entry.chosen.length === 1) setAtPath(request.parameters, field.path, entry.chosen[0]);
    if (entry.chosen.length > 1) request.sweep[field.path] = entry.chosen;
    return;
  }
  if (entry.mode === "range") {
    addRange(field, entry, request, refuse);
    return;
  }
  const isAxis = entry.mode === "list" && field.kind !== "numbers";
  const doubt = isAxis || field.kind === "numbers" ? "" : doubtOf(entry.text);
  const { values: typed, fault: unclear } = isAxis || field.kind === "numbers" || !isOneNumber(entry.text)
    ? readList(entry.text)
    : { values: [readNumber(entry.text)], fault: "" };
  const values = typed.map((value) => inUnit(field, entry, value));
  const fault = values.map((value) => faultOf(field, value)).find(Boolean);
  const empty = isAxis && values.length === 0
    ? "the list is empty: write values such as 0, 0.1, 0.2, or choose “one value”" : "";
  if (doubt || unclear || empty) refuse(doubt || unclear || empty);
  else if (fault) refuse(fault);
  else if (field.kind === "numbers" && values.length > 0) setAtPath(request.parameters, field.path, values);
  else if (isAxis) request.sweep[field.path] = values;
  else if (values.length > 1) refuse("is one value; choose “list” for several");
  else if (values.length === 1) setAtPath(request.parameters, field.path, values[0]);
}

const isOneNumber = (text) => Number.isFinite(readNumber(text));

/// A value in the unit of its field. Values are rounded to 12 digits, as those of ranges are.
function inUnit(field, entry, value) {
  const factor = factorOf(field, entry.unit);
  return factor === 1 ? value : Number((value * factor).toPrecision(12));
}

function addRange(field, entry, request, refuse) {
  const empty = ["from", "to"].filter((end) => entry[end].trim() === "");
  if (empty.length > 0) {
    refuse(`${empty.map((end) => `“${end}”`).join(" and ")} ${empty.length === 1 ? "is" : "are"} empty: write a number, or choose “one value”`);
    return;
  }
  const doubt = doubtOf(entry.from) || doubtOf(entry.to);
  if (doubt) {
    refuse(doubt);
    return;
  }
  const [from, to] = [entry.from, entry.to].map((text) => inUnit(field, entry, readNumber(text)));
  const range = { from, to, count: Number(entry.count || NaN) };
  const fault = faultOf(field, range.from) || faultOf(field, range.to);
  if (fault) refuse(fault);
  else if (!Number.isInteger(range.count) || range.count < 1) refuse("the count of a range is a whole number from 1");
  else if (entry.scale === "log" && range.from * range.to <= 0) refuse("a logarithmic range cannot reach or cross 0");
  else request.sweep[field.path] = entry.scale === "log" ? { ...range, scale: "log" } : range;
}

const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

const jsonKinds = {
  described: { fits: (value) => isObject(value) && Object.keys(value).every((key) => writtenAsJson.includes(key)),
    detail: `must be a JSON object of ${writtenAsJson.join(", ")}, such as `
      + "{\"crank_drive\": {\"law\": \"velocity_table\", \"times_s\": [0, 2], \"velocities_rad_s\": [0, 10]}}" },
  linkage: { fits: (value) => isObject(value) || value === "rpsup",
    detail: "must be a JSON object that describes a linkage, with bodies and joints" },
  only: { fits: (value) => isObject(value) && Object.values(value).every(Array.isArray),
    detail: "must be a JSON object of lists, such as {\"clearance_mm\": [0.25, 0.5]}" },
  inside: { fits: (value) => isObject(value) && Object.keys(value).every(isInside),
    detail: "must be a JSON object of axes, such as {\"linkage.bodies.rod.mass_kg\": [0.2, 0.4]}" },
  cases: { fits: Array.isArray, detail: "must be a JSON list of objects, such as [{\"clearance_mm\": 0.1}]" },
  design: { fits: (value) => typeof value?.over === "object",
    detail: "must be a JSON object with a type and parameters, such as {\"type\": \"sobol\", \"count\": 64, "
      + "\"over\": {\"clearance_mm\": {\"from\": 0.1, \"to\": 0.5}}}" },
};

/// Adds a part that is written as JSON: drives, the linkage, axes inside it, cases, the design, or values
/// with replicates.
function addJson(key, text, request, problems) {
  if (text.trim() === "") return;
  const { fits, detail } = jsonKinds[key];
  try {
    const value = JSON.parse(text);
    if (!fits(value)) throw new Error(detail);
    request[key] = value;
  } catch {
    problems.push({ path: key, detail });
  }
}

function setAtPath(object, path, value) {
  const [head, ...rest] = path.split(".");
  if (rest.length === 0) object[head] = value;
  else setAtPath(object[head] ??= {}, rest.join("."), value);
}

function valueAtPath(object, path) {
  return path.split(".").reduce((inner, key) => inner?.[key], object);
}

/// The form's state for a request that was sent before.
export function readRequest(fields, request = {}) {
  const entries = {};
  for (const field of fields) {
    const fixed = valueAtPath(request.parameters, field.path);
    const axis = request.sweep?.[field.path];
    if (fixed !== undefined && fixed !== null) entries[field.path] = entryOf(field, [fixed].flat(), "one");
    if (Array.isArray(axis)) entries[field.path] = entryOf(field, axis, "list");
    else if (axis !== undefined) entries[field.path] = { ...emptyEntry(), mode: "range", from: String(axis.from),
      to: String(axis.to), count: String(axis.count), scale: axis.scale ?? "linear" };
  }
  const { linkage } = request.parameters ?? {};
  const described = Object.fromEntries(Object.entries(request.parameters ?? {})
    .filter(([key]) => writtenAsJson.includes(key)));
  const inside = Object.fromEntries(Object.entries(request.sweep ?? {})
    .filter(([path]) => isInside(path)));
  return { linkage: isObject(linkage) ? jsonText(linkage) : "", inside: Object.keys(inside)
    .length > 0 ? JSON.stringify(inside, null, 1) : "",
    described: Object.keys(described).length > 0 ? JSON.stringify(described, null, 1) : "",
    name: request.name ?? "", priority: request.priority ?? 0, reuse: request.reuse ?? true, entries,
    keep: request.keep === "metrics" ? "metrics" : "", executor: request.executor ?? "",
    cases: request.cases ? JSON.stringify(request.cases, null, 1) : "",
    design: request.design ? JSON.stringify(request.design, null, 1) : "",
    replicates: { count: 1, perturbation: 1e-6, seed: 1, tolerance_factor: 1, ...request.replicates,
      only: request.replicates?.only ? JSON.stringify(request.replicates.only) : "" } };
}

function entryOf(field, values, mode) {
  return field.kind === "words" ? { ...emptyEntry(), chosen: values }
    : { ...emptyEntry(), mode, text: values.join(", ") };
}

/// Number of jobs of axes and replicates.
/** @param {any} request */
export function countJobs({ sweep = {}, replicates }) {
  const axes = Object.entries(sweep);
  const { count = 1, only = {} } = replicates ?? {};
  const replicated = product(
    axes.map(([path, axis]) => (path in only && Array.isArray(axis) ? axis.filter((value) => only[path].includes(value))
      .length : sizeOf(axis))));
  return product(axes.map(([, axis]) => sizeOf(axis))) + (count - 1) * replicated;
}

const product = (sizes) => sizes.reduce((all, size) => all * size, 1);

const sizeOf = (axis) => (Array.isArray(axis) ? axis.length : axis.count);
