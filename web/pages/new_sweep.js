// A new sweep: a form made from the service's own description of its parameters.
import { Refusal, exampleLinkage, findSweep, parameterSchema, submitSweep } from "/core/api.js";
import { choice, h, notify } from "/core/dom.js";
import { bytes, plural, span } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { estimate, measureCosts } from "/form/estimate.js";
import { fieldRow } from "/form/field.js";
import { fieldsOf, pathOfPointer } from "/form/fields.js";
import { buildRequest, countJobs, emptyEntry, readRequest } from "/form/request.js";

// The study of the paper: every other parameter has the paper's value by default.
const paper = { name: "paper", sweep: { clearance_mm: [0, 0.25, 0.5], crank_velocity_rad_s: [5, 10, 12], coupler: ["rigid", "flexible"] } };
// Linkages that the program brings along, as sets of parameters.
const examples = [["rpsup", "RPSUP, described as data"], ["rsup", "RSUP, a spatial slider-crank"], ["slider_crank", "planar slider-crank, clearance at both ends of the rod"],
  ["four_bar", "four-bar with a flexible coupler"], ["bricard", "Bricard's linkage"]];
// What most studies are about; the others are one click away.
const first = ["clearance_mm", "crank_velocity_rad_s", "coupler", "duration_s", "run_up_s", "restitution", "integrator"];

export async function show(main, { query, signal }) {
  document.title = "RPSUP: new sweep";
  const fields = fieldsOf(await parameterSchema());
  const from = query.get("from");
  const example = examples.find(([name]) => name === query.get("linkage"))?.[0];
  const request = from ? (await findSweep(from, signal)).request : example ? { name: example, parameters: await exampleLinkage(example, signal) }
    : query.get("template") === "paper" ? paper : {};
  const form = new SweepForm(fields, readRequest(fields, request), example ?? "", signal);
  main.replaceChildren(...form.parts());
  form.update();
}

class SweepForm {
  constructor(fields, state, example, signal) {
    Object.assign(this, { fields, state, example, signal, costs: new Map(), rows: new Map() });
    this.defaults = Object.fromEntries(fields.map((field) => [field.path, field.default]));
    measureCosts(signal).then((costs) => { this.costs = costs; this.update(); }).catch(() => {});
  }

  parts() {
    const isFirst = (field) => first.includes(field.path);
    const inOrder = first.map((path) => this.fields.find((field) => field.path === path)).filter(Boolean);
    const filter = h("input", { type: "search", oninput: () => this.filter(filter.value) });
    const open = this.fields.some((field) => !isFirst(field) && this.state.entries[field.path]);
    this.rest = h("div", {}, this.fields.filter((field) => !isFirst(field)).map((field) => this.row(field)));
    const others = h("details", { open },
      h("summary", {}, "All other parameters"), h("label", { class: "choice" }, h("span", {}, "Filter"), filter), this.rest);
    return [h("h1", {}, "New sweep"),
      h("p", { class: "actions" }, h("a", { class: "button", href: routeTo("new", "", { template: "paper" }) }, "Take the paper's study"), h("a", { class: "button", href: "#/new" }, "Start empty"),
        choice("Take another linkage", [["", "choose …"], ...examples], this.example, (name) => { location.hash = routeTo("new", "", name ? { linkage: name } : {}); })),
      h("div", { class: "columns" },
        h("form", { class: "card", novalidate: true, onsubmit: (event) => { event.preventDefault(); this.submit(); } },
          this.text("Name", this.state, "name"), inOrder.map((field) => this.row(field)), others, this.linkage(), this.more()),
        h("aside", { class: "card sticky", "aria-label": "Summary" }, ...this.summary()))];
  }

  row(field) {
    this.state.entries[field.path] ??= emptyEntry();
    const row = fieldRow(field, this.state.entries[field.path], () => this.update());
    this.rows.set(field.path, row);
    return row.element;
  }

  text(label, object, key, attributes = {}) {
    const input = h("input", { type: "text", value: object[key], ...attributes, oninput: () => { object[key] = input.value; this.update(); } });
    return h("label", { class: "choice" }, h("span", {}, label), input);
  }

  linkage() {
    return h("details", { open: this.state.linkage + this.state.inside !== "" }, h("summary", {}, "Another linkage than RPSUP"),
      h("p", { class: "quiet small" }, "A described linkage has its own bodies, joints and drives; the parameters of the coupler, the crank, the rod and the guide above belong to RPSUP alone."),
      ...this.json("linkage", "Linkage: its bodies and joints, as a JSON object"),
      ...this.json("inside", "Axes over numbers inside it, as a JSON object of lists and ranges"));
  }

