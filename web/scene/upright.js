// SPDX-License-Identifier: Apache-2.0
// The direction that is up in the picture, against gravity, and the directions of the viewer by it.

const axes = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const usual = axes.y;

/// The unit vector against gravity; y without gravity. Of a described linkage its own gravity counts, if it has
/// one, else y is up.
/// Jobs of older programs have gravity along -y.
/** @param {Api.Parameters} parameters */
export function upOf({ linkage, gravity_m_s2: gravity, gravity_direction: direction = "-y" }) {
  if (typeof linkage === "object") return unit((linkage.gravity_m_s2 ?? [0, 0, 0]).map((part) => -part));
  const sign = direction.startsWith("-") ? 1 : -1;
  return unit(axes[direction.at(-1)].map((part) => sign * gravity * part));
}

function unit(vector) {
  const length = Math.hypot(...vector);
  return length > 0 ? vector.map((part) => part / length + 0) : usual;  // + 0: no -0
}

/// Unit vectors by which a viewer stands: right, up, and front, from the linkage towards the viewer.
/// x points right unless it is vertical.
/** @param {typeof import("three")} THREE  @param {number[]} up */
export function viewerOf(THREE, up) {
  const upward = new THREE.Vector3(...up);
  const [x, z] = [axes.x, axes.z].map((axis) => new THREE.Vector3(...axis));
  const right = (Math.abs(upward.x) < 0.9 ? x.addScaledVector(upward, -upward.x) : upward.clone().cross(z)).normalize();
  return { right, up: upward, front: right.clone().cross(upward) };
}
