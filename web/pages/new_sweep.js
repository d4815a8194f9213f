// SPDX-License-Identifier: Apache-2.0
// A new sweep: a form made from the service's own description of its parameters.
import { addressOf, estimateSweep, exampleLinkage, findSweep, parameterSchema,
  submitSweep } from "/core/api.js";
import { choice, h } from "/core/dom.js";
import { plural } from "/core/format.js";
import { debounce, latest } from "/core/live.js";
import { routeTo } from "/core/route.js";
import { costWords } from "/form/estimate.js";
import { fieldsOf } from "/form/fields.js";
import { exampleNames, linkageGallery } from "/form/linkage_gallery.js";
import { buildRequest, isDescription, readRequest } from "/form/request.js";
import { RequestForm } from "/form/request_form.js";

const settleMs = 350;
const counting = "Counting …";

// The sweep of the paper, as script/paper.json: every other parameter has the paper's value by default.
const paper = { name: "paper", sweep: { clearance_mm: [0, 0.25, 0.5], crank_velocity_rad_s: [5, 10, 12, 15],
  coupler: ["rigid", "flexible"] },
  replicates: { count: 5, only: { clearance_mm: [0.25, 0.5], crank_velocity_rad_s: [15] } } };
/** @param {HTMLElement} main  @param {Visit} view */
export async function show(main, { query, signal }) {
  document.title = "RPSUP: new sweep";
  const fields = fieldsOf(await parameterSchema());
  const from = query.get("from");
  const example = exampleNames.find((name) => name === query.get("linkage"));
  const request = from ? (await findSweep(from, signal))
    .request : example ? { name: example, parameters: await exampleLinkage(example, signal) }
    : query.get("template") === "paper" ? paper : {};
  const form = new SweepForm(fields, readRequest(fields, request), example ?? "", signal);
  main.replaceChildren(...form.parts());
  form.update();
}

class SweepForm extends RequestForm {
  path = addressOf("/v1/sweeps");
  route = "sweeps";
  ask = submitSweep;

  /** @param {any[]} fields  @param {any} state  @param {string} example  @param {AbortSignal} signal */
  constructor(fields, state, example, signal) {
    super(fields, state);
    this.signal = signal;
    this.example = example;
    this.count.textContent = counting;
    this.estimate = latest((current) => this.#estimate(current), signal);
    this.estimateSoon = debounce(() => signal.aborted || this.estimate(), settleMs);
  }

  parts() {
    return [h("h1", {}, "New sweep"),
      h("p", { class: "actions" }, h("a", { class: "button", href: routeTo("new", "", { template: "paper" }) },
        "Load the paper's sweep"), h("a", { class: "button", href: "#/new" }, "Empty form")),
      linkageGallery(this.example || (isDescription(this.state.linkage) ? null : "")),
      this.columns(this.nameField(), this.otherLinkage(), ...this.parameterFields(), this.described(),
        this.more())];
  }

  more() {
    return h("details", { open: this.state.cases + this.state.design !== ""
      || Number(this.state.replicates.count) > 1 }, h("summary", {}, "Replicates, cases, design and priority"),
      h("p", { class: "actions" }, ...this.replicateFields(), ...this.orderFields(),
        choice("Trajectories", [["", "keep"], ["metrics", "only metrics"]], this.state.keep,
          (keep) => { this.state.keep = keep; this.update(); }), this.executorField()),
      ...this.json("cases", "Cases: JSON list of parameter sets, each combined with the axes"),
      ...this.json("design",
        "Design of experiments: JSON object (latin_hypercube, sobol, zip, one_at_a_time, morris, saltelli), combined "
          + "with the axes"));
  }

  build() {
    return buildRequest(this.fields, this.state);
  }

  /// Counts the jobs of a request that can be sent: the service counts, estimates, and finds what it would
  /// refuse.
  drawCount() {
    if (this.problems.length === 0) this.estimateSoon();
    else this.#tell("Number of jobs unknown", "");
  }

  /** @param {AbortSignal} current */
  async #estimate(current) {
    if (this.problems.length > 0) return;
    try {
      const estimate = await estimateSweep(this.request, current);
      if (this.problems.length === 0) this.#tell(plural(estimate.jobs, "job"), costWords(estimate));
    } catch (error) {
      if (error.name === "AbortError") throw error;
      if (this.isSending || this.problems.length > 0) return;
      this.#tell("Number of jobs unknown", "");
      this.refuse(error);
    }
  }

  #tell(count, cost) {
    this.count.textContent = count;
    this.cost.textContent = cost;
  }
}
