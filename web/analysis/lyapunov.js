// SPDX-License-Identifier: Apache-2.0
// The largest exponent of each set of replicates.
import { findAnalysis } from "/core/api.js";
import { number } from "/core/format.js";
import { axisColumns, table } from "/analysis/parts.js";

/**
 * @param {HTMLElement} element
 * @param {AnalysedSweep} analysed
 * @param {AbortSignal} signal
 */
export async function lyapunovCard(element, { sweep }, signal) {
  const rows = await findAnalysis(sweep.id, "lyapunov", {}, signal);
  /** @type {(row: typeof rows[number]) => string} */
  const shown = (row) =>
    (row.exponent_1_s === null ? "parted in the run-up"
      : `${number(row.exponent_1_s, 3)} (${number(row.exponent_low_1_s, 3)} to ${number(row.exponent_high_1_s, 3)})`);
  element.replaceChildren(table("Lyapunov exponents", rows,
    [...axisColumns(sweep.axes), ["Exponent [1/s]", shown],
      ["Diverging pairs", (row) => `${row.pairs_diverged} of ${row.pairs}`],
    ["From [s]", (row) => number(row.from_s)], ["To [s]", (row) => number(row.to_s)]]));
  return null;
}
