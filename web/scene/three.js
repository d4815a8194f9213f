// SPDX-License-Identifier: Apache-2.0
// Loads three.js, which draws the linkage.

let library = null;

/// @returns {THREE, OrbitControls}
export function loadThree() {
  library ??= Promise.all([import("/lib/three.module.js"), import("/lib/orbit_controls.js")])
    .then(([THREE, { OrbitControls }]) => ({ THREE, OrbitControls }))
    .catch(() => {
      library = null;
      throw new Error("This program was built without its 3-D view: the npm packages of web/ could not be fetched then.");
    });
  return library;
}
