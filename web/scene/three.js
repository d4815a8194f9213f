// SPDX-License-Identifier: Apache-2.0
// Loads three.js, which draws the linkage.

let library = null;

/// @returns {THREE, OrbitControls}
export function loadThree() {
  library ??= Promise.all([import("/lib/three.module.js"), import("/lib/orbit_controls.js")])
    .then(([THREE, { OrbitControls }]) => ({ THREE, OrbitControls }))
    .catch(() => {
      library = null;
      throw new Error("The 3-D view could not be loaded: the program was built without the npm packages of web/, or "
        + "is another one since this page was loaded. Load the page again.");
    });
  return library;
}
