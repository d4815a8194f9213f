// SPDX-License-Identifier: Apache-2.0
// Loads three.js, which draws the linkage.
import { libraryLoader } from "/core/modules.js";

/// @returns {THREE, OrbitControls}
export const loadThree = libraryLoader("3-D view", async () => {
  const [THREE, { OrbitControls }] =
    await Promise.all([import("/lib/three.module.js"), import("/lib/orbit_controls.js")]);
  return { THREE, OrbitControls };
});
