// SPDX-License-Identifier: Apache-2.0
// Measured signals as curves of plots over time, laid over jobs or alone.
import { findMeasurement } from "/core/api.js";
import { lineColour } from "/core/theme.js";

/// A signal that is laid over a job. @param shift  time of the job at the measurement's time 0 [s]
/** @typedef {{ id: string, run: number, channel: string, shift: number }} Overlay */

/// Overlays as they stand in an address: "mea_1:0:slider_acceleration_m_s2:0.5".
/** @param {string} text  @returns {Overlay[]} */
export function readOverlays(text) {
  return text.split(",").filter(Boolean).map((part) => {
    const [id, run, channel, shift] = part.split(":");
    return { id, run: Number(run) || 0, channel, shift: Number(shift) || 0 };
  }).filter(({ channel }) => channel);
}

/** @param {Overlay[]} overlays */
export const writeOverlays = (overlays) => overlays.map(({ id, run, channel, shift }) =>
  [id, run, channel, ...(shift === 0 ? [] : [shift])].join(":")).join(",");

/// Curve of one run and channel, corrected as the measurement says.
/**
 * @param {Api.Measurement} measurement
 * @param {Omit<Overlay, "id">} overlay
 * @param {string} name
 * @param {() => string} colour
 * @returns {Trace | null}
 */
export function measuredTrace(measurement, { run, channel, shift }, name, colour) {
  const sensor = measurement.channels.find((each) => each.name === channel);
  if (!sensor || run >= measurement.runs.length) return null;
  return { job: measurement.id, channel, name, colour, measured: { run, factor: sensor.sign * sensor.gain,
    offset: sensor.offset, shift: shift - sensor.delay_s } };
}

/// Curves of the overlays of an address. Those whose measurement has been deleted are left out.
/** @param {Overlay[]} overlays  @param {number} colours  that are taken  @param {AbortSignal} signal */
export async function findOverlays(overlays, colours, signal) {
  const traces = await Promise.all(overlays.map(async (overlay, index) => {
    try {
      const measurement = await findMeasurement(overlay.id, signal);
      const run = measurement.runs.length > 1 ? `, run ${overlay.run}` : "";
      return measuredTrace(measurement, overlay, `measured: ${measurement.name || measurement.id}${run}`,
        () => lineColour(colours + index));
    } catch (error) {
      if (error.status === 404) return null;
      throw error;
    }
  }));
  return traces.filter((trace) => trace !== null);
}
