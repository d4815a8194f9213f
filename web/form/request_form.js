// SPDX-License-Identifier: Apache-2.0
// Base of the forms of sweeps and studies: fields of parameters, request, and refusals of the service.
import { Refusal } from "/core/api.js";
import { choice, freshId, h, notify } from "/core/dom.js";
import { nameOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { fieldRow } from "/form/field.js";
import { isOfRpsup, pathOfPointer, writtenAsJson } from "/form/fields.js";
import { jsonText } from "/form/json_text.js";
import { LinkageEditor } from "/form/linkage_editor.js";
import { clearancesIn, emptyEntry, isDescription, isIdle } from "/form/request.js";

// Parameters that are shown at first; the others are one click away.
const first = ["clearance_mm", "crank_velocity_rad_s", "coupler", "duration_s", "run_up_s", "restitution",
  "integrator"];

/// Its kinds say what is asked (path, ask, route), make the request (build) and the text above it (drawCount).
export class RequestForm {
  /// Request's path at the service, and route of its result in the page.
  path = "";
  route = "";
  /** @type {(request: any) => Promise<{ id: string }>} */
  ask;
  /// Rows of the form by the names of their fields; a row shows its fault.
  /** @type {Map<string, { complain: (text: string) => void, rename?: (text: string) => void }>} */
  rows = new Map();
  /** @type {any} */
  request = {};
  /** @type {{ path: string, detail: string }[]} */
  problems = [];
  isSending = false;
  /** @type {AbortSignal} */
  signal = new AbortController().signal;
  /** @type {LinkageEditor | null} */
  editor = null;
  form = h("form", { class: "card", novalidate: true,
    onsubmit: (event) => { event.preventDefault(); this.submit(); } });
  rest = h("div");
  count = h("p", { class: "big", role: "status" });
  cost = h("p", { class: "quiet small" });
  faults = h("div", { class: "trouble", role: "alert" });
  blocked = h("p", { class: "trouble small", role: "status" });
  send = h("button", { class: "main", onclick: () => this.submit() }, "Submit");
  shown = h("code");
  curl = h("code");

  /// @param fields  of the parameters
  /// @param state   what stands in the form: {name, priority, reuse, linkage, replicates, entries: {path: entry}, ...}
  /** @param {any[]} fields  @param {any} state */
  constructor(fields, state) {
    this.fields = fields;
    this.state = state;
  }

  /// The request, and what keeps it from being one.
  /** @returns {{ request: any, problems: { path: string, detail: string }[] }} */
  build() { return { request: {}, problems: [] }; }

  /// Shows the size of a request.
  /** @param {any} _request */
  drawCount(_request) {}

  /// The fields that are shown first, and all others behind a heading.
  parameterFields() {
    const isFirst = (field) => first.includes(field.path);
    const inOrder = first.map((path) => this.fields.find((field) => field.path === path)).filter(Boolean);
    const filter = h("input", { type: "search", oninput: () => this.filter(filter.value) });
    const open = this.fields.some((field) => !isFirst(field) && this.state.entries[field.path]);
    this.rest.append(...this.fields.filter((field) => !isFirst(field)).map((field) => this.row(field)));
    return [inOrder.map((field) => this.row(field)),
      h("details", { open }, h("summary", {}, "All other parameters"),
        h("label", { class: "choice" }, h("span", {}, "Filter"), filter), this.rest)];
  }

  /// The form beside its summary.
  columns(...parts) {
    this.form.append(...parts.flat());
    return h("div", { class: "columns" }, this.form,
      h("aside", { class: "card sticky", "aria-label": "Summary" }, ...this.summary()));
  }

  row(field) {
    this.state.entries[field.path] ??= emptyEntry();
    const row = fieldRow(field, this.state.entries[field.path], () => this.update());
    this.rows.set(field.path, row);
    if (isOfRpsup(field.path)) row.element.dataset.of = "rpsup";
    return row.element;
  }

  nameField() {
    return this.text("Name", this.state, "name", { size: 40 });
  }

  text(label, object, key, attributes = {}) {
    const input = h("input",
      { type: "text", value: object[key], ...attributes,
        oninput: () => { object[key] = input.value; this.update(); } });
    return h("label", { class: "choice" }, h("span", {}, label), input);
  }

  /// A value with help below it, and a place for its fault.
  /// @param name  of the row  @param options  to choose among; null: any text
  /// @param known  texts that are proposed
  /**
   * @param {string} name
   * @param {string} label
   * @param {any} object
   * @param {string} key
   * @param {string} help
   * @param {string[][] | null} options
   * @param {string[][]} known
   */
  told(name, label, object, key, help, options = null, known = []) {
    const id = freshId("told");
    const listen = { oninput: () => { object[key] = input.value; this.update(); } };
    const attributes = { id, "aria-describedby": `${id}-help ${id}-fault`, ...listen };
    const input = options ? h("select", attributes, options.map(([value, text]) => h("option", { value }, text)))
      : h("input", { type: "text", ...attributes, list: known.length > 0 ? `${id}-known` : undefined });
    const list = known.length === 0 ? ""
      : h("datalist", { id: `${id}-known` }, known.map(([value, text]) => h("option", { value }, text)));
    input.value = object[key];
    const fault = h("p", { class: "trouble small", id: `${id}-fault`, hidden: true });
    const labelled = h("label", { for: id }, label);
    this.rows.set(name, { rename: (text) => { labelled.textContent = text; }, complain: (text) => {
      fault.textContent = text;
      fault.hidden = text === "";
      input.setAttribute("aria-invalid", text === "" ? "false" : "true");
    } });
    return h("div", { class: known.length > 0 ? "field named" : "field" }, labelled, h("span"),
      h("div", { class: "values" }, input, list),
      h("p", { class: "quiet small", id: `${id}-help` }, help), fault);
  }

  linkage() {
    return h("div", {}, this.described(), this.otherLinkage());
  }

  described() {
    return h("details", { open: this.state.described !== "" },
      h("summary", {}, "Other drives, worn bore and kept results"),
      ...this.json("described", `JSON object of ${writtenAsJson.join(", ")}`));
  }

  otherLinkage() {
    const change = (text) => { this.state.linkage = text; this.update(); };
    this.editor = new LinkageEditor(this.state.linkage, change, (pointer) => this.goTo(pointer), this.signal);
    this.rows.set("linkage", this.editor);
    return h("details", { open: this.state.linkage + this.state.inside !== "" }, h("summary", {}, "Custom linkage"),
      h("p", { class: "quiet small" }, "A custom linkage has its own bodies, joints and drives. "
        + "The parameters of RPSUP's coupler, crank, rod and guide do not apply to it and are hidden, as are "
        + "those of the contact where no joint with clearance takes them."),
      this.editor.element,
      ...this.json("inside", "Axes inside the linkage: JSON object of lists and ranges"));
  }

  /// Puts the cursor into the field that a pointer of the service means.
  /** @param {string} pointer */
  goTo(pointer) {
    const row = this.form.querySelector(`[data-path="${CSS.escape(this.rowOf(pointer))}"]`);
    /** @type {HTMLElement | null | undefined} */
    const input = row?.querySelector("input, select");
    input?.focus();
  }

  /// A part of the request that is written as JSON.
  json(key, label) {
    const fault = h("p", { class: "trouble small", hidden: true });
    const area = h("textarea",
      { rows: 3, class: "wide", value: this.state[key],
        oninput: () => { this.state[key] = area.value; this.update(); } });
    this.rows.set(key, { complain: (text) => { fault.textContent = text; fault.hidden = text === ""; } });
    return [h("label", { class: "choice" }, h("span", {}, label), area), fault];
  }

  replicateFields() {
    const { replicates } = this.state;
    return [this.text("Replicates", replicates, "count", { type: "number", min: 1 }),
      this.text("Relative perturbation of the contact stiffness", replicates, "perturbation"),
      this.text("Tolerance factor of replicates 1, 2, …", replicates, "tolerance_factor"),
      this.text("Seed", replicates, "seed", { type: "number" }),
      this.text("Values with replicates (JSON; empty: all)", replicates, "only", { size: 40 })];
  }

  orderFields() {
    return [this.text("Priority", this.state, "priority", { type: "number", min: -100, max: 100 }),
      choice("Stored results", [["yes", "reuse"], ["no", "recompute"]], this.state.reuse ? "yes" : "no",
        (value) => { this.state.reuse = value === "yes"; this.update(); })];
  }

  executorField() {
    return choice("Executor", [["", "the usual one"], "local", "slurm"], this.state.executor,
      (name) => { this.state.executor = name; this.update(); });
  }

  summary() {
    // Browsers have a clipboard for pages of https and of the own machine only.
    const write = (text) => navigator.clipboard?.writeText(text) ?? Promise.reject(new Error("no clipboard"));
    const refused = () => notify("The browser does not allow copying.", "trouble");
    const copy = (label, code) => h("button",
      { onclick: () => write(code.textContent).then(() => notify("Copied."), refused) }, label);
    return [this.count, this.cost, this.faults, this.blocked, h("p", {}, this.send),
      h("h2", {}, "Request"), h("pre", { tabindex: 0 }, this.shown),
      h("p", { class: "actions" }, copy("Copy JSON", this.shown), copy("Copy as curl", this.curl)),
      h("details", {}, h("summary", {}, "curl command"), h("pre", { tabindex: 0 }, this.curl))];
  }

  filter(text) {
    const words = text.toLowerCase().split(/\s+/);
    for (const row of /** @type {Iterable<HTMLElement>} */ (this.rest.children)) {
      row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
    }
  }

  update() {
    const { request, problems } = this.build();
    this.request = request;
    this.problems = problems;
    for (const row of this.rows.values()) row.complain("");
    for (const { path, detail } of problems) this.rows.get(path)?.complain(detail);
    this.form.classList.toggle("described", isDescription(this.state.linkage));
    const clearances = clearancesIn(this.state.linkage);
    for (const row of /** @type {NodeListOf<HTMLElement>} */ (this.form.querySelectorAll("[data-path]"))) {
      row.toggleAttribute("data-idle", isIdle(row.dataset.path ?? "", clearances));
    }
    this.editor?.update(request.parameters);
    this.drawCount(request);
    this.drawSend();
    this.drawBlocked();
    this.faults.replaceChildren(...problems.filter(({ path }) => !this.rows.has(path))
      .map(({ path, detail }) => h("p", {}, `${path}: ${detail}`)));
    this.shown.textContent = jsonText(request);
    this.curl.textContent = "curl -d "
      + `'${JSON.stringify(request).replaceAll("'", "'\\''")}' ${location.origin}${this.path}`;
  }

  /// Names the fields that keep the request from being sent; each of them says why.
  drawBlocked() {
    const atFields = [...new Set(this.problems.map(({ path }) => path).filter((path) => this.rows.has(path)))];
    this.blocked.textContent = atFields.length === 0 ? ""
      : `Not ready to submit: see ${atFields.map((path) => nameOf(path)).join(", ")}.`;
  }

  drawSend() {
    this.send.disabled = this.isSending || this.problems.length > 0;
  }

  /// One request at a time, also where a field is changed or Enter pressed while it is under way.
  async submit() {
    if (this.isSending || this.problems.length > 0) return;
    this.isSending = true;
    this.drawSend();
    try {
      const { id } = await this.ask(this.request);
      if (this.signal.aborted) notify(`Submitted: ${id}`);
      else location.hash = routeTo(this.route, id);
    } catch (error) {
      this.isSending = false;
      this.drawSend();
      if (this.signal.aborted) notify(error.message, "trouble");
      else this.refuse(error);
    }
  }

  /// The name of the row that a pointer into the request means.
  /** @param {string} pointer  @returns {string} */
  rowOf(pointer) {
    return pathOfPointer(pointer, this.fields);
  }

  /** @param {Error} error */
  refuse(error) {
    const faults = error instanceof Refusal && error.faults.length > 0 ? error.faults
      : [{ pointer: "", detail: error.message }];
    for (const { pointer, detail } of faults) this.rows.get(this.rowOf(pointer))?.complain(detail);
    this.faults.replaceChildren(
      h("ul", {}, faults.map(({ pointer, detail }) => h("li", {}, `${pointer ? `${pointer}: ` : ""}${detail}`))));
  }
}
