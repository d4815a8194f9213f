// SPDX-License-Identifier: Apache-2.0
// Picture of a described linkage in one position, drawn anew whenever its description changes.
import { h } from "/core/dom.js";
import { DescribedLinkage, channelsFor, reachOf } from "/scene/described.js";
import { Stage } from "/scene/stage.js";
import { loadThree } from "/scene/three.js";
import { upOf } from "/scene/upright.js";

const alike = 2;  // ratio of sizes up to which the camera stays as the user has turned it

export class Preview {
  element = h("div", { class: "preview" });
  /** @type {{ stage: Stage, reach: number, up: number[], life: AbortController } | null} */
  #shown = null;
  /** @type {import("three").Group | null} */
  #group = null;

  /** @param {AbortSignal} signal */
  constructor(signal) {
    this.signal = signal;
  }

  /// Draws a linkage. @param poses  [x, y, z, qx, qy, qz, qw] by the names of the links
  /** @param {Api.DescribedLinkage} linkage  @param {Record<string, number[]>} poses */
  async show(linkage, poses) {
    const libraries = await loadThree();
    if (this.signal.aborted) return;
    const { ranges, values } = channelsFor(linkage);
    const drawn = new DescribedLinkage(libraries.THREE, linkage, Object.keys(poses), ranges);
    drawn.place(poses, values);
    this.#stageFor(libraries, linkage, placesAround(libraries.THREE, drawn.group));
    if (this.#group) this.#remove(this.#group);
    this.#group = drawn.group;
    this.#shown?.stage.scene.add(drawn.group);
    this.#shown?.stage.request();
    this.element.dataset.bodies = String(drawn.bodies.size + drawn.beams.size);
  }

  /**
   * @param {Awaited<ReturnType<typeof loadThree>>} libraries
   * @param {Api.DescribedLinkage} linkage
   * @param {number[][]} places
   */
  #stageFor(libraries, linkage, places) {
    const reach = reachOf(linkage);
    const up = upOf(/** @type {Api.Parameters} */ ({ linkage }));
    const ratio = this.#shown ? reach / this.#shown.reach : Infinity;
    if (this.#shown && ratio < alike && ratio > 1 / alike && `${up}` === `${this.#shown.up}`) return;
    this.#shown?.life.abort();
    const canvas = h("canvas", { class: "scene", role: "img", tabindex: 0,
      "aria-label": "The linkage at t = 0 in three dimensions. Drag to turn it, wheel to come closer, "
        + "arrow keys to move." });
    this.element.replaceChildren(canvas);
    const life = new AbortController();
    const signal = AbortSignal.any([this.signal, life.signal]);
    const stage = new Stage(libraries, canvas, { reach, up, places }, signal);
    this.#shown = { stage, reach, up, life };
  }

  /** @param {import("three").Group} group */
  #remove(group) {
    group.removeFromParent();
    group.traverse((/** @type {any} */ part) => {
      part.geometry?.dispose();
      part.material?.dispose();
    });
  }
}

/// Corners of the box around an object.
/** @param {typeof import("three")} THREE  @param {import("three").Object3D} object */
function placesAround(THREE, object) {
  const { min, max } = new THREE.Box3().setFromObject(object);
  return [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => [x, y, z])));
}
