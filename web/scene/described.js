// SPDX-License-Identifier: Apache-2.0
// A described linkage as three.js sees it: bars between the places where joints sit on a body, marks for joints, tubes
// for beams, arrows for loads.
import { withCrosses } from "/run/crosses.js";
import { Loads, channelOf, loadColour } from "/scene/loads.js";
import { marksOf } from "/scene/marks.js";

const colours = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#f0e442"];
const groundColour = "#7a8590";
const springColour = "#7a8590";
const zigzags = 16;

/// The bodies with their colours, for the legend, and the colours of springs and loads.
/** @param {Api.DescribedLinkage} linkage  @returns {[string, string][]} */
export function bodyColours(linkage) {
  /** @type {(entry: [string, string]) => [string, string]} */
  const spaced = ([name, colour]) => [name.replaceAll("_", " "), colour];
  /** @type {(name: string, isThere: any, colour: string) => [string, string][]} */
  const others = (name, isThere, colour) => (isThere ? [[name, colour]] : []);
  return [...Object.entries(coloursOf(linkage)).map(spaced),
    ...others("springs", Object.values(linkage.springs ?? {}).some(isSpring), springColour), ...others("loads", linkage.loads, loadColour)];
}

/// Colours by the order of the names: the service hands out the bodies in another order than they were
/// written in.
/** @param {Api.DescribedLinkage} linkage  @returns {Record<string, string>} */
function coloursOf(linkage) {
  return Object.fromEntries(Object.keys(withCrosses(linkage).bodies).sort()
    .map((name, index) => [name, colours[index % colours.length]]));
}

/// Channels that the picture needs beside the poses: those of loads, at each instant, and those of the places of
/// journals along their axes, of which it needs the ranges.
/** @param {Api.DescribedLinkage} linkage  @param {string[]} channels  of the run */
export function channelsOf(linkage, channels) {
  const loads = Object.entries(linkage.loads ?? {}).map(([name, load]) => channelOf(name, load));
  const journals = Object.keys(withCrosses(linkage).joints).map(journalOf);
  return { loads: loads.filter((name) => channels.includes(name)),
    journals: journals.filter((name) => channels.includes(name)) };
}

/// Ranges and values of the same channels for a picture of one position: loads at their full length,
/// journals in the middle of their bearings.
/** @param {Api.DescribedLinkage} linkage */
export function channelsFor(linkage) {
  const loads = Object.entries(linkage.loads ?? {}).map(([name, load]) => channelOf(name, load));
  const journals = Object.entries(withCrosses(linkage).joints).filter(([, { clearance }]) => clearance)
    .map(([name]) => journalOf(name));
  /** @type {(names: string[], range: [number, number]) => import("/scene/ranges.js").Ranges} */
  const all = (names, range) => Object.fromEntries(names.map((name) => [name, range]));
  return { ranges: { ...all(loads, [0, 1]), ...all(journals, [0, 0]) },
    values: Object.fromEntries(loads.map((name) => [name, 1])) };
}

/** @type {(joint: string) => string} */
const journalOf = (joint) => `${joint}_journal_z_mm`;

const isSpring = (spring) => Boolean(spring.stiffness_n_m || spring.damping_n_s_m);

