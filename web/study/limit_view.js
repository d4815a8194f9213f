// SPDX-License-Identifier: Apache-2.0
// One search: its limits over the axes, with the evaluations that they stand on.
import { searches } from "/core/api.js";
import { choice, h } from "/core/dom.js";
import { exact, number, plural, pointOf, titleOf, unitOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { fallsShown, hasReplicates, limitCurve, verdictOf } from "/study/limit_curve.js";
import { limitPoints } from "/study/limit_points.js";
import { StudyView } from "/study/study_view.js";

/// The combination of a limit: "10 rad/s, flexible".
/** @type {(search: Api.Search, limit: Api.Limit) => string} */
const combinationOf = (search, limit) => search.axes.map((axis) => pointOf(axis, limit[axis])).join(", ");

/// The limits in a line, for a list: "0.035 mm", "2 limits, 0.035 to 0.05 mm; 1 not exceeded".
/** @param {Api.Search} search */
export function shortAnswerOf({ limits, parameter }) {
  const count = (verdict) => limits.filter((limit) => limit.verdict === verdict).length;
  const found = limits.filter(({ verdict }) => verdict === "found").map(({ limit }) => Number(limit))
    .sort((a, b) => a - b);
  const [least, most] = [found[0], found.at(-1)].map((value) => number(value, 3));
  const range = `${least === most ? least : `${least} to ${most}`} ${unitOf(parameter)}`.trim();
  const others = [["never_exceeded", "not exceeded"], ["always_exceeded", "exceeded from the start"],
    ["lost", "undetermined"]].filter(([verdict]) => count(verdict) > 0)
    .map(([verdict, words]) => (count(verdict) < limits.length ? `${count(verdict)} ${words}` : words));
  const all = limits.length === 1 ? range : `${plural(found.length, "limit")}, ${range}`;
  return [found.length === 0 ? "" : all, ...others]
    .filter(Boolean).join("; ") || "–";
}

/** @extends {StudyView<Api.Search>} */
export class LimitView extends StudyView {
  static api = searches;
  static route = "searches";

  tableName = "Limits";
  shown = 0;  // the combination whose evaluations are drawn
  picker = h("span");

  charts() {
    return [{ title: "Limit", make: limitCurve }, { title: "Evaluations", make: limitPoints, above: this.picker }];
  }

  intro() {
    const { study: search } = this;
    const { from, to } = search.request.over[search.parameter];
    const share = hasReplicates(search)
      ? ` in more than ${number(100 * (1 - search.quantile))} % of the replicates` : "";
    const single = "One run at each value: how much the metric scatters is not known, nor how sharp the limit is.";
    return [h("p", {}, `Last value of ${titleOf(search.parameter)}, from ${exact(from)} to ${exact(to)}, `
        + `before ${titleOf(search.metric)} first exceeds ${exact(search.bound)}${share}.`),
      ...(hasReplicates(search) ? [] : [h("p", { role: "note" }, single)])];
  }

  columns() {
    const { study: search } = this;
    const unit = `[${unitOf(search.parameter) || "1"}]`;
    return [...search.axes.map((axis) => [titleOf(axis)]), ["Verdict"], [`Limit ${unit}`],
      ...(hasReplicates(search) ? [[`OK in all up to ${unit}`, "number"],
        [`Exceeded in all from ${unit}`, "number"]] : []),
      ["Evaluations", "number"], ...(hasReplicates(search) ? [[`Metric falls in ${unit}`]] : [])];
  }

  statusText() {
    const { state, progress, counts, error } = this.study;
    return `${state}: ${Math.floor(100 * progress)} %, ${plural(counts.succeeded, "run")} `
      + `of ${plural(counts.total, "job")}${state === "running" ? " so far" : ""}${error ? `; ${error}` : ""}`;
  }

  drawChoices() {
    const { study: search } = this;
    if (search.axes.length === 0 || this.picker.hasChildNodes()) return;
    const names = search.limits.map((limit, index) => [String(index), combinationOf(search, limit)]);
    this.picker.replaceChildren(choice("Combination", names, String(this.shown),
      (index) => { this.shown = Number(index); this.drawn[1]?.draw(); }));
  }

  /// Offer to look at more values, where the bound was not exceeded: a narrow peak may lie between them.
  /** @param {Api.Limit} limit */
  moreValues({ verdict, points }) {
    if (verdict !== "never_exceeded") return null;
    return [" ", h("a", { href: routeTo("searches", "new", { from: this.study.id, first: 2 * points.length - 1 }) },
      "Look at more")];
  }

  rows() {
    return this.study.limits.map((limit) => this.row(limit));
  }

  /** @param {Api.Limit} limit */
  row(limit) {
    const isSure = hasReplicates(this.study);
    const falls = fallsShown(this.study, limit).map(({ from, to, within_again: again }) =>
      `${number(from)} to ${number(to)}${isSure && again ? " (within the bound again)" : ""}`).join("; ");
    const between = limit.verdict === "found" ? `${number(limit.limit)} to ${number(limit.limit_beyond)}`
      : limit.verdict === "never_exceeded" ? `beyond ${number(limit.limit)}` : "–";
    return h("tr", {}, this.study.axes.map((axis) => h("td", {}, pointOf(axis, limit[axis]))),
      h("td", {}, verdictOf(limit), this.moreValues(limit),
        !isSure && falls ? h("span", { class: "quiet" }, `; within the bound again in ${falls}`) : null),
      h("td", {}, between),
      ...(hasReplicates(this.study) ? [limit.band_from, limit.band_to].map((end) => h("td",
        { class: "number" }, number(end))) : []),
      h("td", { class: "number" }, String(limit.evaluations)),
      isSure ? h("td", {}, falls || "–") : null);
  }
}
