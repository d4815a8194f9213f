// Camera, lights and ground for the linkage. It draws only when something has changed.
import { colour, isDark, onColours } from "/core/theme.js";

const usualAspect = 1.25;

/// @param reach  the size of what is shown [m]
export class Stage {
  constructor({ THREE, OrbitControls }, canvas, reach, signal) {
    this.THREE = THREE;
    this.canvas = canvas;
    this.reach = reach;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, reach / 1000, reach * 20);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener("change", () => this.request());
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#8090a0", 1.6));
    const sun = new THREE.DirectionalLight("#ffffff", 2.2);
    sun.position.set(1, 2, 1.5);
    this.scene.add(sun);
    this.drawGround();
    onColours(() => { this.drawGround(); this.request(); }, signal);
    const sizes = new ResizeObserver(() => this.fit());
    sizes.observe(canvas);
    signal.addEventListener("abort", () => { sizes.disconnect(); this.controls.dispose(); this.renderer.dispose(); this.ended = true; });
    this.fit();
    this.lookAtAll();
  }

  drawGround() {
    this.scene.background = new this.THREE.Color(colour("card"));
    if (this.ground) this.scene.remove(this.ground);
    this.ground = new this.THREE.GridHelper(2 * this.reach, 14, ...(isDark() ? ["#38414b", "#262e36"] : ["#d3d9df", "#e9edf0"]));
    this.ground.position.y = -0.45 * this.reach;
    this.scene.add(this.ground);
  }

  lookAtAll() {
    this.followed = null;
    this.controls.target.set(0.42 * this.reach, 0.03 * this.reach, 0.14 * this.reach);
    // As far away as the narrower side of the picture needs.
    const away = this.reach * Math.max(1, usualAspect / this.camera.aspect);
    this.camera.position.set(0.7 * away, 0.5 * away, 1.95 * away);
    this.controls.update();
    this.request();
  }

  /// Looks at a moving point from a short distance, and goes with it.
  /// @param point  three.js' vector, read at each drawing
  follow(point, distance) {
    this.followed = point;
    this.controls.target.copy(point);
    this.camera.position.copy(point).add(new this.THREE.Vector3(0.35, 0.35, 1).setLength(distance));
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
    });
  }
}
