// SPDX-License-Identifier: Apache-2.0
// A new fit: measurements with their windows and channels, variables, and how the fit goes on.
import { fits, listMeasurements } from "/core/api.js";
import { h } from "/core/dom.js";
import { plural } from "/core/format.js";
import { FittedMeasurements } from "/form/fitted_measurements.js";
import { StudyForm } from "/form/study_form.js";
import { addVariables, readVariables, rowOfVariable, variableFields } from "/form/variable_fields.js";

const numbers = ["budget", "population", "samples", "replicates", "seed"];
const mostOffered = 200;
/** @typedef {Api.Body<"/v1/fits">} Request */
/** @type {Record<NonNullable<Request["basis"]>, string>} */
const bases = { by_divergence: "by the divergence of the motion", point_wise: "samples",
  features: "features" };
/** @type {Record<NonNullable<Request["intervals"]>, string>} */
const intervals = { profile: "profile likelihood", linearised: "linearised model, which takes fewer jobs" };
const usual = { basis: "by_divergence", intervals: "profile" };  // left out of a request

export class FitForm extends StudyForm {
  static api = fits;
  static route = "fits";
  static title = "New fit";
  static schema = "FitRequest";

  /// The measurements that can be chosen.
  /** @param {AbortSignal} signal */
  static async load(signal) {
    return (await listMeasurements({ limit: mostOffered }, signal)).items;
  }

  constructor(fields, schemas, request, known) {
    // "replicates" of a fit is a number.
    super(fields, schemas, { ...request, replicates: undefined });
    this.known = known;
    this.state.values.replicates = request.replicates === undefined ? "" : String(request.replicates);
    this.state.over = readVariables(request.over);
    this.state.values.basis ||= usual.basis;
    this.state.values.intervals ||= usual.intervals;
    this.measured = new FittedMeasurements(this, known, request.measurements ?? []);
  }

  parts() {
    const { over, values } = this.state;
    const channels = [...new Set(this.known.flatMap((each) => each.channels.map(({ name }) => name)))];
    const paths = [...this.fields.filter(({ kind }) => kind === "number").map(({ path }) => path),
      ...channels.flatMap((channel) =>
        ["gain", "offset", "delay_s"].map((key) => `sensor.${channel}.${key}`))];
    return [this.nameField(), this.measured.element(), ...variableFields(this, over, paths,
      "Parameters that are looked for, between two bounds. sensor.CHANNEL.gain, .offset and .delay_s are "
        + "quantities of "
        + "a sensor; runs.1.PATH is a parameter of run 1 alone."),
    h("h2", {}, "Method"),
    this.told("basis", "Compared", values, "basis", "Samples suit motions that do not diverge, features "
      + "all others",
      Object.entries(bases)),
    this.told("intervals", "Intervals", values, "intervals", "95 % intervals of the values",
      Object.entries(intervals)),
    ...numbers.map((key) => this.number(key)),
    h("h2", {}, "Linkage"),
      h("p", { class: "quiet small" }, "Parameters that are known. Those of the measured runs need "
      + "not be given; duration and output rate follow from the samples."),
    ...this.parameterFields(), this.linkage(),
    h("details", {}, h("summary", {}, "Priority"), h("p", { class: "actions" }, ...this.orderFields(),
      this.executorField()))];
  }

  build() {
    const { request: { name, parameters, sweep = {}, priority, reuse, executor },
      problems } = this.buildCommon();
    for (const path of Object.keys(sweep)) {
      problems.push({ path, detail: "must have a single value in a fit" });
    }
    const { basis, intervals: kind } = this.state.values;
    /** @type {any} */
    const request = { name, parameters };
    addVariables(this.state.over, request, problems);
    request.measurements = this.measured.build(problems);
    if (basis !== usual.basis) request.basis = basis;
    if (kind !== usual.intervals) request.intervals = kind;
    this.addNumbers(numbers, request, problems);
    return { request: JSON.parse(JSON.stringify({ ...request, priority, reuse, executor })), problems };
  }

  drawCount({ over, measurements, budget }) {
    this.count.textContent = plural(Object.keys(over).length, "variable");
    this.cost.textContent = `Fitted to ${plural(measurements.length, "measurement")}, with at most `
      + `${(budget ?? 2000).toLocaleString("en")} points. A point has a job for each fitted run.`;
  }

  rowOf(pointer) {
    const [, key] = pointer.split("/");
    if (key === "measurements") return this.measured.rowOf(pointer);
    if ([...numbers, "basis", "intervals"].includes(key)) return key;
    return rowOfVariable(pointer, this.state.over) || super.rowOf(pointer);
  }
}
