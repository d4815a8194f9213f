// What the metrics know of the curves: peaks are found inside the steps of the integration, curves join samples.
import { nameOf, number, unitOf } from "/core/format.js";
import { labelsOf } from "/run/labels.js";

const unitOfAcceleration = /_((m|rad)_s2)$/;
const digits = 5;  // as in the table of the metrics

/// The metrics' peak of a channel in words; null if they have none.
function peakOf({ metrics }, channel) {
  // Accelerations of a described linkage are called so in the metrics alone.
  const key = [`peak_${channel}`, `peak_${channel.replace(unitOfAcceleration, "_acceleration_$1")}`].find((name) => typeof metrics?.[name] === "number");
  if (!key) return null;
  const text = `${number(metrics[key], digits)} ${unitOf(channel)}`;
  return unitOfAcceleration.test(key) ? `${text}${steadyText(metrics, key)}` : text;
}

/// Accelerations count from run_up_s on; of some it is known when that was.
function steadyText(metrics, key) {
  const at = metrics[key.replace(unitOfAcceleration, "_time_s")];
  const whole = metrics[key.replace(unitOfAcceleration, "_whole_run_$1")];
  return `${typeof at === "number" ? ` at ${number(at, 6)} s` : ""} from run_up_s on, ${number(whole, digits)} ${unitOf(key)} in the whole run`;
}

/// The peaks of what a plot shows, for below it; empty if the metrics have none.
export function peakNote(jobs, channels) {
  const labels = labelsOf(jobs);
  const nameFor = (channel, j) => [channels.length > 1 && nameOf(channel), jobs.length > 1 && labels[j]].filter(Boolean).join(", ");
  const peaks = jobs.flatMap((job, j) => channels.map((channel) => [nameFor(channel, j), peakOf(job, channel)])).filter(([, peak]) => peak !== null);
  if (peaks.length === 0) return "";
  const rates = [...new Set(jobs.map((job) => job.parameters.output_rate_hz))].map((rate) => number(rate, 6)).join(" and ");
  return `Largest magnitude: ${peaks.map((words) => words.join(" ").trim()).join("; ")}. It is sought between the samples, too, which the curve joins at ${rates} Hz.`;
}