  more() {
    const { replicates } = this.state;
    return h("details", { open: this.state.cases + this.state.design !== "" || Number(replicates.count) > 1 }, h("summary", {}, "Replicates, cases, designs and order"),
      h("p", { class: "actions" }, this.text("Runs of each set", replicates, "count", { type: "number", min: 1 }), this.text("Relative perturbation of the contact stiffness", replicates, "perturbation"),
        this.text("Seed", replicates, "seed", { type: "number" }), this.text("Priority", this.state, "priority", { type: "number", min: -100, max: 100 }),
        choice("Results computed before", [["yes", "are used"], ["no", "are computed again"]], this.state.reuse ? "yes" : "no", (value) => { this.state.reuse = value === "yes"; this.update(); })),
      ...this.json("cases", "Cases: a JSON list of parameter sets, each times the axes"),
      ...this.json("design", "Design: points that are no grid, as a JSON object (latin_hypercube, sobol, zip, one_at_a_time, morris, saltelli), each times the axes"));
  }

  /// A part of the request that is written as JSON.
  json(key, label) {
    const fault = h("p", { class: "trouble small", hidden: true });
    const area = h("textarea", { rows: 3, class: "wide", value: this.state[key], oninput: () => { this.state[key] = area.value; this.update(); } });
    this.rows.set(key, { complain: (text) => { fault.textContent = text; fault.hidden = text === ""; } });
    return [h("label", { class: "choice" }, h("span", {}, label), area), fault];
  }

  summary() {
    this.count = h("p", { class: "big", role: "status" });
    this.cost = h("p", { class: "quiet small" });
    this.faults = h("div", { class: "trouble", role: "alert" });
    this.send = h("button", { class: "main", onclick: () => this.submit() }, "Submit");
    this.shown = h("code");
    this.curl = h("code");
    const copy = (label, code) => h("button", { onclick: () => navigator.clipboard.writeText(code.textContent).then(() => notify("Copied."), () => notify("The browser does not allow copying.", "trouble")) }, label);
    return [this.count, this.cost, this.faults, h("p", {}, this.send),
      h("h2", {}, "Request"), h("pre", { tabindex: 0 }, this.shown), h("p", { class: "actions" }, copy("Copy JSON", this.shown), copy("Copy as curl", this.curl)),
      h("details", {}, h("summary", {}, "As a curl command"), h("pre", { tabindex: 0 }, this.curl))];
  }

  filter(text) {
    const words = text.toLowerCase().split(/\s+/);
    for (const row of this.rest.children) row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
  }

  update() {
    const { request, problems } = buildRequest(this.fields, this.state);
    this.request = request;
    this.problems = problems;
    for (const row of this.rows.values()) row.complain("");
    for (const { path, detail } of problems) this.rows.get(path).complain(detail);
    const jobs = countJobs(request);
    this.count.textContent = plural(jobs, "job");
    this.cost.textContent = this.costText(jobs);
    this.send.disabled = problems.length > 0;
    this.faults.replaceChildren();
    this.shown.textContent = JSON.stringify(request, null, 1);
    this.curl.textContent = `curl -d '${JSON.stringify(request).replaceAll("'", "'\\''")}' ${location.origin}/v1/sweeps`;
  }

  costText(jobs) {
    const cost = estimate(this.request, this.defaults, jobs, this.costs);
    const store = `the store grows by about ${bytes(cost.bytes)}`;
    if (cost.unknown.length > 0) return `No time is known yet for: ${cost.unknown.join("; ")}. Of what is new, ${store}.`;
    return `About ${span(cost.seconds)} of computing on one core, as earlier jobs took; ${store}. What has been computed before costs nothing.`;
  }

  async submit() {
    if (this.problems.length > 0) return;
    this.send.disabled = true;
    try {
      const sweep = await submitSweep(this.request);
      location.hash = routeTo("sweeps", sweep.id);
    } catch (error) {
      this.send.disabled = false;
      this.refuse(error);
    }
  }

  refuse(error) {
    const faults = error instanceof Refusal && error.faults.length > 0 ? error.faults : [{ pointer: "", detail: error.message }];
    for (const { pointer, detail } of faults) this.rows.get(pathOfPointer(pointer, this.fields))?.complain(detail);
    this.faults.replaceChildren(h("ul", {}, faults.map(({ pointer, detail }) => h("li", {}, `${pointer ? `${pointer}: ` : ""}${detail}`))));
  }
}
