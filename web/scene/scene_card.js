// SPDX-License-Identifier: Apache-2.0
// The linkage in 3-D, with what plays it.
import { findTrajectory } from "/core/api.js";
import { choice, h, part, swatch } from "/core/dom.js";
import { saveCanvas } from "/core/download.js";
import { number } from "/core/format.js";
import { DescribedLinkage, bodyColours, channelsOf, reachOf } from "/scene/described.js";
import { placesOf } from "/scene/geometry.js";
import { JointForces, forceFactors, forcesOf } from "/scene/joint_force.js";
import { Linkage, linkColours } from "/scene/linkage.js";
import { loadColour } from "/scene/loads.js";
import { Player, impactsOf } from "/scene/player.js";
import { Poses, linksOf } from "/scene/poses.js";
import { rangesOf } from "/scene/ranges.js";
import { Stage } from "/scene/stage.js";
import { loadThree } from "/scene/three.js";
import { upOf } from "/scene/upright.js";

const speeds = [1, 0.5, 0.1, 0.01, 0.001];
const factors = [1, 2, 5, 10, 20, 50, 100];
const bendFactors = [...factors, 200, 500, 1000];  // of steel tubes a bend is some micrometres
const impactPoints = 4000;

/// @param channels  of the run
/** @param {Api.Job} job  @param {string[]} channels  @param {TimeWindow} times  @param {AbortSignal} signal */
export function sceneCard(job, channels, times, signal) {
  const { linkage: given } = job.parameters;
  const described = typeof given === "object" ? given : null;
  const hasClearance = !described && job.parameters.clearance_mm > 0;
  const isFlexible = ["coupler", "crank", "rod", "cross"].some((link) => job.parameters[link] === "flexible");
  const drawn = { clearance: hasClearance ? 20 : 1, bend: isFlexible ? 20 : 1, force: 1 };
  const forces = forcesOf(job.parameters, channels);
  const scale = h("span");
  const canvas = h("canvas",
    { class: "scene", role: "img", tabindex: 0,
      "aria-label": "The linkage in three dimensions. Drag to turn it, wheel to come closer, arrow keys to move." });
  const status = h("p", { class: "quiet small" });
  const instant = h("output", { class: "small" });
  const player = new Player(times, signal);
  const play = h("button", { class: "main", onclick: () => player.toggle() }, "Play");
  const scrub = h("input",
    { type: "range", step: "any", class: "wide", "aria-label": "Instant [s]",
      oninput: () => times.pointAt(Number(scrub.value)) });
  let draw = () => {};

  function showInstant() {
    Object.assign(scrub, { min: times.from, max: times.to, value: times.instant });
    instant.textContent = `t = ${times.instant.toFixed(4)} s`;
    draw();
  }

  async function start() {
    const links = linksOf(channels);
    const { loads, journals } = described ? channelsOf(described, channels) : { loads: [], journals: [] };
    const followed = [...loads, ...forces.flatMap((force) => force.channels)];
    const [libraries, ranges] = await Promise.all([loadThree(), rangesOf(job, [...followed, ...journals], signal)]);
    if (signal.aborted) return;
    const { parameters } = job;
    const linkage = described ? new DescribedLinkage(libraries.THREE, described, links, ranges)
      : new Linkage(libraries.THREE, parameters, links);
    const stage = new Stage(libraries, canvas, shownOf(parameters), signal);
    stage.scene.add(linkage.group);
    const arrows = forces.length > 0 ? new JointForces(libraries.THREE, { job, forces, ranges,
      ...arrowSizes(job, linkage) }) : null;
    if (arrows) stage.scene.add(arrows.group);
    const poses = new Poses(job, { links, others: followed }, (error) => {
      status.textContent = error ? `${error.message} Trying again …` : "";
      if (!error) draw();
    }, signal);
    draw = () => {
      const shown = poses.at(times.instant, player.speed);
      if (!shown) return;
      if (linkage instanceof Linkage) linkage.place(shown.frames, drawn);
      else linkage.place(shown.frames, shown.values);
      if (arrows) {
        const sizes = arrows.place((force) => linkage.journalAt(force, shown.frames), shown.values, drawn.force);
        canvas.dataset.force = JSON.stringify(sizes);
        scale.textContent = arrows.scaleWords(drawn.force);
      }
      canvas.dataset.instant = String(times.instant);
      stage.request();
    };
    views.addEventListener("change", () => {
      if (linkage instanceof Linkage && part("select", views).value === "joint") {
        stage.follow(linkage.joint, 0.14 * stage.reach, linkage.jointAxis);
      } else stage.lookAtAll();
    });
    draw();
  }

  const views = choice("View", [["all", "whole linkage"], ["joint", "joint"]], "all", () => {});
  const enlarge = (label, key, to = factors) => choice(label, to.map((factor) => [String(factor), `× ${factor}`]),
    String(drawn[key]), (value) => { drawn[key] = Number(value); draw(); });
  const slow = h("input", { type: "checkbox", onchange: () => { player.slow = slow.checked; } });
  slow.checked = player.slow;
  player.addEventListener("change", () => { play.textContent = player.playing ? "Pause" : "Play"; });
  times.addEventListener("instant", showInstant, { signal });
  times.addEventListener("change", showInstant, { signal });
  showInstant();
  start().catch((error) => { status.textContent = `The linkage cannot be drawn: ${error.message}`; });
  if (hasClearance) findTrajectory(job.id,
    { channels: ["t_s", "slider_acceleration_min_m_s2", "slider_acceleration_max_m_s2"], points: impactPoints },
    signal).then((columns) => { player.impacts = impactsOf(columns); }).catch(() => {});

  return h("section", { class: "card", "aria-label": "Linkage" },
    h("div", { class: "head" }, h("h2", {}, "3-D view"),
      h("button", { onclick: () => saveCanvas(canvas, "linkage.png") }, "PNG")),
    canvas,
    h("p", { class: "actions" }, play, scrub, instant),
    h("p", { class: "actions" }, choice("Speed", speeds.map((speed) => [String(speed), `× ${number(speed)}`]),
      String(player.speed), (value) => { player.speed = Number(value); draw(); }), described ? null : views,
      hasClearance ? enlarge("Clearance scale", "clearance") : null,
      forces.length > 0 ? enlarge("Force scale", "force", forceFactors) : null,
      isFlexible ? enlarge("Deflection scale", "bend", bendFactors) : null,
      hasClearance ? h("label", { class: "small" }, slow, " slow motion at impacts") : null),
    h("p", { class: "legend small" }, (described ? bodyColours(described) : linkColours)
      .map(([name, colour]) => h("span", {}, swatch(colour), ` ${name}`)),
      forces.length > 0 ? h("span", {}, swatch(loadColour), " ", scale) : null), status);
}

/// Thickness of the arrows of forces, and the length that their scale is told in.
/** @param {Api.Job} job  @param {Linkage | DescribedLinkage} linkage */
function arrowSizes({ parameters }, linkage) {
  if (linkage instanceof Linkage) return { radius: 0.6 * linkage.measures.crank.radius,
    length: { size: parameters.crank_length_m, words: "force on the journal: as long as the crank" } };
  const size = Number((linkage.reach / 3).toPrecision(1));
  return { radius: 0.6 * linkage.radius, length: { size, words: `force on each journal: ${number(1000 * size)} mm` } };
}

/// Size, upward direction and points of a linkage, for the stage.
/**
 * @param {Api.Parameters} parameters
 * @returns {{ reach: number, up: number[], places: number[][] | null }}
 */
export function shownOf(parameters) {
  const { linkage } = parameters;
  const up = upOf(parameters);
  if (typeof linkage === "object") return { reach: reachOf(linkage), up, places: null };
  return { reach: parameters.crank_length_m + parameters.coupler_length_m, up, places: placesOf(parameters) };
}
