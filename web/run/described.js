// SPDX-License-Identifier: Apache-2.0
// Titles, channels and joints of a described linkage, by the names of its joints.

/// True for a job of a described linkage, false for one of the RPSUP linkage.
/** @type {(job: Pick<Api.Job, "parameters">) => boolean} */
export const isDescribed = (job) => typeof job.parameters.linkage === "object";

/// The linkage's title.
/** @type {(linkage: Api.DescribedLinkage) => string} */
export const titleOfLinkage = ({ name, joints }) => name ?? `Linkage of ${Object.keys(joints).length} joints`;

/// The channel that stands for the whole run: the first acceleration along a line, else the first one.
/** @param {string[]} channels */
export function mainAcceleration(channels) {
  return channels.find((name) => name.endsWith("_m_s2")) ?? channels.find((name) => name.endsWith("_rad_s2"))
    ?? channels[0];
}

/** @type {(channels: string[]) => string[]} */
export const driveChannels = (channels) => channels.filter((name) => /_drive_n(_m)?$/.test(name));

/// The joints with clearance in a run: {name, prefix, clearance}. @param prefix  of their channels
/** @param {Api.Job} job  @param {string[]} channels */
export function clearanceJoints({ parameters }, channels) {
  if (typeof parameters.linkage !== "object") return parameters.clearance_mm > 0
    ? [{ name: "", prefix: "", clearance: parameters.clearance_mm }] : [];
  return Object.entries(parameters.linkage.joints).filter(([name]) => channels.includes(`${name}_journal_x_mm`))
    .map(([name, joint]) =>
      ({ name, prefix: `${name}_`, clearance: joint.clearance?.clearance_mm ?? parameters.clearance_mm }));
}
