// SPDX-License-Identifier: Apache-2.0
// Cost of a sweep in words, as the service estimates it.
import { bytes, plural, span } from "/core/format.js";

/** @param {Api.Estimate} estimate */
function timeWords({ seconds, measured_jobs: measured, unmeasured_kinds: unmeasured }) {
  if (seconds === null) return "Computing time unknown: nothing of like kind has been computed yet"
    + `${unmeasured.length > 0 ? ` (${unmeasured.join("; ")})` : ""}.`;
  return `Computing time about ${span(seconds)} on this service's workers, judged by `
    + `${plural(measured, "run")} of like kind.`;
}

/** @param {Api.Estimate} estimate */
function sizeWords({ bytes: size, free_bytes: free }) {
  const room = `${bytes(free)} are free`;
  if (size === null) return `Growth of the store unknown; ${room}.`;
  return `The store grows by about ${bytes(size)}; ${room}${size > free ? ": too little" : ""}.`;
}

/// Sentences on stored results, time, store and limit.
/** @param {Api.Estimate} estimate */
export function costWords(estimate) {
  const { stored_jobs: stored, new_jobs: fresh, max_jobs: most } = estimate;
  if (fresh === 0) return "All results are stored already: nothing is to be computed.";
  const text = (count) => count.toLocaleString("en");
  const known = stored === 0 ? [] : [`${text(stored)} stored already, ${text(fresh)} to compute.`];
  return [...known, timeWords(estimate), sizeWords(estimate), `At most ${text(most)} at once.`].join(" ");
}
