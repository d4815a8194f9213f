// SPDX-License-Identifier: Apache-2.0
// Camera, lights and ground for the linkage. It draws only when something has changed.
import { colour, isDark, onColours } from "/core/theme.js";
import { viewerOf } from "/scene/upright.js";

const usualAspect = 1.25;
const margin = 1.12;

export class Stage {
  /// @param shown  {reach, up, places}: size of the linkage [m], unit vector that is up, and places that the first
  /// look shows; null: unknown
  /**
   * @param {Awaited<ReturnType<typeof import("/scene/three.js").loadThree>>} libraries
   * @param {HTMLCanvasElement} canvas
   * @param {ReturnType<typeof import("/scene/scene_card.js").shownOf>} shown
   * @param {AbortSignal} signal
   */
  constructor({ THREE, OrbitControls }, canvas, { reach, up, places }, signal) {
    this.THREE = THREE;
    this.canvas = canvas;
    this.reach = reach;
    this.viewer = viewerOf(THREE, up);
    this.places = places?.map((place) => new THREE.Vector3(...place));
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, reach / 1000, reach * 20);
    this.camera.up.copy(this.viewer.up);  // before the controls, which take their axis from there
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener("change", () => this.request());
    const sky = new THREE.HemisphereLight("#ffffff", "#8090a0", 1.6);
    sky.position.copy(this.viewer.up);
    const sun = new THREE.DirectionalLight("#ffffff", 2.2);
    sun.position.copy(this.#seen(1, 2, 1.5));
    this.scene.add(sky, sun);
    this.drawGround();
    onColours(() => { this.drawGround(); this.request(); }, signal);
    const sizes = new ResizeObserver(() => this.fit());
    sizes.observe(canvas);
    signal.addEventListener("abort",
      () => { sizes.disconnect(); this.controls.dispose(); this.renderer.dispose(); this.ended = true; });
    this.fit();
    this.lookAtAll();
  }

  /// A vector by its parts to the right, up, and to the front.
  #seen(right, up, front) {
    const { viewer } = this;
    return new this.THREE.Vector3().addScaledVector(viewer.right, right).addScaledVector(viewer.up, up)
      .addScaledVector(viewer.front, front);
  }

  drawGround() {
    const { THREE, reach, viewer: { up } } = this;
    this.scene.background = new THREE.Color(colour("card"));
    if (this.ground) this.scene.remove(this.ground);
    this.ground = new THREE.GridHelper(2 * reach, 14, ...(isDark() ? ["#38414b", "#262e36"] : ["#d3d9df", "#e9edf0"]));
    const lowest = this.places ? Math.min(...this.places.map((place) => place.dot(up))) - 0.09 * reach : -0.45 * reach;
    this.ground.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up);
    this.ground.position.copy(up).multiplyScalar(lowest);
    this.scene.add(this.ground);
  }

  lookAtAll() {
    this.followed = null;
    if (this.places) this.#lookAtPlaces();
    else {
      // As far away as the narrower side of the picture needs.
      const away = this.reach * Math.max(1, usualAspect / this.camera.aspect);
      this.controls.target.copy(this.#seen(0.42, 0.03, 0.14)).multiplyScalar(this.reach);
      this.camera.position.copy(this.#seen(0.7, 0.5, 1.95)).multiplyScalar(away);
    }
    this.controls.update();
    this.request();
  }

  /// From the front and above, more so where the crank turns about the vertical; as near as all places allow.
  #lookAtPlaces() {
    const { THREE, camera, places = [], viewer: { up } } = this;
    const back = this.#seen(0.3, 0.3 + 0.5 * Math.abs(up.z), 1).normalize();
    const aside = up.clone().cross(back).normalize();
    const above = back.clone().cross(aside);
    const middle = new THREE.Box3().setFromPoints(places).getCenter(new THREE.Vector3());
    const slope = Math.tan((camera.fov * Math.PI) / 360);
    const distances = places.map((place) => {
      const from = place.clone().sub(middle);
      return from.dot(back)
        + margin * Math.max(Math.abs(from.dot(above)), Math.abs(from.dot(aside)) / camera.aspect) / slope;
    });
    this.controls.target.copy(middle);
    camera.position.copy(middle).addScaledVector(back, Math.max(...distances));
  }

  /// Looks at a moving point from a short distance, and goes with it.
  /// @param point  three.js' vector, read at each drawing
  /// @param axis   unit vector along which the camera looks, from the front and a little from the right and above
  follow(point, distance, axis) {
    const { viewer } = this;
    const along = axis.clone().multiplyScalar(axis.dot(viewer.front) < 0 ? -1 : 1);
    const aside = viewer.right.clone().addScaledVector(along, -viewer.right.dot(along)).normalize();
    const above = along.clone().cross(aside);
    this.followed = point;
    this.controls.target.copy(point);
    this.camera.position.copy(point)
      .add(along.addScaledVector(aside, 0.35).addScaledVector(above, 0.35).setLength(distance));
    this.controls.update();
    this.request();
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0) return;
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.request();
  }

  /// Draws at the next frame, once however often it is asked.
  request() {
    this.waiting ??= requestAnimationFrame(() => {
      this.waiting = undefined;
      if (this.ended) return;
      if (this.followed) {
        const moved = this.followed.clone().sub(this.controls.target);
        this.controls.target.add(moved);
        this.camera.position.add(moved);
      }
      this.renderer.render(this.scene, this.camera);
      this.canvas.dataset.up = this.camera.up.toArray().join(" ");
    });
  }
}
