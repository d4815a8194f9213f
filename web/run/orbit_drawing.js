// SPDX-License-Identifier: Apache-2.0
// Painting of the journal's orbit.
import { contextOf } from "/core/dom.js";
import { number } from "/core/format.js";
import { colour, paletteColour } from "/core/theme.js";

const hues = 64;  // steps of the palette: one path is drawn for each
const ink = "#e6007a";

/// A picture of the orbit in the given size [pixels].
/// @param behind  the whole run's columns, drawn pale; or null
/// @param partOf  the palette's part, 0 to 1, of a sample of the columns
/// @returns {picture, at}: a canvas, and where a point [mm] is in it
/**
 * @param {number} size
 * @param {Record<string, number[]>} columns
 * @param {Record<string, number[]> | null} behind
 * @param {import("/run/described.js").Clearance} clearance
 * @param {(index: number) => number} partOf
 */
export function paintOrbit(size, columns, behind, clearance, partOf) {
  const picture = document.createElement("canvas");
  Object.assign(picture, { width: size, height: size });
  const context = contextOf(picture);
  const scale = (0.4 * size) / Math.max(clearance.x, clearance.y);
  /** @type {(columns: Record<string, number[]>, i: number) => [number, number]} */
  const at = ({ journal_x_mm: x, journal_y_mm: y }, i) => [size / 2 + scale * x[i], size / 2 - scale * y[i]];
  context.fillStyle = colour("card");
  context.fillRect(0, 0, size, size);
  drawFrame(context, size, scale, clearance);
  context.lineWidth = devicePixelRatio;
  if (behind) drawPale(context, behind, at);
  const paths = Array.from({ length: hues }, () => new Path2D());
  for (let i = 1; i < columns.t_s.length; i += 1) {
    const path = paths[Math.min(hues - 1, Math.floor(partOf(i) * hues))];
    path.moveTo(...at(columns, i - 1));
    path.lineTo(...at(columns, i));
  }
  paths.forEach((path, hue) => {
    context.strokeStyle = paletteColour(hue / (hues - 1));
    context.stroke(path);
  });
  return { picture, at: (i) => at(columns, i) };
}

function drawPale(context, columns, at) {
  context.strokeStyle = colour("line");
  context.beginPath();
  columns.t_s.forEach((_, i) => context.lineTo(...at(columns, i)));
  context.stroke();
}

function drawFrame(context, size, scale, clearance) {
  context.lineWidth = 1.5 * devicePixelRatio;
  drawOutline(context, size / 2, scale, clearance);
  context.fillStyle = colour("text");
  context.font = `${12 * devicePixelRatio}px system-ui`;
  const bottom = size - 6 * devicePixelRatio;
  for (const sign of [-1, 0, 1]) {
    const [across, up] = [sign * clearance.x, sign * clearance.y];
    context.textAlign = "center";
    context.fillText(number(across), size / 2 + scale * across, bottom);
    context.textAlign = "left";
    if (sign !== 0) context.fillText(number(up), 0, size / 2 - scale * up + 4 * devicePixelRatio);
  }
  context.fillText("y [mm]", 0, 14 * devicePixelRatio);
  context.textAlign = "right";
  context.fillText("x [mm]", size, bottom - 16 * devicePixelRatio);
}

function drawOutline(context, middle, scale, { isRound, x, y }) {
  if (isRound) drawRing(context, [middle, middle], scale * x, colour("quiet"));
  else {
    context.strokeStyle = colour("quiet");
    context.strokeRect(middle - scale * x, middle - scale * y, 2 * scale * x, 2 * scale * y);
  }
}

export function drawRing(context, centre, radius, stroke = ink) {
  context.strokeStyle = stroke;
  context.beginPath();
  context.arc(...centre, radius, 0, 2 * Math.PI);
  context.stroke();
}

/// The bar that says which colour stands for what.
export function drawScale(canvas) {
  const context = contextOf(canvas);
  for (let x = 0; x < canvas.width; x += 1) {
    context.fillStyle = paletteColour(x / (canvas.width - 1));
    context.fillRect(x, 0, 1, canvas.height);
  }
}
