// SPDX-License-Identifier: Apache-2.0
// An image to save, which says what it shows.
import { contextOf } from "/core/dom.js";
import { colour } from "/core/theme.js";

/// A copy of a canvas on the page's ground, below a caption. @param names  [{name, ink: a colour; the text's if
/// left out}], set side by side
/** @param {HTMLCanvasElement} source  @param {{ name: string, ink?: string }[]} names */
export function captioned(source, names) {
  const letters = 14 * devicePixelRatio;
  const copy = document.createElement("canvas");
  const context = contextOf(copy);
  const look = { font: `${letters}px system-ui`, textBaseline: "middle" };
  Object.assign(context, look);
  const { words, height } = setInLines(context, names, source.width, letters);
  Object.assign(copy, { width: source.width, height: source.height + height });
  context.fillStyle = colour("card");
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(source, 0, height);
  Object.assign(context, look);  // a canvas that has got another size has forgotten it
  for (const { name, ink = colour("text"), left, middle } of words) {
    context.fillStyle = ink;
    context.fillText(name, left, middle, copy.width - 2 * letters);
  }
  return copy;
}

/// Positions of names set side by side, in as many lines as they need. @param letters  their height
function setInLines(context, names, width, letters) {
  let left = letters;
  let middle = letters;
  const words = names.map((name) => {
    const wide = context.measureText(name.name).width;
    if (left > letters && left + wide > width - letters) [left, middle] = [letters, middle + 2 * letters];
    const word = { ...name, left, middle };
    left += wide + letters;
    return word;
  });
  return { words, height: middle + letters };
}
