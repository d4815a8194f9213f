// SPDX-License-Identifier: Apache-2.0
// Loads on bodies as arrows. That of a torque is along the axis, with a ring around it that turns as the torque does.

export const loadColour = "#e6007a";
const longest = 24;  // in radii of a bar, as the sizes below
const shaftRadius = 0.5;
const head = { radius: 1.6, length: 4 };
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

  /// An arrow along y from the origin, in parts to be stretched.
  /** @param {Api.BodyLoad} load  @param {string} channel  @param {import("/scene/ranges.js").Ranges} ranges */
  #makeArrow(load, channel, ranges) {
    const { THREE, radius, material } = this;
    const shaft = new THREE.Mesh(new THREE.CylinderGeometry(shaftRadius * radius, shaftRadius * radius, 1, 16)
      .translate(0, 0.5, 0), material);
    const tip = this.#makeHead();
    const around = load.torque_n_m === undefined ? null : this.#makeRing();
    const object = new THREE.Group().add(shaft, tip, ...(around ? [around] : []));
    this.group.add(object);
    return { channel, load, object, shaft, tip, around, largest: Math.max(...ranges[channel].map(Math.abs)) };
  }

  /// A cone along y with its base at the origin.
  #makeHead() {
    const { THREE, radius, material } = this;
    return new THREE.Mesh(new THREE.ConeGeometry(head.radius * radius, head.length * radius, 24)
      .translate(0, 0.5 * head.length * radius, 0), material);
  }

  /// Three quarters of a ring around y, with a head.
  #makeRing() {
    const { THREE, radius, material } = this;
    const arc = new THREE.Mesh(new THREE.TorusGeometry(ring.radius * radius, shaftRadius * radius, 12, 48, ring.arc),
      material);
    const end = this.#makeHead();
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
    for (const arrow of this.arrows) {
      const { load: { body, at_m: at = [0, 0, 0], direction, follows_body: follows }, channel, object } = arrow;
      const value = values[channel];
      object.visible = Boolean(value);
      if (!object.visible) continue;
      const { position, turn } = frameAt({ body, at });
      const [x, y, z] = direction;
      const along = new THREE.Vector3(x, y, z).multiplyScalar(Math.sign(value)).normalize();
      if (follows) along.applyQuaternion(turn);
      object.position.copy(position);
      object.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along);
      this.#stretch(arrow, (longest * this.radius * Math.abs(value)) / arrow.largest);
    }
  }

  /// Gives an arrow its length. A head that does not fit is drawn smaller, and a ring as much smaller as the arrow.
  #stretch({ shaft, tip, around }, length) {
    const { radius } = this;
    const scale = Math.min(1, length / (head.length * radius));
    tip.scale.setScalar(scale);
    tip.position.y = length - scale * head.length * radius;
    shaft.scale.set(scale, tip.position.y + 0.5 * scale * radius, scale);
    around?.scale.setScalar(length / (longest * radius));
    around?.position.setY(ring.middle * length);
  }
}
