// SPDX-License-Identifier: Apache-2.0
// Loads on bodies as arrows. That of a torque is along the axis, with a ring around it that turns as the torque does.
import { Arrow, headOf } from "/scene/arrow.js";

export const loadColour = "#e6007a";
const longest = 24;  // in radii of a bar, as the sizes below
const shaftRadius = 0.5;
const ring = { radius: 4.5, arc: 1.5 * Math.PI, middle: 0.6 };  // middle: part of the length of the arrow

/// Channel of a load's value.
/** @type {(name: string, load: Api.BodyLoad) => string} */
export const channelOf = (name, load) => `${name}${load.torque_n_m === undefined ? "_n" : "_n_m"}`;

export class Loads {
  /// @param ranges  of the values of the loads in the run; a load without one is not drawn
  /**
   * @param {typeof import("three")} THREE
   * @param {NonNullable<Api.DescribedLinkage["loads"]>} loads
   * @param {number} radius
   * @param {import("/scene/ranges.js").Ranges} ranges
   */
  constructor(THREE, loads, radius, ranges) {
    this.THREE = THREE;
    this.radius = radius;
    this.group = new THREE.Group();
    this.material = new THREE.MeshStandardMaterial({ color: loadColour, roughness: 0.55 });
    this.arrows = Object.entries(loads).filter(([name, load]) => channelOf(name, load) in ranges)
      .map(([name, load]) => this.#makeArrow(load, channelOf(name, load), ranges));
  }

  /// An arrow, that of a torque with a ring.
  /** @param {Api.BodyLoad} load  @param {string} channel  @param {import("/scene/ranges.js").Ranges} ranges */
  #makeArrow(load, channel, ranges) {
    const arrow = new Arrow(this.THREE, this.radius, this.material);
    const around = load.torque_n_m === undefined ? null : this.#makeRing();
    if (around) arrow.object.add(around);
    this.group.add(arrow.object);
    return { channel, load, arrow, around, largest: Math.max(...ranges[channel].map(Math.abs)) };
  }

  /// Three quarters of a ring around y, with a head.
  #makeRing() {
    const { THREE, radius, material } = this;
    const arc = new THREE.Mesh(new THREE.TorusGeometry(ring.radius * radius, shaftRadius * radius, 12, 48, ring.arc),
      material);
    const end = headOf(THREE, radius, material);
    end.position.set(Math.cos(ring.arc), Math.sin(ring.arc), 0).multiplyScalar(ring.radius * radius);
    end.rotation.z = ring.arc;
    const around = new THREE.Group().add(arc, end);
    around.rotation.x = -Math.PI / 2;
    return around;
  }

  /// @param values   by the names of the channels
  /// @param frameAt  position of a point of a body, and how the body is turned there
  /**
   * @param {Record<string, number>} values
   * @param {(place: { body: string, at: number[] }) =>
   *   { position: import("three").Vector3, turn: import("three").Quaternion }} frameAt
   */
  place(values, frameAt) {
    const { THREE } = this;
    for (const { load, channel, arrow, around, largest } of this.arrows) {
      const { body, at_m: at = [0, 0, 0], direction, follows_body: follows } = load;
      const value = values[channel];
      arrow.object.visible = Boolean(value);
      if (!arrow.object.visible) continue;
      const { position, turn } = frameAt({ body, at });
      const [x, y, z] = direction;
      const along = new THREE.Vector3(x, y, z).multiplyScalar(Math.sign(value)).normalize();
      if (follows) along.applyQuaternion(turn);
      const length = (longest * this.radius * Math.abs(value)) / largest;
      arrow.point(position, along, length);
      around?.scale.setScalar(length / (longest * this.radius));  // as much smaller as the arrow
      around?.position.setY(ring.middle * length);
    }
  }
}
