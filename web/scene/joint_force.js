// SPDX-License-Identifier: Apache-2.0
// Forces in joints with clearance, as arrows at journals.
import { withCrosses } from "/run/crosses.js";
import { number } from "/core/format.js";
import { Arrow } from "/scene/arrow.js";
import { loadColour } from "/scene/loads.js";

/** @typedef {{ key: string, channels: string[], peak: string, body: string, at: number[] }} Place */

/// Factors on the length of the arrows.
export const forceFactors = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const longest = 1.5;  // of the largest force of the run at factor 1, in units of length

/// Force of the coupler on the cross link of the RPSUP linkage, in the global frame.
/** @type {Place} */
const ofRpsup = { key: "joint", channels: ["reaction_x_n", "reaction_y_n", "reaction_z_n"],
  peak: "peak_joint_reaction_n", body: "cross", at: [0, 0, 0] };

/// Forces of a run that arrows can show: in the global frame, each on the second body of its joint, where the journal
/// sits on it.
/** @param {Api.Parameters} parameters  @param {string[]} channels  of the run  @returns {Place[]} */
export function forcesOf({ linkage, clearance_mm: clearance }, channels) {
  const all = typeof linkage === "object" ? Object.entries(withCrosses(linkage).joints).flatMap(placeOf)
    : clearance > 0 ? [ofRpsup] : [];
  return all.filter((force) => force.channels.every((name) => channels.includes(name)));
}

/** @param {[string, Api.DescribedJoint]} joint  @returns {Place[]} */
function placeOf([name, { clearance, to, closes_loop: closes, to_at_m: at = [0, 0, 0] }]) {
  if (!clearance) return [];
  return [{ key: name, channels: ["x", "y", "z"].map((axis) => `${name}_force_${axis}_n`),
    peak: `peak_${name}_reaction_n`, body: to, at: closes ? at : [0, 0, 0] }];
}

/// Largest of the forces in a run [N].
/** @param {Api.Job} job  @param {Place[]} forces  @param {import("/scene/ranges.js").Ranges} ranges */
function largestForce({ metrics }, forces, ranges) {
  return Math.max(...forces.map(({ peak, channels }) => {
    const known = metrics?.[/** @type {keyof typeof metrics} */ (peak)];
    return typeof known === "number" ? known
      : Math.hypot(...channels.map((name) => Math.max(...ranges[name].map(Math.abs))));
  }));
}

export class JointForces {
  /// @param forces  of the run, one at least  @param length  unit of length of the arrows [m], and how the scale begins
  /**
   * @param {typeof import("three")} THREE
   * @param {{ job: Api.Job, forces: Place[], ranges: import("/scene/ranges.js").Ranges,
   *   length: { size: number, words: string }, radius: number }} given
   */
  constructor(THREE, { job, forces, ranges, length, radius }) {
    this.THREE = THREE;
    this.largest = largestForce(job, forces, ranges);
    this.length = length;
    this.group = new THREE.Group();
    const material = new THREE.MeshStandardMaterial({ color: loadColour, roughness: 0.55, depthTest: false });
    this.arrows = forces.map((force) => ({ force, arrow: new Arrow(THREE, radius, material) }));
    for (const { arrow } of this.arrows) this.group.add(arrow.object);
    this.group.traverse((part) => { part.renderOrder = 1; });  // arrows begin inside bearings
  }

  /// Draws the forces at an instant, and tells their sizes [N] by the names of the joints.
  /// @param positionOf  gives that of a journal
  /**
   * @param {(force: Place) => import("three").Vector3} positionOf
   * @param {Record<string, number>} values
   * @param {number} factor
   */
  place(positionOf, values, factor) {
    return Object.fromEntries(this.arrows.map(({ force, arrow }) => {
      const way = new this.THREE.Vector3(...force.channels.map((name) => values[name] ?? 0));
      const size = way.length();
      arrow.object.visible = size > 1e-3 * this.largest / factor;
      if (arrow.object.visible) {
        arrow.point(positionOf(force), way.divideScalar(size),
          (factor * longest * this.length.size * size) / this.largest);
      }
      return [force.key, size];
    }));
  }

  /// Scale in words.
  /** @param {number} factor */
  scaleWords(factor) {
    return `${this.length.words} at ${number(this.largest / (longest * factor), 3)} N`;
  }
}
