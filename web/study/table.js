// SPDX-License-Identifier: Apache-2.0
// The rows of a sweep as a table: sorted by any column, filtered, with the columns that one wants. Only the
// rows that are seen are drawn.
import { h, keepFocus } from "/core/dom.js";
import { number, plural, titleOf } from "/core/format.js";
import { defines } from "/core/quantities.js";
import { routeTo } from "/core/route.js";
import { columnChoice } from "/study/column_choice.js";
import { hasNumbers, sortedBy, valueOf, valuesOf } from "/study/data.js";
import { missingText } from "/study/missing.js";
import { filterOf } from "/study/row_filter.js";
import { RowWindow } from "/study/row_window.js";

const rowHeight = 36;  // pixels, as in the style sheet
const [widthOfBox, widthOfJob] = [68, 92];
const widthOfLetter = 9.5;
const [leastWidth, largestWidth] = [88, 400];

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
    this.onlySelected = false;
    /** @type {Map<string, string>} */
    this.filters = new Map();
    this.isFiltered = false;
    this.drawnHead = "";
    this.drawnHeadings = "";
    /** @type {number[]} */
    this.widths = [];  // of the columns that are shown, in pixels
    this.head = h("tr");
    this.filterRow = h("tr", { class: "filters" });
    this.body = h("tbody");
    this.columns = h("colgroup");
    this.where = h("span", { class: "quiet small", role: "status" });
    this.fault = h("p", { class: "trouble small", role: "alert" });
    const only = h("input",
      { type: "checkbox", onchange: () => { this.onlySelected = only.checked; this.draw(); } });
    this.filterButton = h("button", { "aria-expanded": "false", onclick: () => this.toggleFilters() },
      "Filter");
    this.choice = columnChoice({ all: () => this.allColumns(), titleOf: this.titleOf,
      changed: () => this.draw() });
    this.missing = h("p", { class: "quiet small", role: "note" });
    this.table = h("table", { class: "rows" }, this.columns, h("thead", {}, this.head), this.body);
    this.scroll = h("div", { class: "scroll rows", tabindex: 0, role: "region", "aria-label": "Results" },
      this.table);
    this.window = new RowWindow(this.scroll, this.body, { rowHeight, before: widthOfBox + widthOfJob,
      make: (row, place, from, to) => this.row(row, place, from, to) });
    this.element = h("div", {}, this.missing,
      h("p", { class: "actions" }, this.choice.element, this.filterButton,
        h("label", {}, only, " Selected only"), this.where),
      this.fault, this.scroll);
  }

  sortBy(column) {
    const again = this.order.column === column;
    this.order = { column, descending: again ? !this.order.descending : false };
    this.scroll.scrollTop = 0;
    this.draw();
  }

  toggleFilters() {
    this.isFiltered = !this.isFiltered;
    this.filterButton.setAttribute("aria-expanded", String(this.isFiltered));
    if (!this.isFiltered) this.filters.clear();
    this.draw();
    this.filterRow.querySelector("input")?.focus();
  }

  /// All columns but those of the selection and of the job: state, axes, the metric, other metrics.
  allColumns() {
    const { axes, metrics, view, rows } = this.sweep;
    return ["state", ...axes, ...(rows.some((row) => row.replicate !== undefined) ? ["replicate"] : []),
      view.metric, ...metrics.filter((metric) => metric !== view.metric)];
  }

  draw() {
    this.choice.draw();
    this.shown = this.choice.shown();
    this.drawMissing();
    const rows = this.visible();
    keepFocus(this.table, () => {
      this.drawHead();
      this.window.show(rows, this.widths);
    });
    this.table.setAttribute("aria-rowcount", String(rows.length + 1));
    const { length } = this.sweep.rows;
    this.where.textContent = rows.length === length ? plural(length, this.noun)
      : `${rows.length.toLocaleString("en")} of ${plural(length, this.noun)}`;
  }

  drawHead() {
    const headings = [h("th", { scope: "col" }, "Select"), h("th", { scope: "col" }, "Job"),
      ...(this.shown ?? []).map((column) => this.heading(column))];
    const texts = headings.map(({ outerHTML }) => outerHTML).join("");
    if (texts !== this.drawnHeadings) this.head.replaceChildren(...headings);
    this.drawnHeadings = texts;
    // Made anew, the field that is typed into would lose the focus.
    const drawn = JSON.stringify([this.isFiltered, this.shown]);
    if (drawn === this.drawnHead) return;
    this.drawnHead = drawn;
    this.widths = (this.shown ?? []).map((column) => this.widthOf(column));
    const all = [widthOfBox, widthOfJob, ...this.widths];
    this.columns.replaceChildren(...all.map((width) => h("col", { width })));
    this.table.style.width = `${all.reduce((sum, width) => sum + width, 0)}px`;
    this.table.setAttribute("aria-colcount", String(all.length));
    this.filterRow.remove();
    this.filterRow.replaceChildren(h("td", { colspan: 2 }), ...(this.shown
      ?? []).map((column) => this.filterCell(column)));
    if (this.isFiltered) this.head.after(this.filterRow);
  }

  /// Width of a column in pixels: as its longest word or value needs, so that no column moves while others
  /// are drawn.
  /** @param {string} column */
  widthOf(column) {
    const { rows } = this.sweep;
    const some = this.isNumeric(column) ? [] : valuesOf(rows, column).slice(0, 1000);
    const longest = Math.max(0, ...some.map((value) => String(value).length));
    const word = Math.max(...this.titleOf(column).split(" ").map(({ length }) => length));
    const reason = column === "state" && some.includes("failed") ? largestWidth : 0;
    return Math.min(largestWidth, Math.max(leastWidth, reason, widthOfLetter * Math.max(longest, word) + 20));
  }

  /// Shows why jobs that succeeded have no value of the metric.
  drawMissing() {
    this.missing.textContent = missingText(this.sweep);
    this.missing.hidden = this.missing.textContent === "";
  }

  visible() {
    const { rows, selection } = this.sweep;
    const tests = this.tests();
    const wanted = rows.filter((row) => (!this.onlySelected || selection.has(row.job_id))
      && tests.every((passes) => passes(row)));
    return this.order.column ? sortedBy(wanted, this.order.column, this.order.descending) : wanted;
  }

  /// Tests of the filters of the columns that are shown. A faulty one is said, and leaves all rows.
  tests() {
    /** @type {string[]} */
    const faults = [];
    const shown = [...this.filters].filter(([column]) => this.shown?.includes(column));
    const tests = shown.map(([column, text]) => {
      try {
        return filterOf(column, text, this.isNumeric(column));
      } catch (error) {
        faults.push(`${this.titleOf(column)}: ${error.message}`);
        return null;
      }
    });
    this.fault.textContent = faults.join(". ");
    return tests.filter((test) => test !== null);
  }

  /** @param {string} column */
  isNumeric(column) {
    return hasNumbers(this.sweep.rows, column);
  }

  /// Numbers stand below each other at their last digit, and their heading there, too.
  lookOf(column) {
    return this.isNumeric(column) ? "number" : null;
  }

  heading(column) {
    const sorted = this.order.column === column;
    const arrow = sorted ? (this.order.descending ? " ▼" : " ▲") : "";
    const { metrics } = this.sweep;
    return h("th", { scope: "col", class: this.lookOf(column),
      "aria-sort": sorted ? (this.order.descending ? "descending" : "ascending") : null },
      h("button", { "data-key": column, ...(metrics.includes(column) ? defines("metrics", column) : {}),
        onclick: () => this.sortBy(column) }, `${this.titleOf(column)}${arrow}`));
  }

  /** @param {string} column */
  filterCell(column) {
    const input = h("input", { type: "text", value: this.filters.get(column) ?? "",
      "aria-label": `Filter ${this.titleOf(column)}`, placeholder: this.isNumeric(column) ? "> 5"
        : "part of it",
      oninput: () => { this.filters.set(column, input.value); this.scroll.scrollTop = 0; this.draw(); } });
    return h("td", {}, input);
  }

  /// Row with the cells of some columns, and one cell each for those before and after them.
  /** @param {Api.Row} row  @param {number} place  @param {number} from  @param {number} to */
  row(row, place, from, to) {
    const { selection } = this.sweep;
    const box = h("input",
      { type: "checkbox", "data-key": `box ${row.job_id}`, "aria-label": `Select ${row.job_id}`,
        onchange: () => selection.toggle([row.job_id]) });
    box.checked = selection.has(row.job_id);
    return h("tr", { class: box.checked ? "selected" : null, "aria-rowindex": place + 2 }, h("td", {}, box),
      h("td", { class: "fixed" }, h("a", { href: routeTo("jobs", row.job_id), "data-key": row.job_id },
        `…${row.job_id.slice(-5)}`)),
      this.gap(from), (this.shown ?? []).slice(from, to).map((column, k) => this.cell(row, column, from + k)),
      this.gap(this.widths.length - to));
  }

  /// Empty cell as wide as so many columns.
  /** @param {number} count */
  gap(count) { return count > 0 ? h("td", { colspan: count, "aria-hidden": "true" }) : null; }

  /** @param {Api.Row} row  @param {string} column  @param {number} index */
  cell(row, column, index) {
    const value = valueOf(row, column);
    if (column === "state") return this.stateCell(row);
    const given = this.sweep.axes.includes(column);
    return h("td", { class: this.lookOf(column) ?? "cut", "aria-colindex": index + 3 }, number(value, given ? 6 : 4));
  }

  /** @param {Api.Row} row */
  stateCell({ job_id: id, state }) {
    const error = state === "failed" && this.sweep.failures.of(id);
    if (!error) return h("td", { class: state }, state);
    return h("td", { class: `cut ${state}`, title: `${error.error_reason}: ${error.error_detail}` },
      `${state}: ${error.error_reason} `,
      h("span", { class: "reason" }, error.error_detail));
  }
}
