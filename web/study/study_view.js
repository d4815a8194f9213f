// SPDX-License-Identifier: Apache-2.0
// Base of the page of one study: charts side by side, a table and actions, kept up to date.
import { loadCharts, saveButtons } from "/core/charts.js";
import { confirmed } from "/core/dialog.js";
import { h, notify, setSeen, tellTrouble } from "/core/dom.js";
import { followStudy, inTurn, retryWhileUnreachable, throttle } from "/core/live.js";
import { routeTo } from "/core/route.js";

const reloadMs = 1000;

/// Shows a study. @param View  a StudyView of its kind
/**
 * @param {HTMLElement} main
 * @param {(new (study: any, signal: AbortSignal) => StudyView<any>) & Pick<typeof StudyView, "api">} View
 * @param {string} id
 * @param {AbortSignal} signal
 */
export async function showStudy(main, View, id, signal) {
  loadCharts().catch(() => {});  // told where a chart would be
  const view = new View(await View.api.find(id, signal), signal);
  await view.findMore();
  main.replaceChildren(...view.parts());
  await view.start();
}

/// Its kinds have `static api` and `static route`, and say what is drawn: charts, tableName, columns, statusText, row.
/** @template {Api.Search | Api.WearStudy | Api.Fit | Api.Optimisation} Kept */
export class StudyView {
  /** @type {AnyStudies} */
  static api;
  /** @type {string} */
  static route;

  tableName = "";
  /** @type {(Chart | null)[]} */
  drawn = [];
  status = h("p", { role: "status" });
  body = h("tbody");
  isRemoved = false;
  reloadTook = 0;
  /** @type {HTMLButtonElement} */
  cancel;
  /** @type {HTMLButtonElement} */
  retry;
  /** @type {HTMLButtonElement} */
  delete;

  /** @param {Kept} study  @param {AbortSignal} signal */
  constructor(study, signal) {
    this.study = study;
    this.signal = signal;
    this.makeButtons();
  }

  get kind() {
    return /** @type {typeof StudyView} */ (this.constructor);
  }

  get name() {
    return this.study.name || this.study.id;
  }

  /// Each chart: its title, the function that makes it, what stands above it, whether it takes the whole
  /// width.
  /**
   * @returns {{ title: string, above?: HTMLElement, wide?: boolean,
   *   make: (element: HTMLElement, view: any, signal: AbortSignal) => Promise<Chart> }[]}
   */
  charts() { return []; }
  /// Elements above the charts.
  /** @returns {HTMLElement[]} */
  intro() { return []; }
  /// Elements below the table.
  /** @returns {HTMLElement[]} */
  more() { return []; }
  /// Finds what is shown beside the study; called each time before that is drawn.
  async findMore() {}
  /// Columns of the table: [heading, "number" for numbers].
  /** @returns {string[][]} */
  columns() { return []; }
  /// Rows of the table, each an element.
  /** @returns {HTMLElement[]} */
  rows() { return []; }
  /// State of the study in words.
  statusText() { return ""; }
  /// Choices that depend on the study are made here, each time it is drawn.
  drawChoices() {}

  parts() {
    document.title = `RPSUP: ${this.name}`;
    this.places = this.charts()
      .map((chart) => ({ ...chart, element: h("div", { class: "chart tall" }) }));
    const cards = this.places.map(({ title, element, above }, index) => h("section", { class: "card" },
      h("div", { class: "head" }, h("h2", {}, title),
        saveButtons(() => this.drawn[index], () => `${this.name} ${title.toLowerCase()}`)), above, element));
    const isWide = (_, index) => Boolean(this.places?.[index].wide);
    return [
      h("div", { class: "head" }, h("div", {}, h("h1", {}, this.name), this.status), this.buttons), ...this.intro(),
      h("div", { class: "columns even" }, cards.filter((card, index) => !isWide(card, index))),
      ...cards.filter(isWide),
      h("section", { class: "card" }, h("h2", {}, this.tableName),
        h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": this.tableName },
        h("table", {}, h("thead", {},
          h("tr", {}, this.columns().map(([text, look]) => h("th", { scope: "col", class: look }, text)))),
          this.body))), ...this.more()];
  }

  async start() {
    this.draw();
    for (const { make, element } of this.places ?? []) {
      try {
        this.drawn.push(await make(element, this, this.signal));
      } catch (error) {
        this.drawn.push(null);
        element.replaceChildren(h("p", { class: "trouble" }, error.message));
      }
    }
    this.follow();
  }

  follow() {
    if (this.study.state !== "running" || this.signal.aborted) return;
    // A study that takes long to fetch is fetched rarely.
    const reload = throttle(() => this.reload(), () => Math.max(reloadMs, 10 * this.reloadTook));
    followStudy(this.kind.api, this.study.id, {
      // The end is shown with its answer.
      progress: ({ state, counts, progress }) => {
        if (state === "running" && this.study.state === "running") {
          Object.assign(this.study, { counts, progress });
          this.drawHead();
        }
        reload();
      },
      done: () => this.reload(),
    }, this.signal);
  }

  reload = inTurn(() => this.load());

  async load() {
    if (this.isRemoved) return;
    try {
      let start = 0;
      await retryWhileUnreachable(async () => {
        start = performance.now();
        this.study = /** @type {Kept} */ (await this.kind.api.find(this.study.id, this.signal));
        await this.findMore();
      }, tellTrouble, this.signal);
      this.draw();
      for (const chart of this.drawn) chart?.draw();
      this.reloadTook = performance.now() - start;
    } catch (error) {
      if (error.name !== "AbortError" && !this.isRemoved) tellTrouble(error.message);
    }
  }

  draw() {
    this.drawHead();
    this.drawChoices();
    this.body.replaceChildren(...this.rows());
  }

  drawHead() {
    const { state } = this.study;
    this.status.textContent = this.statusText();
    setSeen(this.cancel, state === "running");
    setSeen(this.retry, ["failed", "cancelled"].includes(state));
    setSeen(this.delete, state !== "running");
  }

  /// Once: a button that was made anew would lose the focus, and a click that has begun.
  makeButtons() {
    const { id, sweep_id: sweep } = this.study;
    const { api, route } = this.kind;
    /** @type {(text: string, run: (id: string) => Promise<unknown>) => HTMLButtonElement} */
    const act = (text, run) =>
      h("button", { class: "passing", onclick: () => run(id).then(() => this.reload()).then(() => this.follow())
        .catch((error) => notify(error.message, "trouble")) }, text);
    this.cancel = act("Cancel", api.cancel);
    this.retry = act("Retry", api.retry);
    this.delete = h("button", { class: "danger", onclick: () => this.remove() }, "Delete");
    this.buttons = h("p", { class: "actions" }, this.cancel, this.retry,
      h("a", { class: "button", href: api.resultsUrl(id, { format: "csv" }), download: `${this.name}.csv` }, "CSV"),
      h("a", { class: "button", href: routeTo("sweeps", sweep) }, "Jobs"),
      h("a", { class: "button", href: routeTo(route, "new", { from: id }) }, "Duplicate"), this.delete);
  }

  async remove() {
    if (!(await confirmed(`Delete “${this.name}”? Its jobs are deleted, too; results that other sweeps share stay.`,
      "Delete"))) return;
    this.isRemoved = true;  // a reload that is still to come would not find it
    try {
      await this.kind.api.remove(this.study.id);
      if (!this.signal.aborted) location.hash = routeTo(this.kind.route);
    } catch (error) {
      this.isRemoved = false;
      notify(error.message, "trouble");
    }
  }
}
