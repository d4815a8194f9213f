// SPDX-License-Identifier: Apache-2.0
// Titles, channels and joints of a described linkage, by the names of its joints.
import { nameOf, number, unitOf } from "/core/format.js";
import { withCrosses } from "/run/crosses.js";

/// True for a job of a described linkage, false for one of the RPSUP linkage.
/** @type {(job: Pick<Api.Job, "parameters">) => boolean} */
export const isDescribed = (job) => typeof job.parameters.linkage === "object";

/// The linkage's title.
/** @type {(linkage: Api.DescribedLinkage) => string} */
export const titleOfLinkage = ({ name, joints }) => name ?? `Linkage of ${Object.keys(joints).length} joints`;

/// Numbers and words of a job's parameters, or of a part of them, by their paths: {"linkage.bodies.rod.mass_kg": 0.2}.
/** @param {any} value  @param {string} path  @returns {Record<string, number | string>} */
export function leavesOf(value, path = "") {
  if (typeof value !== "object" || value === null) {
    return ["number", "string"].includes(typeof value) ? { [path]: value } : {};
  }
  return Object.assign({}, ...Object.entries(value).map(([key, inner]) => leavesOf(inner, path ? `${path}.${key}` : key)));
}

/// Numbers and words that a sweep varies, by their paths, with the values of a job.
/**
 * @param {Pick<Api.Job, "parameters">} job
 * @param {string[]} axes
 * @returns {[string, number | string][]}
 */
export function variedIn({ parameters }, axes) {
  const leaves = leavesOf(parameters);
  return axes.filter((axis) => axis in leaves).map((axis) => [axis, leaves[axis]]);
}

/// Values of a job of a sweep in words: "crank drive velocity 8 rad/s, rocker mass 0.3 kg".
/** @param {Pick<Api.Job, "parameters">} job  @param {string[]} axes */
export function settingOf(job, axes) {
  return variedIn(job, axes).map(([axis, value]) => [nameOf(axis).toLowerCase(),
    typeof value === "number" ? number(value, 6) : value, unitOf(axis)].filter(Boolean).join(" ")).join(", ");
}

/// The channel that stands for the whole run: the first acceleration along a line, else the first one.
/** @param {string[]} channels */
export function mainAcceleration(channels) {
  return channels.find((name) => name.endsWith("_m_s2")) ?? channels.find((name) => name.endsWith("_rad_s2"))
    ?? channels[0];
}

/// Freedoms that turn.
/** @type {(channels: string[]) => string[]} */
export const turningChannels = (channels) =>
  channels.filter((name) => name.endsWith("_rad") && channels.includes(`${name}_s`));

/** @type {(channels: string[]) => string[]} */
export const driveChannels = (channels) => channels.filter((name) => /_drive_n(_m)?$/.test(name));

/**
 * Outline of a joint's clearance across its axis [mm]: a circle of radius x = y, or a rectangle with half sides
 * x and y.
 * @typedef {{ isRound: boolean, x: number, y: number }} Clearance
 */

/// The joints with clearance in a run, two for a universal joint. prefix: of the joint's channels.
/**
 * @param {Pick<Api.Job, "parameters">} job
 * @param {string[]} channels
 * @returns {{ name: string, prefix: string, clearance: Clearance }[]}
 */
export function clearanceJoints({ parameters }, channels) {
  const { linkage, clearance_mm: usual } = parameters;
  if (typeof linkage !== "object") return usual > 0 ? [{ name: "", prefix: "", clearance: circle(usual) }] : [];
  return Object.entries(withCrosses(linkage).joints).filter(([name]) => channels.includes(`${name}_journal_x_mm`))
    .map(([name, joint]) => ({ name, prefix: `${name}_`, clearance: outlineOf(joint, usual) }));
}

/** @type {(radius: number) => Clearance} */
const circle = (radius) => ({ isRound: true, x: radius, y: radius });

/** @param {Api.DescribedJoint} joint  @param {number} usual  the job's own clearance  @returns {Clearance} */
function outlineOf({ kind, clearance = {} }, usual) {
  const { clearance_mm: x = usual, clearance_height_mm: y = x } = clearance;
  return kind === "prismatic" ? { isRound: false, x, y } : circle(x);
}

/// The clearance in words: "clearance 0.1 mm", of a rectangle "clearance 0.1 mm by 0.2 mm".
/** @type {(clearance: Clearance) => string} */
export const wordsOf = ({ isRound, x, y }) => `clearance ${number(x)} mm${isRound ? "" : ` by ${number(y)} mm`}`;
