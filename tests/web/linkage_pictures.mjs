// SPDX-License-Identifier: Apache-2.0
// Draws each linkage of web/linkages/ as an SVG, from the shapes of the scene itself.   node linkage_pictures.mjs URL FOLDER
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";

import { ask, endVisits, folder, visit } from "./visitor.mjs";

const linkages = fileURLToPath(new URL("../../web/linkages", import.meta.url));

/** The drawing, in the page, which has the scene's modules. Of thin things the width is that of the scene, enlarged. */
async function draw({ linkage, poses }) {
  const [width, height, margin, thicker, grain] = [160, 110, 12, 1.7, 10];
  const [{ loadThree }, { DescribedLinkage, channelsFor }, { upOf, viewerOf }] =
    await Promise.all([import("/scene/three.js"), import("/scene/described.js"), import("/scene/upright.js")]);
  const { THREE } = await loadThree();
  const { ranges, values } = channelsFor(linkage);
  const drawn = new DescribedLinkage(THREE, linkage, Object.keys(poses), ranges);
  drawn.place(poses, values);
  drawn.group.updateMatrixWorld(true);

  const up = upOf({ linkage });
  const viewer = viewerOf(THREE, up);
  const back = new THREE.Vector3().addScaledVector(viewer.right, 0.35).addScaledVector(viewer.up, 0.35 + 0.35 * Math.abs(up[2]))
    .add(viewer.front).normalize();
  const aside = viewer.up.clone().cross(back).normalize();
  const above = back.clone().cross(aside);
  const seen = (point) => [point.dot(aside), -point.dot(above)];
  const colourOf = (mesh) => `#${mesh.material.color.getHexString()}`;

  /** A shape: points, their width, colour, and distance from the viewer. */
  const shapes = [];
  drawn.group.traverse((part) => {
    if (!part.isMesh || !part.geometry.attributes.position) return;
    const { geometry: { type, parameters }, matrixWorld: world } = part;
    let points;
    let thickness;
    if (type === "TubeGeometry") {
      points = parameters.path.getPoints(24);
      thickness = 2 * parameters.radius;
    } else {
      part.geometry.computeBoundingBox();
      const { min, max } = part.geometry.boundingBox;
      const sides = max.clone().sub(min);
      const middle = min.clone().add(max).multiplyScalar(0.5);
      const along = ["x", "y", "z"].reduce((best, axis) => (sides[axis] > sides[best] ? axis : best));
      const others = ["x", "y", "z"].filter((axis) => axis !== along).map((axis) => sides[axis]);
      thickness = Math.max(...others);
      const end = new THREE.Vector3();
      end[along] = type === "SphereGeometry" ? 0 : sides[along] / 2;
      points = [middle.clone().sub(end), middle.clone().add(end)];
    }
    points = points.map((point) => point.clone().applyMatrix4(world));
    const depth = points.reduce((sum, point) => sum + point.dot(back), 0) / points.length;
    const isRound = type === "SphereGeometry" || type === "TubeGeometry" || thickness < 2.1 * drawn.radius;
    shapes.push({ points: points.map(seen), thickness, depth, colour: colourOf(part), opacity: part.material.opacity, isRound });
  });
  shapes.sort((a, b) => a.depth - b.depth);

  const all = shapes.flatMap(({ points }) => points);
  const range = (index) => [Math.min(...all.map((point) => point[index])), Math.max(...all.map((point) => point[index]))];
  const [[left, right], [top, bottom]] = [range(0), range(1)];
  const scale = Math.min((width - 2 * margin) / (right - left || 1), (height - 2 * margin) / (bottom - top || 1));
  const round = (value) => String(Math.round(value * grain) / grain);
  const place = ([x, y]) => `${round(width / 2 + scale * (x - (left + right) / 2))} ${round(height / 2 + scale * (y - (top + bottom) / 2))}`;
  const lines = shapes.map(({ points, thickness, colour, opacity, isRound }) => {
    const path = [...new Set(points.map(place))];
    const faint = opacity < 1 ? ` stroke-opacity="${opacity}"` : "";
    return `<path d="M${path.join("L")}${path.length === 1 ? "h0" : ""}" stroke="${colour}" stroke-width="${round(Math.max(2, thicker * scale * thickness))}"${
      isRound ? ' stroke-linecap="round"' : ""}${faint}/>`;
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}"><g fill="none" stroke-linejoin="round">\n${lines.join("\n")}\n</g></svg>\n`;
}

const page = await visit("#/help");
for (const file of readdirSync(linkages)) {
  const parameters = JSON.parse(readFileSync(join(linkages, file), "utf8"));
  const { poses } = await ask("/v1/linkages/assembly", { parameters });
  const picture = await page.evaluate(draw, { linkage: parameters.linkage, poses });
  writeFileSync(join(folder, `${basename(file, ".json")}.svg`), picture);
}
await endVisits();
