// SPDX-License-Identifier: Apache-2.0
// Channels with the extremes between samples: X_min_UNIT and X_max_UNIT of X_UNIT.

const least = /^(.+)_min(_.+)$/;

/// A channel with its envelope, where the run has one. @param columns  of the run
/**
 * @param {string} channel
 * @param {string[]} columns
 * @returns {Pick<Trace, "channel" | "envelope">}
 */
export function withEnvelope(channel, columns) {
  for (const low of columns) {
    const [, stem, unit] = least.exec(low) ?? [];
    const high = `${stem}_max${unit}`;
    if (!stem || `${stem}${unit}` !== channel) continue;
    if (columns.includes(high)) return { channel, envelope: [low, high] };
  }
  return { channel };
}

/// Channels without the ends of envelopes.
/** @param {string[]} columns */
export function withoutEnds(columns) {
  const ends = new Set(columns.flatMap((channel) => withEnvelope(channel, columns).envelope ?? []));
  return columns.filter((channel) => !ends.has(channel));
}