/// The places on each body's frame that something sits at, its origin first. "ground" is a body, too.
/** @param {Api.DescribedLinkage} linkage */
function placesOn({ bodies, joints, springs = {}, loads = {} }) {
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
  for (const { from, at_m: at = [0, 0, 0], to, to_at_m: toAt = [0, 0, 0] } of Object.values(springs).filter(isSpring)) {
    places[from].push(at);
    places[to].push(toAt);
  }
  for (const { body, at_m: at } of Object.values(loads)) if (at) places[body].push(at);
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
  /// @param links   names as in the channels of the poses
  /// @param ranges  of the channels of loads and journals
  /**
   * @param {typeof import("three")} THREE
   * @param {Api.DescribedLinkage} given
   * @param {string[]} links
   * @param {import("/scene/ranges.js").Ranges} ranges
   */
  constructor(THREE, given, links, ranges) {
    const linkage = withCrosses(given);
    const bodyColour = coloursOf(given);
    this.THREE = THREE;
    this.group = new THREE.Group();
    this.reach = reachOf(linkage);
    this.radius = 0.012 * this.reach;
    this.bodies = new Map();
    this.beams = new Map();
    /** @type {import("/scene/marks.js").Mark[]} */
    this.marksOnBeams = [];
    const places = placesOn(linkage);
    for (const [name, body] of Object.entries(linkage.bodies)) {
      const material = new THREE.MeshStandardMaterial({ color: bodyColour[name], roughness: 0.55, metalness: 0.1 });
      if (body.beam) this.addBeam(name, body.beam, links, material);
      else this.addBody(name, places[name], material);
    }
    const look = { radius: this.radius, colourOf: (name) => bodyColour[name] ?? groundColour };
    for (const [name, joint] of Object.entries(linkage.joints)) {
      for (const mark of marksOf(THREE, joint, look, ranges[journalOf(name)])) this.#addMark(mark);
    }
    // Drag alone has no shape.
    this.springs = Object.values(linkage.springs ?? {}).filter(isSpring).map((spring) => this.#makeSpring(spring));
    this.loads = new Loads(THREE, linkage.loads ?? {}, this.radius, ranges);
    this.group.add(this.loads.group);
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
    this.beams.set(name, elements.length === 0 ? { elements: [name], end: beam.length_m, tube }
      : { elements, end: beam.length_m / (elements.length - 1) / 2, tube });
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

  /// Puts a mark on its body; one on a beam is moved with each frame.
  /** @param {import("/scene/marks.js").Mark} mark */
  #addMark(mark) {
    mark.object.position.fromArray(mark.at);
    mark.object.quaternion.copy(mark.turn);
    if (this.beams.has(mark.body)) this.marksOnBeams.push(mark);
    (this.bodies.get(mark.body) ?? this.group).add(mark.object);
  }

  #makeSpring({ from, to, at_m: at = [0, 0, 0], to_at_m: toAt = [0, 0, 0] }) {
    const { THREE } = this;
    const line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: springColour }));
    line.frustumCulled = false;
    this.group.add(line);
    return { line, ends: [{ body: from, at }, { body: to, at: toAt }] };
  }

  /// A zigzag from end to end.
  #placeSpring({ line, ends }, frames) {
    const { THREE, radius } = this;
    const [from, to] = ends.map((end) => this.#frameAt(end, frames).position);
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

  /// Position of a point of a body, and how the body is turned there; of a beam that of the element nearest to it.
  /** @param {{ body: string, at: number[] }} place */
  #frameAt({ body, at: [x, y, z] }, frames) {
    const { THREE } = this;
    if (body === "ground") return { position: new THREE.Vector3(x, y, z), turn: new THREE.Quaternion() };
    const { elements, end } = this.beams.get(body) ?? { elements: [body], end: 0 };
    const last = elements.length - 1;
    const index = last > 0 ? Math.min(Math.max(Math.floor((x / end + 1) / 2), 0), last) : 0;
    const [px, py, pz, ...parts] = frames[elements[index]];
    const turn = new THREE.Quaternion(...parts);
    const own = new THREE.Vector3(index > 0 ? x - (2 * index - 1) * end : x, y, z);
    return { position: own.applyQuaternion(turn).add(new THREE.Vector3(px, py, pz)), turn };
  }

  /// Position of a journal, ball or block on its body.
  /** @param {{ body: string, at: number[] }} place  @param {Record<string, number[]>} frames */
  journalAt(place, frames) { return this.#frameAt(place, frames).position; }

  /// @param frames  {link: [x, y, z, qx, qy, qz, qw]}
  /// @param values  of the channels of the loads
  place(frames, values) {
    for (const [name, body] of this.bodies) {
      const [x, y, z, qx, qy, qz, qw] = frames[name];
      body.position.set(x, y, z);
      body.quaternion.set(qx, qy, qz, qw);
    }
    for (const beam of this.beams.values()) this.#placeBeam(beam, frames);
    for (const spring of this.springs) this.#placeSpring(spring, frames);
    for (const mark of this.marksOnBeams) {
      const { position, turn } = this.#frameAt(mark, frames);
      mark.object.position.copy(position);
      mark.object.quaternion.copy(turn).multiply(mark.turn);
    }
    this.loads.place(values, (place) => this.#frameAt(place, frames));
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
