// SPDX-License-Identifier: Apache-2.0
// The names of lines above a chart: all of them in as many rows as they take, so that a saved picture has them, too.
import { contextOf } from "/core/dom.js";

const rowHeight = 24;
const besideName = 42;  // pixels: the mark before a name, and the gap after it
const margin = 10;
const mostRows = 4;  // more are turned over, one at a time

/// @returns {option, height}: of the legend in a chart of that width, and what it takes from the top of the chart
export function legendOf(names, width) {
  const rows = countRows(names, width - margin);
  const isPlain = rows <= mostRows;
  return { option: { top: 0, type: isPlain ? "plain" : "scroll" }, height: rowHeight * (isPlain ? rows : 1) };
}

function countRows(names, width) {
  const context = contextOf(document.createElement("canvas"));
  context.font = "12px system-ui, sans-serif";
  let rows = 1;
  let left = 0;
  for (const name of new Set(names)) {
    const wide = besideName + context.measureText(name).width;
    if (left > 0 && left + wide > width) [rows, left] = [rows + 1, 0];
    left += wide;
  }
  return rows;
}
