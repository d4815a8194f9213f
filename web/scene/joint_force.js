// SPDX-License-Identifier: Apache-2.0
// Force of the bearing on the journal of the RPSUP linkage, as an arrow.
import { number } from "/core/format.js";
import { Arrow } from "/scene/arrow.js";
import { loadColour } from "/scene/loads.js";

/// Force of the coupler on the cross link, in the global frame.
export const forceChannels = ["reaction_x_n", "reaction_y_n", "reaction_z_n"];
/// Factors on the length of the arrow.
export const forceFactors = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50];
const longest = 1.5;  // of the largest force of the run at factor 1, in lengths of the crank

/// Largest force of a run [N].
/** @param {Api.Job} job  @param {import("/scene/ranges.js").Ranges} ranges */
export function largestForce({ metrics }, ranges) {
  const peak = metrics?.peak_joint_reaction_n;
  return typeof peak === "number" ? peak
    : Math.hypot(...forceChannels.map((name) => Math.max(...ranges[name].map(Math.abs))));
}

export class JointForce {
  /// @param largest  force of the run [N]  @param crank  length of the crank [m]
  /**
   * @param {typeof import("three")} THREE
   * @param {number} largest
   * @param {number} crank
   * @param {number} radius
   */
  constructor(THREE, largest, crank, radius) {
    this.THREE = THREE;
    this.largest = largest;
    this.crank = crank;
    const material = new THREE.MeshStandardMaterial({ color: loadColour, roughness: 0.55, depthTest: false });
    this.arrow = new Arrow(THREE, radius, material);
    this.arrow.object.traverse((part) => { part.renderOrder = 1; });  // it begins inside the bearing
  }

  /// Draws the force at an instant, and tells its size [N].
  /**
   * @param {import("three").Vector3} joint
   * @param {Record<string, number>} values
   * @param {number} factor
   */
  place(joint, values, factor) {
    const force = new this.THREE.Vector3(...forceChannels.map((name) => values[name] ?? 0));
    const size = force.length();
    const { arrow } = this;
    arrow.object.visible = size > 1e-3 * this.largest / factor;
    if (arrow.object.visible) arrow.point(joint, force.divideScalar(size), this.lengthOf(size, factor));
    return size;
  }

  /// Length of the arrow of a force [m].
  /** @param {number} size  @param {number} factor */
  lengthOf(size, factor) { return (factor * longest * this.crank * size) / this.largest; }

  /// Scale in words.
  /** @param {number} factor */
  scaleWords(factor) {
    return `force on the journal: as long as the crank at ${number(this.largest / (longest * factor), 3)} N`;
  }
}
