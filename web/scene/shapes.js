// SPDX-License-Identifier: Apache-2.0
// The links' shapes, from the parameters: lengths and bearing as they are given, thicknesses from mass and inertia.

import { guideOf, rodEnds } from "/scene/geometry.js";

/** @typedef {{ mass_kg: number, inertia_kg_m2: number[] }} Body */

/// Shapes of the links, from the parameters [m].
/** @param {Api.Parameters} parameters */
export function measuresOf(parameters) {
  const { links } = parameters;
  /** @type {(link: Body) => number} */
  const rodRadius = ({ mass_kg: mass, inertia_kg_m2: [axial] }) => Math.sqrt((2 * axial) / mass);
  return {
    crank: { length: parameters.crank_length_m, radius: rodRadius(links["1,1"]) },
    rod: { length: parameters.rod_length_m, radius: rodRadius(links["1,2"]) },
    coupler: { length: parameters.coupler_length_m, radius: parameters.coupler_diameter_mm / 2000 },
    slider: boxOf(links["2,1"]),
    cross: { length: parameters.cross_length_mm / 1000 || lengthOf(links["2,2"]),
      radius: (parameters.bearing_radius_mm - parameters.clearance_mm) / 1000 },
    arm: parameters.cross_length_mm / 1000,
    bearing: { length: parameters.bearing_length_mm / 1000 },
    clearance: parameters.clearance_mm / 1000,
    guide: guideOf(parameters),
    isBallInCrank: Math.min(...rodEnds(parameters).map(Math.abs)) < parameters.crank_length_m,
  };
}

/// The sides of a box of that mass and inertia.
/** @param {Body} body */
function boxOf({ mass_kg: mass, inertia_kg_m2: [x, y, z] }) {
  const side = (inertia) => Math.sqrt((6 * Math.max(inertia, 0)) / mass);
  return [side(y + z - x), side(x + z - y), side(x + y - z)];
}

/// The length of a round rod along z of that mass and inertia.
/** @param {Body} body */
function lengthOf({ mass_kg: mass, inertia_kg_m2: [x, , z] }) {
  return Math.sqrt((12 * Math.max(x - z / 2, 0)) / mass);
}

/// A round rod along x, from 0 to its length.
export function rodAlongX(THREE, { length, radius }, material) {
  const geometry = new THREE.CylinderGeometry(radius, radius, length, 32).rotateZ(-Math.PI / 2)
    .translate(length / 2, 0, 0);
  return new THREE.Mesh(geometry, material);
}

/// A round rod along z. @param middle  where it has its middle
export function rodAlongZ(THREE, { length, radius }, material, middle = 0) {
  return new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, length, 48).rotateX(Math.PI / 2)
    .translate(0, 0, middle), material);
}

/// A bush along z about the middle.
export function bushAlongZ(THREE, { inner, outer, length }, material) {
  const profile = [[inner, -1], [outer, -1], [outer, 1], [inner, 1],
    [inner, -1]].map(([radius, side]) => new THREE.Vector2(radius, (side * length) / 2));
  return new THREE.Mesh(new THREE.LatheGeometry(profile, 64).rotateX(Math.PI / 2), material);
}

/// A box seen through, with its edges.
export function glassBox(THREE, sides, material) {
  const geometry = new THREE.BoxGeometry(...sides);
  const box = new THREE.Mesh(geometry, material);
  box.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry),
    new THREE.LineBasicMaterial({ color: material.color })));
  return box;
}

/// Makes a material one that is seen through.
export function seeThrough(material, opacity) {
  return Object.assign(material, { transparent: true, opacity, depthWrite: false });
}
