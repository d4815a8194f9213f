// SPDX-License-Identifier: Apache-2.0
// A new optimisation: variables, objectives, bounds on other metrics, and how many candidates.
import { optimisations } from "/core/api.js";
import { choice, freshId, h } from "/core/dom.js";
import { plural, titleOf, unitOf } from "/core/format.js";
import { countJobs } from "/form/request.js";
import { itemRow, itemText, listFields, textOf } from "/form/list_fields.js";
import { addNumber, StudyForm } from "/form/study_form.js";
import { addVariables, readVariables, rowOfVariable, variableFields } from "/form/variable_fields.js";

const numbers = ["budget", "population", "starts", "seed"];
/** @type {Record<Api.Schemas["Objective"]["goal"], string>} */
const goals = { minimise: "minimise", maximise: "maximise" };
/** @type {Record<Api.Optimisation["method"], string>} */
const methods = { cma_es: "CMA-ES", nelder_mead: "Nelder-Mead, local", bobyqa: "BOBYQA, local",
  nsga2: "NSGA-II, of several objectives" };
const sides = [["maximum", "at most"], ["minimum", "at least"]];

export class OptimisationForm extends StudyForm {
  static api = optimisations;
  static route = "optimisations";
  static title = "New optimisation";
  static schema = "OptimisationRequest";

  constructor(fields, schemas, request) {
    super(fields, schemas, request);
    this.metrics = schemas.SearchRequest.properties.metric.examples;
    this.state.over = readVariables(request.over);
    this.state.method = request.method ?? "";
    this.state.objectives = (request.objectives ?? [{}]).map(({ metric = "", goal = "minimise", quantile }) =>
      ({ metric, goal, quantile: textOf(quantile) }));
    this.state.bounds = (request.bounds ?? []).map(({ metric, minimum, maximum, quantile }) =>
      ({ metric, side: minimum === undefined ? "maximum" : "minimum", value: textOf(minimum ?? maximum),
        quantile: textOf(quantile) }));
  }

  parts() {
    const { over, objectives, bounds } = this.state;
    const paths = this.fields.filter(({ kind }) => kind === "number").map(({ path }) => path);
    const list = h("datalist", { id: freshId("metrics") },
      this.metrics.map((metric) => h("option", { value: metric }, titleOf(metric))));
    const metric = (item) => itemText(this, "Metric", item, "metric", { list: list.id, size: 34 });
    const quantile = (item) => itemText(this, "Quantile (optional)", item, "quantile");
    return [this.nameField(), ...variableFields(this, over, paths,
      "Parameters between two bounds; also numbers of a description, such as linkage.bodies.rod.mass_kg."),
    listFields(this, { title: "Objectives", noun: "Objective", items: objectives,
      help: "Several give a Pareto front. A metric counts with its worst value over the jobs of a "
        + "candidate, or with "
        + "a quantile.", fresh: () => ({ metric: "", goal: "minimise", quantile: "" }),
      draw: (item, index) => itemRow(this, `objectives.${index}`,
        [metric(item), choice("Goal", Object.entries(goals), item.goal,
        (goal) => { item.goal = goal; this.update(); }), quantile(item)]) }),
    listFields(this, { title: "Constraints", noun: "Constraint", items: bounds,
      help: "Bounds that a feasible candidate keeps, in the unit of the metric.",
      fresh: () => ({ metric: "", side: "maximum", value: "", quantile: "" }),
      draw: (item, index) => itemRow(this, `bounds.${index}`, [metric(item), choice("Side", sides, item.side,
        (side) => { item.side = side; this.update(); }), itemText(this, "Value", item, "value"),
          quantile(item)]) }),
    list, h("h2", {}, "Method and budget"),
    ...itemRow(this, "method", [choice("Method", [["", "the usual one"], ...Object.entries(methods)],
      this.state.method, (method) => { this.state.method = method; this.update(); })]),
    ...numbers.map((key) => this.number(key)),
    h("h2", {}, "Linkage and axes"),
    h("p", { class: "quiet small" }, "A candidate has a job for each combination of the parameters that "
      + "have a list or "
      + "a range."),
    ...this.parameterFields(), this.linkage(),
    h("details", { open: Number(this.state.replicates.count) > 1 },
      h("summary", {}, "Replicates and priority"),
      h("p", { class: "actions" }, ...this.replicateFields(), ...this.orderFields(),
        this.executorField()))];
  }

  build() {
    const { request: { name, parameters, sweep, replicates, priority, reuse, executor },
      problems } = this.buildCommon();
    const request = { name, parameters };
    addVariables(this.state.over, request, problems);
    request.objectives = this.state.objectives.map(({ metric, goal, quantile }, index) => {
      const objective = { metric: metric.trim(), goal };
      addNumber(quantile, "quantile", `objectives.${index}`, objective, problems);
      return objective;
    });
    const bounds = this.state.bounds.map(({ metric, side, value, quantile }, index) => {
      const bound = { metric: metric.trim() };
      addNumber(value, side, `bounds.${index}`, bound, problems);
      addNumber(quantile, "quantile", `bounds.${index}`, bound, problems);
      return bound;
    });
    if (bounds.length > 0) request.bounds = bounds;
    if (this.state.method) request.method = this.state.method;
    this.addNumbers(numbers, request, problems);
    const whole = { ...request, sweep, replicates, priority, reuse, executor };
    return { request: JSON.parse(JSON.stringify(whole)), problems };
  }

  drawCount(request) {
    const jobs = countJobs({ sweep: request.sweep, replicates: request.replicates });
    const units = request.objectives.map(({ metric }) => unitOf(metric)).filter(Boolean).join(", ");
    this.count.textContent = request.budget ? `Up to ${plural(request.budget, "candidate")}`
      : "As many candidates as a usual search takes";
    this.cost.textContent = `${plural(jobs, "job")} per candidate${units ? `; objectives in ${units}` : ""}.`;
  }

  rowOf(pointer) {
    const [, key, index] = pointer.split("/");
    if (["objectives", "bounds"].includes(key)) return `${key}.${index ?? 0}`;
    if (["method", ...numbers].includes(key)) return key;
    return rowOfVariable(pointer, this.state.over) || super.rowOf(pointer);
  }
}
