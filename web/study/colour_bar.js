// SPDX-License-Identifier: Apache-2.0
// Colour bar above a chart, with a tick at each value that is drawn.
import { number, titleOf } from "/core/format.js";
import { colour, linePalette } from "/core/theme.js";
import { scaleOf } from "/study/curves.js";

const widest = 320;
const widthOfLetter = 7;  // pixels, about
const font = "12px system-ui, sans-serif";
const [barTop, barHeight] = [18, 10];

/// Height of the bar with its title and numbers.
export const colourBarHeight = 58;

/// Places of labels, left out where one would touch the last.
function labelled(values, at) {
  let free = -Infinity;
  return values.filter((value) => {
    const half = (number(value).length * widthOfLetter) / 2;
    if (at(value) - half < free) return false;
    free = at(value) + half + 6;
    return true;
  });
}

/// Elements of ECharts' "graphic". @param all  values of the axis, which span the bar  @param drawn  those
/// with a tick
/**
 * @param {string} axis
 * @param {number[]} all
 * @param {number[]} drawn
 * @param {number} width
 * @param {number} left
 */
export function colourBar(axis, all, drawn, width, left) {
  const length = Math.max(60, Math.min(widest, width - left - 40));
  const scale = scaleOf(all);
  const at = (value) => scale(value) * length;
  const stops = linePalette();
  const fill = { type: "linear", x: 0, y: 0, x2: 1, y2: 0,
    colorStops: stops.map((color, k) => ({ offset: k / (stops.length - 1), color })) };
  const text = (words, x, y, align) => ({ type: "text", x, y,
    style: { text: words, fill: colour("text"), font, align, verticalAlign: "top" } });
  const ticks = [...new Set(drawn)].sort((a, b) => a - b);
  return [{ type: "group", x: left, y: 8, silent: true, children: [
    text(titleOf(axis), 0, 0, "left"),
    { type: "rect", shape: { x: 0, y: barTop, width: length, height: barHeight }, style: { fill } },
    ...ticks.map((value) => ({ type: "line", style: { stroke: colour("text") },
      shape: { x1: at(value), x2: at(value), y1: barTop, y2: barTop + barHeight + 3 } })),
    ...labelled(ticks, at).map((value) => text(number(value), at(value), barTop + barHeight + 5,
      "center"))] }];
}
