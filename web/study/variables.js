// SPDX-License-Identifier: Apache-2.0
// Names of the variables of fits and optimisations: parameters of jobs, of one run, and quantities of
// sensors.
import { nameOf, unitOf } from "/core/format.js";

const ofSensor = /^sensor\.(.+)\.(gain|offset|delay_s)$/;
const ofRun = /^runs\.(\d+)\.(.+)$/;

/// Unit of a variable; empty if it has none.
/** @param {string} path  @returns {string} */
export function unitOfVariable(path) {
  const [, channel, quantity] = ofSensor.exec(path) ?? [];
  if (quantity === "gain") return "";
  return unitOf(quantity === "offset" ? channel : path.replace(/\.\d+$/, ""));
}

/// "sensor.slider_acceleration_m_s2.gain" as "Gain of slider acceleration", "runs.1.clearance_mm" as
/// "Clearance of run 1".
/** @param {string} path  @returns {string} */
export function nameOfVariable(path) {
  const [, channel, quantity] = ofSensor.exec(path) ?? [];
  if (quantity) return `${nameOf(quantity)} of ${nameOf(channel).toLowerCase()}`;
  const [, run, inner] = ofRun.exec(path) ?? [];
  return run ? `${nameOf(inner)} of run ${run}` : nameOf(path);
}

/// Name with unit: "Clearance [mm]".
/** @param {string} path */
export function titleOfVariable(path) {
  const unit = unitOfVariable(path);
  return unit ? `${nameOfVariable(path)} [${unit}]` : nameOfVariable(path);
}
