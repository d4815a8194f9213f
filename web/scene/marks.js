// SPDX-License-Identifier: Apache-2.0
// Marks of the joints of a described linkage. Their sizes go by the thickness of the bars: a real clearance would be
// too small to be seen.
import { bushAlongZ, glassBox, rodAlongZ, seeThrough } from "/scene/shapes.js";

/**
 * An object on a body: where, and how it is turned.
 * @typedef {{ body: string, at: number[], turn: import("three").Quaternion, object: import("three").Object3D }} Mark
 */
/** @typedef {typeof import("three")} Three */

const origin = [0, 0, 0];
const kindsWithPin = new Set(["revolute", "cylindrical", "screw"]);
const degree = Math.PI / 180;
const opacity = 0.35;
const blockSide = 3.6;  // the larger one, in radii of a bar
const gap = 0.5;
const wall = 0.4;

/// Marks of a joint.
/// @param look   radius of a bar; colours by the names of the bodies
/// @param range  least and largest place of the journal along the axis [mm], of a joint with clearance
/**
 * @param {Three} THREE
 * @param {Api.DescribedJoint} joint
 * @param {{ radius: number, colourOf: (body: string) => string }} look
 * @param {[number, number] | undefined} range
 * @returns {Mark[]}
 */
export function marksOf(THREE, joint, { radius, colourOf }, range) {
  const { from, to, at_m: at = origin, to_at_m: toAt = origin, turned_deg: turned, to_turned_deg: toTurned } = joint;
  const material = new THREE.MeshStandardMaterial({ color: colourOf("ground") });
  const inner = innerPart(THREE, joint, radius, material);
  if (!range) return [{ body: from, at, turn: turnOf(THREE, turned, joint), object: inner }];
  const glass = seeThrough(new THREE.MeshStandardMaterial({ color: colourOf(from) }), opacity);
  return [{ body: from, at, turn: turnOf(THREE, turned, joint), object: outerPart(THREE, joint, radius, glass, range) },
    { body: to, at: joint.closes_loop ? toAt : origin, object: inner,
      turn: turnOf(THREE, joint.closes_loop ? toTurned : origin, joint) }];
}

/// From the frame of a contact, with z along the joint's axis and x and y along the next ones in turn, to the body's.
/** @param {Three} THREE  @param {number[] | undefined} turned  @param {Api.DescribedJoint} joint */
function turnOf(THREE, turned = origin, { axis = "z" }) {
  const [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((parts) => new THREE.Vector3(...parts));
  const [first, second, third] = { x: [y, z, x], y: [z, x, y], z: [x, y, z] }[axis];
  const [a, b, c] = turned.map((angle) => angle * degree);
  return new THREE.Quaternion().setFromEuler(new THREE.Euler(a, b, c, "ZYX"))
    .multiply(new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().makeBasis(first, second, third)));
}

/// A pin along the axis, a block, a ball.
/** @param {Three} THREE  @param {Api.DescribedJoint} joint */
function innerPart(THREE, joint, radius, material) {
  const { kind, clearance } = joint;
  if (kind === "prismatic") {
    const [width, height] = clearance ? blockOf(joint, radius) : [3 * radius, 3 * radius];
    return new THREE.Mesh(new THREE.BoxGeometry(width, height, 6 * radius), material);
  }
  if (kindsWithPin.has(kind)) {
    const pin = clearance ? { radius: 1.4 * radius, length: 7 * radius } : { radius: 1.6 * radius, length: 5 * radius };
    return rodAlongZ(THREE, pin, material);
  }
  return new THREE.Mesh(new THREE.SphereGeometry(1.8 * radius, 24, 12), material);
}

/// Width and height of a block in the proportion of the real one, not too thin to be seen.
/** @param {Api.DescribedJoint} joint  @param {number} radius */
function blockOf({ clearance }, radius) {
  const { block_width_mm: width = 1, block_height_mm: height = 1 } = clearance ?? {};
  const larger = Math.max(width, height);
  return [width, height].map((side) => blockSide * radius * Math.max(side / larger, 0.5));
}

/// The see-through part around a pin, block or ball, as long as the way of the journal along it asks.
/** @param {Three} THREE  @param {Api.DescribedJoint} joint  @param {[number, number]} range */
function outerPart(THREE, joint, radius, material, range) {
  if (joint.kind === "spherical") return new THREE.Mesh(new THREE.SphereGeometry(2.7 * radius, 32, 16), material);
  const [low, high] = range.map((place) => place / 1000);
  const part = joint.kind === "prismatic"
    ? slot(THREE, blockOf(joint, radius), radius, high - low + 9 * radius, material)
    : bushAlongZ(THREE, { inner: 2.1 * radius, outer: 2.7 * radius, length: high - low + 5 * radius }, material);
  part.position.z = (low + high) / 2;
  return new THREE.Group().add(part);
}

/// Two pairs of walls along z around a block.
/** @param {Three} THREE  @param {number[]} block */
function slot(THREE, [width, height], radius, length, material) {
  const [x, y] = [width / 2 + (gap + wall / 2) * radius, height / 2 + (gap + wall / 2) * radius];
  const walls = new THREE.Group();
  for (const side of [-1, 1]) {
    const [across, up] = [glassBox(THREE, [wall * radius, 2 * y - wall * radius, length], material),
      glassBox(THREE, [2 * x + wall * radius, wall * radius, length], material)];
    across.position.x = side * x;
    up.position.y = side * y;
    walls.add(across, up);
  }
  return walls;
}
