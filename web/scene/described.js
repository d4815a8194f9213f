// SPDX-License-Identifier: Apache-2.0
// A described linkage as three.js sees it: bars between the places where joints sit on a body, a mark for each
// joint, tubes for beams.
const colours = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#f0e442"];
const kindsWithAxis = new Set(["revolute", "cylindrical", "screw"]);
const degree = Math.PI / 180;
const springColour = "#7a8590";
const zigzags = 16;

/// The bodies with their colours, for the legend, and the springs' between them.
/** @param {Api.DescribedLinkage} linkage */
export function bodyColours({ bodies, springs }) {
  const named = Object.keys(bodies).map((name, index) => [name.replaceAll("_", " "), colours[index % colours.length]]);
  return springs ? [...named, ["springs", springColour]] : named;
}

/// The places on each body's frame that something sits at, its origin first. "ground" is a body, too.
/** @param {Api.DescribedLinkage} linkage */
function placesOn({ bodies, joints, springs = {} }) {
  const places = Object.fromEntries(
    ["ground", ...Object.keys(bodies)].map((name) => [name, name === "ground" ? [] : [[0, 0, 0]]]));
  for (const joint of Object.values(joints)) {
    places[joint.from].push(joint.at_m ?? [0, 0, 0]);
    if (joint.closes_loop) places[joint.to].push(joint.to_at_m ?? [0, 0, 0]);
  }
  for (const [name, body] of Object.entries(bodies)) {
    if (body.beam) places[name].push([body.beam.length_m, 0, 0]);
    else if (places[name].length === 1) places[name].push(body.centre_of_mass_m ?? [0, 0, 0]);
  }
  for (const { from, at_m: at = [0, 0, 0], to, to_at_m: toAt = [0, 0, 0] } of Object.values(springs)) {
    places[from].push(at);
    places[to].push(toAt);
  }
  return places;
}

/// About how large the linkage is [m]: as its two largest bodies in line.
/** @param {Api.DescribedLinkage} linkage */
export function reachOf(linkage) {
  const length = (points) => Math.max(0, ...points.map((point) => Math.hypot(...point)));
  const [largest, next = 0] = Object.values(placesOn(linkage)).map(length).sort((a, b) => b - a);
  return Math.max(0.05, largest + next);
}

