// SPDX-License-Identifier: Apache-2.0
// Parts of a described linkage, and places in it, in words.
import { number } from "/core/format.js";

/** @type {(name: string) => string} */
const spaced = (name) => name.replaceAll("_", " ");
/** @type {(value: any) => boolean} */
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
/** @type {(value: any) => [string, any][]} */
const entriesOf = (value) => (isObject(value) ? Object.entries(value) : [])
  .filter(([, each]) => isObject(each));

/// Drive of a freedom in words: "driven by run up", "driven by a dc motor".
function driveOf(drive) {
  if (!isObject(drive)) return "";
  return `driven by ${drive.law ? "" : "actuator "}${spaced(String(drive.law ?? drive.actuator))}`;
}

function clearanceOf({ clearance_mm: own, clearance_height_mm: height }, usual) {
  const size = own ?? usual;
  const words = size === undefined ? "with the job's clearance" : `clearance ${number(size)} mm`;
  return height === undefined ? words : `${words} by ${number(height)} mm`;
}

/// "revolute, crank → rod, clearance 0.1 mm, closes the loop"
function jointWords(joint, usual) {
  const { kind = "no kind", from = "?", to = "?", drive, freedoms, clearance, closes_loop: closes } = joint;
  const driven = entriesOf(freedoms).filter(([, freedom]) => freedom.drive)
    .map(([name, freedom]) => `${spaced(name)} ${driveOf(freedom.drive)}`);
  return [spaced(String(kind)), `${spaced(String(from))} → ${spaced(String(to))}`,
    isObject(clearance) ? clearanceOf(clearance, usual) : "", driveOf(drive), ...driven,
    closes ? "closes the loop" : ""].filter(Boolean).join(", ");
}

function bodyWords({ mass_kg: mass, beam }) {
  const elements = isObject(beam) && typeof beam.elements === "number" ? ` of ${beam.elements} elements` : "";
  const weight = typeof mass === "number" ? `${number(mass)} kg` : "";
  const shape = isObject(beam) ? (beam.elements === 1 ? "rigid beam" : `flexible beam${elements}`) : "";
  return [weight, shape, weight || beam ? "" : "no mass given"]
    .filter(Boolean).join(", ");
}

/// The parts of a linkage by kind: name, words and pointer of each. @param usual  the job's clearance [mm]
/**
 * @param {any} linkage
 * @param {number | undefined} usual
 * @returns {{ title: string, parts: { name: string, words: string, pointer: string }[] }[]}
 */
export function partsOf({ bodies, joints, springs, loads, accelerometers }, usual) {
  const listed = (title, key, members, words) => ({ title, parts: entriesOf(members).map(([name, each]) =>
    ({ name: spaced(name), words: words(each), pointer: `/${key}/${name}` })) });
  return [listed("Bodies", "bodies", bodies, bodyWords),
    listed("Joints", "joints", joints, (joint) => jointWords(joint, usual)),
    listed("Springs", "springs", springs, ({ from = "?", to = "?" }) =>
      `${spaced(String(from))} → ${spaced(String(to))}`),
    listed("Loads", "loads", loads, ({ body = "?", torque_n_m: torque }) =>
      `${torque === undefined ? "force" : "torque"} on ${spaced(String(body))}`),
    listed("Accelerometers", "accelerometers", accelerometers,
      ({ body = "?" }) => `on ${spaced(String(body))}`)]
    .filter(({ parts }) => parts.length > 0);
}

/** @type {(key: string) => string} */
const escaped = (key) => key.replaceAll("~", "~0").replaceAll("/", "~1");
/** @type {(key: string) => string} */
const unescaped = (key) => key.replaceAll("~1", "/").replaceAll("~0", "~");

/** @type {Record<Api.PartsOfLinkage, string>} */
const kinds = { bodies: "body", joints: "joint", springs: "spring", loads: "load",
  accelerometers: "accelerometer" };

/// Keys of a pointer of the service, which may be written with slashes or dots.
/** @param {string} pointer  @returns {string[]} */
function keysOf(pointer) {
  const keys = pointer.startsWith("/") ? pointer.slice(1).split("/").map(unescaped) : pointer.split(".");
  return keys[0] === "parameters" ? keys.slice(1) : keys;
}

/// Pointer into the linkage's text that a pointer of the service means; null: outside the linkage.
/** @param {string} pointer */
export function inLinkage(pointer) {
  const [first, ...keys] = keysOf(pointer);
  return first === "linkage" ? keys.map((key) => `/${escaped(key)}`).join("") : null;
}

/// A pointer of the service in words: "joint crank pin, at_m".
/** @param {string} pointer */
export function wordsOfPointer(pointer) {
  const [first = "", kind = "", name, ...rest] = keysOf(pointer);
  if (first !== "linkage") return keysOf(pointer).join(", ");
  if (!(kind in kinds) || name === undefined) return kind || "linkage";
  return [`${kinds[kind]} ${spaced(name)}`, ...rest].join(", ");
}
