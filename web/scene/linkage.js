// SPDX-License-Identifier: Apache-2.0
// The linkage as three.js sees it: made once from the parameters, then moved from instant to instant.
import { bushAlongZ, glassBox, measuresOf, rodAlongX, rodAlongZ, seeThrough } from "/scene/shapes.js";

export const linkColours = [["crank (1,1)", "#0072b2"], ["sliding rod (1,2)", "#56b4e9"],
  ["coupler (1,3) with bearing", "#e69f00"], ["slider (2,1)", "#009e73"],
  ["cross link (2,2) with journal", "#d55e00"]];
const tubePoints = 40;
const bushWall = 0.6;  // of the bearing's radius

export class Linkage {
  /// @param links  names as in the channels of the poses
  /** @param {typeof import("three")} THREE  @param {Api.Parameters} parameters  @param {string[]} links */
  constructor(THREE, parameters, links) {
    this.THREE = THREE;
    this.measures = measuresOf(parameters);
    this.group = new THREE.Group();
    const [crank, rod, coupler, slider, cross] =
      linkColours.map(([, colour]) =>
        new THREE.MeshStandardMaterial({ color: colour, roughness: 0.55, metalness: 0.1 }));
    const { measures } = this;
    seeThrough(slider, 0.25);
    if (measures.isBallInCrank) seeThrough(crank, 0.4);
    this.bodies = { "2_1": glassBox(THREE, measures.slider, slider) };
    this.tubes = {};
    const add = (link, measure, material, rigid) => {
      const elements = elementsOf(link, links);
      if (elements.length > 1) this.tubes[link] = { elements, ...measure,
        mesh: new THREE.Mesh(new THREE.BufferGeometry(), material) };
      else this.bodies[link] = rigid();
    };
    add("1_1", measures.crank, crank, () => rodAlongX(THREE, measures.crank, crank));
    add("1_2", measures.rod, rod, () => rodAlongX(THREE, measures.rod, rod));
    add("2_2", measures.cross, cross, () => rodAlongZ(THREE, measures.cross, cross, measures.arm / 2));
    this.couplerMaterial = coupler;
    this.coupler = { elements: elementsOf("1_3", links), ...measures.coupler,
      mesh: new THREE.Mesh(new THREE.BufferGeometry(), coupler) };
    this.ball = new THREE.Mesh(new THREE.SphereGeometry(1.6 * measures.coupler.radius, 32, 16), coupler);
    this.bush = new THREE.Group();
    const pivot = rodAlongZ(THREE, { length: 5 * measures.crank.radius, radius: 0.8 * measures.crank.radius },
      new THREE.MeshStandardMaterial({ color: "#7a8590" }));
    const guide = this.#makeGuide(pivot.material);
    this.group.add(...Object.values(this.bodies), ...Object.values(this.tubes).map(({ mesh }) => mesh),
      this.coupler.mesh, this.ball, this.bush, pivot, guide);
    this.drawBush(1);
  }

