// SPDX-License-Identifier: Apache-2.0
// Axis of the depth in charts around the bearing: few numbers, apart from each other and readable
// over what is drawn.
import { number } from "/core/format.js";
import { colour } from "/core/theme.js";

const narrow = 480;  // pixels: with room for fewer numbers
const beyond = 0.4;  // of a step: room between the last number and those of the angles

/// The least of 1, 2, 5, 10, ... times a power of ten that is not below a number.
/** @param {number} least */
function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return ([1, 2, 5].find((digit) => digit * power >= least * (1 - 1e-9)) ?? 10) * power;
}

/// Options of the radius, and of the title that names it in a corner, where nothing is drawn.
/** @param {number} largest  @param {number} width  of the chart */
export function depthAxis(largest, width) {
  const step = roundStep((largest > 0 ? largest : 1) / (width < narrow ? 2 : 3));
  const steps = Math.max(1, Math.ceil(largest / step - 1e-9));
  return {
    title: { text: "depth [µm]", left: 0, bottom: 0,
      textStyle: { fontSize: 12, fontWeight: "normal", color: colour("text") } },
    radiusAxis: { type: "value", min: 0, max: step * (steps + beyond), interval: step, z: 5,
      axisLabel: { showMaxLabel: false, color: colour("text"), fontSize: 11, backgroundColor: colour("card"),
        padding: [1, 2], borderRadius: 2, formatter: (value) => number(value, 2) },
      splitLine: { lineStyle: { color: colour("line") } } },
  };
}
