// SPDX-License-Identifier: Apache-2.0
// The answer of a fit: in sentences, as errors of its signals, and as the correlation of its parameters.
import { h, tableCard } from "/core/dom.js";
import { number, plural, unitOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { writeOverlays } from "/run/measured.js";
import { nameOfSignal } from "/study/fit_signals.js";
import { intervalText } from "/study/interval_bar.js";
import { nameOfVariable, unitOfVariable } from "/study/variables.js";

const strong = 0.9;  // correlation from which on it is marked

/** @type {Record<Api.Fit["stage"], string>} */
export const stageNames = { design: "points that fill the space", divergence: "points beside the best one",
  scatter: "scatter of features", global: "CMA-ES", local: "least squares",
  scan: "each parameter over its span", profile: "profile likelihood",
  prediction: "prediction of runs held back", ended: "ended" };

/** @type {Record<NonNullable<Api.Fit["basis"]>, string>} */
const bases = { point_wise: "The signals are compared point by point.",
  features: "Features of the signals are compared: peaks, impacts, envelope and bands." };

/** @param {Api.Schemas["FittedParameter"]} parameter */
function sentenceOf({ path, value, profile, range, linearised }) {
  const unit = unitOfVariable(path);
  const interval = profile ?? range ?? linearised;
  const sure = interval ? ` (${range ? "range" : "95 %"}: ${intervalText(interval, 5)})` : "";
  return `${nameOfVariable(path).toLowerCase()} ${number(value, 5)}${unit ? ` ${unit}` : ""}${sure}`;
}

/// The values in one line; why there are none, if there are none.
/** @param {Api.Fit} fit */
export function shortAnswerOf({ parameters, best, error }) {
  const found = parameters.map(sentenceOf).join("; ");
  return best ? found.charAt(0).toUpperCase() + found.slice(1) : error ?? "–";
}

/// The measured signals of the first run, which the first job of a point is compared with.
/** @param {Api.Fit} fit */
function overlaysOf({ signals, request }) {
  const [first] = signals;
  return signals.filter(({ measurement_id: id, run }) => id === first.measurement_id && run === first.run)
    .map(({ measurement_id: id, run, channel }) => ({ id, run, channel,
      shift: request.measurements.find((each) => each.id === id)?.time_shift_s ?? 0 }));
}

/// Answer of a fit in sentences, the parameters that the signals do not tell, and the jobs of the best point.
/** @param {Api.Fit} fit */
export function answerOf(fit) {
  const { state, parameters, signals, measurement_ids: measurements, basis, divergence, local_end: end,
    remarks, best, thinning } = fit;
  if (!best) return [h("p", { class: "quiet" }, state === "running" ? "No point has been computed yet."
    : "No point has a value.")];
  const sentence = `${state === "running" ? "So far: " : ""}${shortAnswerOf(fit)}.`;
  const heldBack = signals.flatMap((signal) => (signal.held_back && signal.held_back.relative_rms !== null
    ? [`${nameOfSignal(signal, signals, measurements)}: what is held back is predicted with an error of `
      + `${number(100 * signal.held_back.relative_rms, 3)} % of the signal.`] : []));
  const unknown = parameters.filter(({ identified }) => identified === false);
  const missed = unknown.length === 0 ? ""
    : `The signals do not tell ${unknown.map(({ path }) => nameOfVariable(path).toLowerCase()).join(", ")}.`;
  const compared = [divergence?.message ?? (basis ? bases[basis] : ""),
    thinning > 1 ? `One of ${thinning} samples is compared.` : "", end ?? ""].filter(Boolean).join(" ");
  const [first, ...more] = best.job_ids;
  const measured = writeOverlays(overlaysOf(fit));
  return [h("p", { class: "big" }, sentence),
    heldBack.length > 0 ? h("p", {}, heldBack.join(" ")) : null,
    h("p", {}, compared),
    missed || remarks.length > 0 ? h("ul", { class: "trouble" }, [missed, ...remarks].filter(Boolean)
      .map((remark) => h("li", {}, remark))) : null,
    first ? h("p", { class: "actions" },
      h("a", { class: "button main",
        href: routeTo("jobs", first, { with: more.slice(0, 5).join(","), measured }) },
        best.job_ids.length === 1 ? "Best job" : "Best jobs"),
      h("span", { class: "quiet small" },
        `Point ${best.point}, sum of squares ${number(best.sum_of_squares)}, `
        + `${plural(best.job_ids.length, "job")}`)) : null].filter((each) => each !== null);
}

/// A sentence on the points without a value, with their reasons; nothing if all have one.
/** @param {import("/study/fit_points.js").Point[]} points */
export function lostOf(points) {
  const lost = Map.groupBy(points.filter(({ lost_reason: reason }) => reason), (point) => point.lost_reason);
  const told = [...lost].map(([reason, { length }]) => `${length.toLocaleString("en")} ${reason}`).join(", ");
  return told ? [h("p", { class: "trouble" }, `Points without a value: ${told}.`)] : [];
}

/// Errors of the signals, fitted and held back; null before there are any.
/** @param {Api.Fit} fit */
export function errorsCard({ signals, measurement_ids: measurements }) {
  if (signals.length === 0) return null;
  const rows = signals.flatMap((signal) => [["fitted", signal.fitted], ["held back", signal.held_back]]
    .flatMap(([use, error]) => (error && typeof error === "object" ? [h("tr", {},
      h("td", {}, nameOfSignal(signal, signals, measurements)), h("td", {}, use),
      [error.samples, error.rms, error.relative_rms === null ? null : 100 * error.relative_rms, error.measured_peak, error.predicted_peak]
        .map((value) => h("td", { class: "number" }, number(value))),
          h("td", {}, unitOf(signal.channel) || "1"))]
      : [])));
  return tableCard("Prediction errors", "RMS of predicted less measured, in the signal's unit and over the "
    + "RMS of the "
    + "measured signal about its mean.", [["Signal"], ["Samples"],
    ...["Number", "RMS", "Relative RMS [%]", "Measured peak", "Predicted peak"]
      .map((text) => [text, "number"]), ["Unit"]], rows);
}

/// Correlation of the parameters; null of one parameter, and before it is known.
/** @param {Api.Fit} fit */
export function correlationCard({ correlation, parameters }) {
  if (!correlation || parameters.length < 2) return null;
  const names = parameters.map(({ path }) => nameOfVariable(path));
  const isStrong = (value, i, j) => i !== j && Math.abs(value ?? 0) > strong;
  const rows = correlation.map((row, i) => h("tr", {}, h("th", { scope: "row" }, names[i]),
    row.map((value, j) => h("td", { class: isStrong(value, i, j) ? "number marked" : "number" },
      number(value, 2)))));
  return tableCard("Correlation", `Parameters with a correlation beyond ±${strong}, which are marked, do `
    + `nearly the same `
    + "to the signals.", [["Parameter"], ...names.map((name) => [name, "number"])], rows);
}
