// SPDX-License-Identifier: Apache-2.0
// A new search: which parameter, along which way, and which metric may not exceed what.
import { searches } from "/core/api.js";
import { h } from "/core/dom.js";
import { nameOf, plural, titleOf, unitOf } from "/core/format.js";
import { countJobs } from "/form/request.js";
import { addNumber, helpOf, StudyForm } from "/form/study_form.js";

const mostFirst = 1000;  // initial values that the service takes

/// A name with the unit of a parameter or metric: "From [mm]".
const inUnit = (name, of) => (unitOf(of) ? `${name} [${unitOf(of)}]` : name);

export class SearchForm extends StudyForm {
  static api = searches;
  static route = "searches";
  static title = "New search";
  static schema = "SearchRequest";

  /// Request with more initial values, where the address has a number of them.
  /** @param {any} request  @param {URLSearchParams} query */
  static adjusted(request, query) {
    const first = Number(query.get("first"));
    if (!(first >= 2)) return request;
    return { ...request, over: Object.fromEntries(Object.entries(request.over)
      .map(([parameter, way]) => [parameter, { ...way, first: Math.min(first, mostFirst) }])) };
  }

  constructor(fields, schemas, request) {
    super(fields, schemas, request);
    /** @type {any} */
    this.way = schemas.SearchPath.properties;
    const [[parameter, way] = ["clearance_mm", {}]] = Object.entries(request.over ?? {});
    const texts = Object.fromEntries(
      ["from", "to", "tolerance", "first"].map((key) => [key, way[key] === undefined ? "" : String(way[key])]));
    this.state.over = { parameter, scale: way.scale ?? "linear", ...texts };
    this.state.values.metric ||= "peak_slider_acceleration_m_s2";
  }

  parts() {
    const { over, values } = this.state;
    const numbers = this.fields.filter(({ kind }) => kind === "number" || kind === "integer").map(({ path }) => path);
    const metrics = this.schema.metric.examples.map((metric) => [metric, titleOf(metric)]);
    const help = (key) => helpOf(this.way[key]);
    return [this.nameField(),
      h("h2", {}, "Search"),
      this.told("over.parameter", "Parameter", over, "parameter",
        "Parameter whose largest admissible value is searched; also a number of a description, such as "
        + "linkage.bodies.rod.mass_kg", null, numbers.map((path) => [path, titleOf(path)])),
      this.told("over.from", "From", over, "from", "Start of the search, where the metric is within its bound"),
      this.told("over.to", "To", over, "to", "End of the search; may be less than its start"),
      this.told("over.scale", "Spacing", over, "scale", "Bisection of differences (linear) or of ratios (logarithmic)",
        [["linear", "linear"], ["log", "logarithmic"]]),
      this.told("over.tolerance", "Tolerance", over, "tolerance", help("tolerance")),
      this.told("over.first", "Number of initial values", over, "first", help("first")),
      this.told("metric", "Metric", values, "metric", "Metric that must not exceed the bound", null, metrics),
      this.number("bound"), this.number("quantile"),
      h("h2", {}, "Linkage and axes"),
      h("p", { class: "quiet small" }, "One limit for each combination of the parameters that have a list or a range."),
      ...this.parameterFields(), this.linkage(),
      h("details", { open: Number(this.state.replicates.count) > 1 }, h("summary", {}, "Replicates and priority"),
        h("p", { class: "actions" }, ...this.replicateFields(), ...this.orderFields()))];
  }

  build() {
    const { request: { name, parameters, sweep, replicates, priority, reuse }, problems } = this.buildCommon();
    const { over, values } = this.state;
    const way = {};
    for (const key of ["from", "to", "tolerance", "first"]) addNumber(over[key], key, `over.${key}`, way, problems);
    if (over.scale !== "linear") way.scale = over.scale;
    const request = { name, parameters, over: { [over.parameter.trim()]: way }, metric: values.metric.trim() };
    this.addNumbers(["bound", "quantile"], request, problems);
    return { request: JSON.parse(JSON.stringify({ ...request, sweep, replicates, priority, reuse })), problems };
  }

  drawCount(request) {
    const limits = countJobs({ sweep: request.sweep });
    const unit = unitOf(request.metric);
    const measured = { "over.from": ["From", this.state.over.parameter], "over.to": ["To", this.state.over.parameter],
      "over.tolerance": ["Tolerance", this.state.over.parameter], bound: ["Bound", request.metric] };
    for (const [row, [name, of]] of Object.entries(measured)) this.rows.get(row)?.rename?.(inUnit(name, of));
    this.count.textContent = `${plural(limits, "limit")} to find`;
    this.cost.textContent = `${plural(request.replicates?.count ?? 1, "run")} per evaluated `
      + `value; ${nameOf(request.metric).toLowerCase()}${unit ? ` in ${unit}` : ""}.`;
  }

  rowOf(pointer) {
    const [, key, , of] = pointer.split("/");
    if (key === "over") return of ? `over.${of}` : "over.parameter";
    return this.schema[key] && this.rows.has(key) ? key : super.rowOf(pointer);
  }
}