  /// A bar along the guide to both sides.
  #makeGuide(material) {
    const { THREE, measures: { crank, coupler, guide: { point, direction, angle } } } = this;
    const length = crank.length + coupler.length;
    const bar = rodAlongX(THREE, { length: 2 * length, radius: 0.002 }, material);
    bar.position.set(...point).addScaledVector(new THREE.Vector3(...direction), -length);
    bar.rotation.y = -angle;
    bar.name = "guide";
    return bar;
  }

  /// The bearing with its clearance so many times larger.
  drawBush(factor) {
    const { cross, clearance, bearing } = this.measures;
    const inner = cross.radius + factor * clearance;
    const wall = bushWall * (cross.radius + clearance);
    this.bushReach = inner + wall / 2;
    for (const child of this.bush.children) if (child instanceof this.THREE.Mesh) child.geometry.dispose();
    this.bush.clear();
    this.bush.add(bushAlongZ(this.THREE, { inner, outer: inner + wall, length: bearing.length }, this.couplerMaterial));
    this.bushFactor = factor;
  }

  /// @param frames  {link: [x, y, z, qx, qy, qz, qw]}
  /// @param clearance, bend  how many times larger the gap in the joint and the links' bend are drawn
  place(frames, { clearance, bend }) {
    setFrame(this.bodies["2_1"], frames["2_1"]);
    const crankOff = this.#placeArm("1_1", frames, bend);
    const ballOff = this.#placeArm("1_2", frames, bend, crankOff);
    const journalOff = this.#placeArm("2_2", frames, bend);
    const points = this.#axisOf(this.coupler, frames);
    const gap = points.at(-1).clone().sub(this.#journal(frames)).multiplyScalar(clearance - 1);
    if (clearance !== this.bushFactor) this.drawBush(clearance);
    const chord = points.at(-1).clone().sub(points[0]);
    const endOff = gap.add(journalOff);
    const drawn = exaggerate(points, chord, bend);
    drawn.forEach((point, k) =>
      point.add(ballOff.clone().lerp(endOff, points[k].clone().sub(points[0]).dot(chord) / chord.lengthSq())));
    setFrame(this.bush, frames[this.coupler.elements.at(-1)]);
    this.bush.position.copy(drawn.at(-1));
    endBefore(drawn, this.bushReach);
    this.#drawTube(this.coupler, drawn);
    this.ball.position.copy(drawn[0]);
  }

  /// Draws a link that is held at its root, bent from the line on which it would lie unbent. @param off  where its
  /// root is drawn, from where it is
  /// @returns the same of its end
  #placeArm(link, frames, bend, off = new this.THREE.Vector3()) {
    const { THREE, tubes: { [link]: tube }, bodies: { [link]: body } } = this;
    if (body) {
      setFrame(body, frames[link]);
      body.position.add(off);
      return off;
    }
    const points = this.#axisOf(tube, frames);
    const unbent = new THREE.Vector3(1, 0, 0)
      .applyQuaternion(new THREE.Quaternion(...frames[tube.elements[0]].slice(3)));
    const drawn = exaggerate(points, unbent, bend).map((point) => point.add(off));
    this.#drawTube(tube, drawn);
    return drawn.at(-1).clone().sub(points.at(-1));
  }

  #drawTube({ mesh, radius }, points) {
    const { THREE } = this;
    const curve = points.length > 2 ? new THREE.CatmullRomCurve3(points) : new THREE.LineCurve3(...points);
    mesh.geometry.dispose();
    mesh.geometry = new THREE.TubeGeometry(curve, points.length > 2 ? tubePoints : 1, radius, 16);
  }

  /// The journal's centre: where the cross link's arm ends.
  #journal(frames) {
    const { THREE, tubes: { "2_2": tube }, measures: { arm } } = this;
    if (tube) return this.#axisOf(tube, frames).at(-1);
    const [x, y, z, ...turn] = frames["2_2"];
    return new THREE.Vector3(0, 0, arm).applyQuaternion(new THREE.Quaternion(...turn)).add(new THREE.Vector3(x, y, z));
  }

  /// A link's axis: the origins of its elements, and its end. The first and the last element have half the others'
  /// length.
  #axisOf({ elements, length }, frames) {
    const { THREE } = this;
    const origins = elements.map((link) => new THREE.Vector3(...frames[link]));
    const lastLength = elements.length > 1 ? length / (elements.length - 1) / 2 : length;
    const turn = new THREE.Quaternion(...frames[elements.at(-1)].slice(3));
    return [...origins, origins.at(-1).clone().add(new THREE.Vector3(lastLength, 0, 0).applyQuaternion(turn))];
  }

  get joint() { return this.bush.position; }

  /// Where the force on the journal is drawn: in the bearing as it is drawn.
  journalAt() { return this.joint; }

  /// The bearing's axis now.
  get jointAxis() { return new this.THREE.Vector3(0, 0, 1).applyQuaternion(this.bush.quaternion); }
}

/// The frames of a link: its own, or those of its elements in their order.
function elementsOf(link, links) {
  const place = (name) => Number(name.slice(link.length + 1));
  return links.filter((name) => name === link || name.startsWith(`${link}_`)).sort((a, b) => place(a) - place(b));
}

function setFrame(body, [x, y, z, qx, qy, qz, qw]) {
  body.position.set(x, y, z);
  body.quaternion.set(qx, qy, qz, qw);
}

/// Points with their distance made larger from the straight line that leaves the first one in a direction.
function exaggerate(points, direction, factor) {
  const [start] = points;
  return points.map((point) => {
    const part = point.clone().sub(start).dot(direction) / direction.lengthSq();
    const foot = start.clone().addScaledVector(direction, part);
    return foot.add(point.clone().sub(foot).multiplyScalar(factor));
  });
}

/// Takes the last point of a line back by a distance: the coupler ends at its bush, not in the bore.
function endBefore(points, distance) {
  const [before, end] = points.slice(-2);
  end.lerp(before, Math.min(distance / end.distanceTo(before), 0.9));
}
