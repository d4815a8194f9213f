// SPDX-License-Identifier: Apache-2.0
// The rows of a sweep as a table: sorted by any column, a page at a time.
import { h } from "/core/dom.js";
import { number, titleOf } from "/core/format.js";
import { defines } from "/core/quantities.js";
import { routeTo } from "/core/route.js";
import { sortedBy, valueOf, valuesOf } from "/study/data.js";
import { missingText } from "/study/missing.js";

const pageSize = 50;

export class ResultTable {
  /// @param noun     for a row
  /// @param titleOf  of a column
  /**
   * @param {SweepPage} sweep
   * @param {{ noun?: string, titleOf?: (column: string) => string }} more
   */
  constructor(sweep, { noun = "job", titleOf: titleOfColumn = titleOf } = {}) {
    this.sweep = sweep;
    this.noun = noun;
    this.titleOf = titleOfColumn;
    this.order = { column: "", descending: false };
    this.page = 0;
    this.onlySelected = false;
    this.head = h("tr");
    this.body = h("tbody");
    this.where = h("span", { class: "quiet small" });
    this.back = h("button", { onclick: () => this.turn(-1) }, "Previous");
    this.next = h("button", { onclick: () => this.turn(1) }, "Next");
    const only = h("input",
      { type: "checkbox", onchange: () => { this.onlySelected = only.checked; this.page = 0; this.draw(); } });
    this.missing = h("p", { class: "quiet small", role: "note" });
    this.element = h("div", {}, this.missing,
      h("p", { class: "actions" }, this.back, this.next, this.where, h("label", {}, only, " Selected only")),
      h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Results" },
        h("table", {}, h("thead", {}, this.head), this.body)));
  }

  turn(by) {
    this.page += by;
    this.draw();
  }

  sortBy(column) {
    const again = this.order.column === column;
    this.order = { column, descending: again ? !this.order.descending : false };
    this.page = 0;
    this.draw();
    /** @type {HTMLElement | null} */
    const heading = this.head.querySelector(`[data-column="${CSS.escape(column)}"]`);
    heading?.focus();
  }

  draw() {
    const { axes, metrics, view } = this.sweep;
    const columns = ["state", ...axes,
      ...(this.sweep.rows.some((row) => row.replicate !== undefined) ? ["replicate"] : []),
      view.metric, ...metrics.filter((metric) => metric !== view.metric)];
    this.head.replaceChildren(h("th", { scope: "col" }, "Select"), h("th", { scope: "col" }, "Job"),
      ...columns.map((column) => this.heading(column)));
    this.drawMissing();
    const rows = this.visible();
    const pages = Math.max(1, Math.ceil(rows.length / pageSize));
    this.page = Math.min(Math.max(this.page, 0), pages - 1);
    this.body.replaceChildren(...rows.slice(this.page * pageSize, (this.page + 1) * pageSize)
      .map((row) => this.row(row, columns)));
    this.back.disabled = this.page === 0;
    this.next.disabled = this.page >= pages - 1;
    this.where.textContent = `Page ${this.page + 1} of ${pages}, ${rows.length.toLocaleString("en")} `
      + `of ${this.sweep.rows.length.toLocaleString("en")} ${this.noun}s`;
  }

  /// Shows why jobs that succeeded have no value of the metric.
  drawMissing() {
    this.missing.textContent = missingText(this.sweep);
    this.missing.hidden = this.missing.textContent === "";
  }

  visible() {
    const { rows, selection } = this.sweep;
    const wanted = this.onlySelected ? rows.filter((row) => selection.has(row.job_id)) : rows;
    return this.order.column ? sortedBy(wanted, this.order.column, this.order.descending) : wanted;
  }

  /// Numbers stand below each other at their last digit, and their heading there, too.
  lookOf(column) {
    return valuesOf(this.sweep.rows, column).some((value) => typeof value === "number") ? "number" : null;
  }

  heading(column) {
    const sorted = this.order.column === column;
    const arrow = sorted ? (this.order.descending ? " ▼" : " ▲") : "";
    const { metrics } = this.sweep;
    return h("th", { scope: "col", class: this.lookOf(column),
      "aria-sort": sorted ? (this.order.descending ? "descending" : "ascending") : null },
      h("button", { "data-column": column, ...(metrics.includes(column) ? defines("metrics", column) : {}),
        onclick: () => this.sortBy(column) }, `${this.titleOf(column)}${arrow}`));
  }

  /** @param {Api.Row} row  @param {string[]} columns */
  row(row, columns) {
    const { selection } = this.sweep;
    const box = h("input",
      { type: "checkbox", "aria-label": `Select ${row.job_id}`, onchange: () => selection.toggle([row.job_id]) });
    box.checked = selection.has(row.job_id);
    return h("tr", { class: box.checked ? "selected" : null }, h("td", {}, box),
      h("td", { class: "fixed" }, h("a", { href: routeTo("jobs", row.job_id) }, `…${row.job_id.slice(-5)}`)),
      columns.map((column) => this.cell(row, column)));
  }

  /** @param {Api.Row} row  @param {string} column */
  cell(row, column) {
    const value = valueOf(row, column);
    if (column === "state") return this.stateCell(row);
    const given = this.sweep.axes.includes(column);
    return h("td", { class: this.lookOf(column) }, number(value, given ? 6 : 4));
  }

  /** @param {Api.Row} row */
  stateCell({ job_id: id, state }) {
    const error = state === "failed" && this.sweep.failures.of(id);
    return h("td", { class: state },
      error ? [`${state}: ${error.error_reason}`, h("span", { class: "small reason" }, error.error_detail)] : state);
  }
}