export class DescribedLinkage {
  /// @param links  names as in the channels of the poses
  /** @param {typeof import("three")} THREE  @param {Api.DescribedLinkage} linkage  @param {string[]} links */
  constructor(THREE, linkage, links) {
    this.THREE = THREE;
    this.group = new THREE.Group();
    this.radius = 0.012 * reachOf(linkage);
    this.bodies = new Map();
    this.beams = new Map();
    const places = placesOn(linkage);
    const grey = new THREE.MeshStandardMaterial({ color: "#7a8590" });
    Object.entries(linkage.bodies).forEach(([name, body], index) => {
      const material = new THREE.MeshStandardMaterial({ color: colours[index % colours.length], roughness: 0.55,
        metalness: 0.1 });
      if (body.beam) this.addBeam(name, body.beam, links, material);
      else this.addBody(name, places[name], material);
    });
    for (const joint of Object.values(linkage.joints)) this.addJoint(joint, linkage, grey);
    this.springs = Object.values(linkage.springs ?? {}).map((spring) => this.#makeSpring(spring, linkage));
  }

  addBody(name, points, material) {
    const { THREE } = this;
    const body = new THREE.Group();
    for (const point of points.slice(1)) body.add(this.bar(new THREE.Vector3(), new THREE.Vector3(...point), material));
    body.add(new THREE.Mesh(new THREE.SphereGeometry(1.3 * this.radius, 24, 12), material));
    this.bodies.set(name, body);
    this.group.add(body);
  }

  addBeam(name, beam, links, material) {
    const elements = links.filter((link) => link.startsWith(`${name}_`) && /^\d+$/.test(link.slice(name.length + 1)))
      .sort((a, b) => Number(a.split("_").at(-1)) - Number(b.split("_").at(-1)));
    const tube = new this.THREE.Mesh(new this.THREE.BufferGeometry(), material);
    this.beams.set(name, { elements, end: beam.length_m / (elements.length - 1) / 2, tube });
    this.group.add(tube);
  }

  /// A round bar from one place to another.
  bar(from, to, material) {
    const { THREE } = this;
    const way = to.clone().sub(from);
    if (way.length() < 1e-9) return new THREE.Group();
    const mesh = new THREE.Mesh(new THREE.CylinderGeometry(this.radius, this.radius, way.length(), 20), material);
    mesh.position.copy(from).addScaledVector(way, 0.5);
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
    return mesh;
  }

  /// The joint's mark, on its first body: a pin along its axis, a box on a slide, a ball.
  addJoint({ kind, from, at_m: at = [0, 0, 0], turned_deg: turned = [0, 0, 0], axis = "z" }, { bodies }, material) {
    const { THREE, radius } = this;
    const pin = () => new THREE.CylinderGeometry(1.6 * radius, 1.6 * radius, 5 * radius, 24).rotateX(Math.PI / 2);
    const geometry = kind === "prismatic" ? new THREE.BoxGeometry(3 * radius, 3 * radius, 6 * radius)
      : kindsWithAxis.has(kind) ? pin() : new THREE.SphereGeometry(1.8 * radius, 24, 12);
    const mark = new THREE.Mesh(geometry, material);
    const along = { x: new THREE.Vector3(1, 0, 0), y: new THREE.Vector3(0, 1, 0), z: new THREE.Vector3(0, 0, 1) }[axis];
    const turn = new THREE.Quaternion()
      .setFromEuler(new THREE.Euler(turned[0] * degree, turned[1] * degree, turned[2] * degree, "ZYX"));
    mark.position.fromArray(at);
    mark.quaternion.copy(turn).multiply(new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), along));
    if (from === "ground") this.group.add(mark);
    else if (!bodies[from].beam) this.bodies.get(from).add(mark);
  }

  #makeSpring({ from, to, at_m: at = [0, 0, 0], to_at_m: toAt = [0, 0, 0] }, { bodies }) {
    const { THREE } = this;
    const line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: springColour }));
    line.frustumCulled = false;
    this.group.add(line);
    return { line, ends: [[from, at],
      [to, toAt]].map(([name, point]) => ({ name, point, length: bodies[name]?.beam?.length_m })) };
  }

  /// A zigzag from end to end.
  #placeSpring({ line, ends }, frames) {
    const { THREE, radius } = this;
    const [from, to] = ends.map((end) => this.#placeOn(end, frames));
    const way = to.clone().sub(from);
    const aside = new THREE.Vector3(0, 0, 1).cross(way);
    if (aside.lengthSq() < 1e-12 * way.lengthSq()) aside.set(1, 0, 0);
    aside.setLength(2 * radius);
    const points = Array.from({ length: zigzags + 1 }, (_, k) => {
      const side = k < 2 || k > zigzags - 2 ? 0 : k % 2 ? 1 : -1;
      return from.clone().addScaledVector(way, k / zigzags).addScaledVector(aside, side);
    });
    line.geometry.setFromPoints(points);
  }

  /// A point of a body; of a beam on the element that it is nearest to along the beam.
  #placeOn({ name, point: [x, y, z], length }, frames) {
    const { THREE } = this;
    if (name === "ground") return new THREE.Vector3(x, y, z);
    const beam = this.beams.get(name);
    const segment = beam ? length / (beam.elements.length - 1) : 0;
    const index = beam ? Math.min(Math.max(Math.floor(x / segment + 0.5), 0), beam.elements.length - 1) : 0;
    const [px, py, pz, ...turn] = frames[beam ? beam.elements[index] : name];
    const own = new THREE.Vector3(index > 0 ? x - (index - 0.5) * segment : x, y, z);
    return own.applyQuaternion(new THREE.Quaternion(...turn)).add(new THREE.Vector3(px, py, pz));
  }

  /// @param frames  {link: [x, y, z, qx, qy, qz, qw]}
  place(frames) {
    for (const [name, body] of this.bodies) {
      const [x, y, z, qx, qy, qz, qw] = frames[name];
      body.position.set(x, y, z);
      body.quaternion.set(qx, qy, qz, qw);
    }
    for (const beam of this.beams.values()) this.#placeBeam(beam, frames);
    for (const spring of this.springs) this.#placeSpring(spring, frames);
  }

  /// Through the origins of its elements, to its end: the last element has half the others' length.
  #placeBeam({ elements, end, tube }, frames) {
    const { THREE } = this;
    const points = elements.map((link) => new THREE.Vector3(...frames[link]));
    const last = new THREE.Quaternion(...frames[elements.at(-1)].slice(3));
    points.push(points.at(-1).clone().add(new THREE.Vector3(end, 0, 0).applyQuaternion(last)));
    tube.geometry.dispose();
    tube.geometry = new THREE.TubeGeometry(new THREE.CatmullRomCurve3(points), 40, this.radius, 12);
  }
}
