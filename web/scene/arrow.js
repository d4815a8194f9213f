// SPDX-License-Identifier: Apache-2.0
// An arrow of a force in the scene. Its sizes go by the thickness of a bar.

/** @typedef {typeof import("three")} Three */
/** @typedef {import("three").Vector3} Vector3 */

const shaftRadius = 0.5;  // in radii of a bar, as the sizes below
const head = { radius: 1.6, length: 4 };

/// A cone along y with its base at the origin.
/** @param {Three} THREE  @param {number} radius  @param {import("three").Material} material */
export function headOf(THREE, radius, material) {
  return new THREE.Mesh(new THREE.ConeGeometry(head.radius * radius, head.length * radius, 24)
    .translate(0, 0.5 * head.length * radius, 0), material);
}

export class Arrow {
  /** @param {Three} THREE  @param {number} radius  @param {import("three").Material} material */
  constructor(THREE, radius, material) {
    this.THREE = THREE;
    this.radius = radius;
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(shaftRadius * radius, shaftRadius * radius, 1, 16)
      .translate(0, 0.5, 0), material);
    this.tip = headOf(THREE, radius, material);
    this.object = new THREE.Group().add(this.shaft, this.tip);
  }

  /// Draws it from a place along a unit vector. A head that does not fit is drawn smaller.
  /** @param {Vector3} place  @param {Vector3} along  @param {number} length */
  point(place, along, length) {
    const { THREE, radius, shaft, tip, object } = this;
    object.position.copy(place);
    object.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along);
    const scale = Math.min(1, length / (head.length * radius));
    tip.scale.setScalar(scale);
    tip.position.y = length - scale * head.length * radius;
    shaft.scale.set(scale, tip.position.y + 0.5 * scale * radius, scale);
  }
}
