// SPDX-License-Identifier: Apache-2.0
// One sweep: its metrics over its axes, in parts that share what is selected.
import { cancelSweep, deleteSweep, findResults, findSweep, parameterSchema, reportUrl, resultsUrl,
  retrySweep } from "/core/api.js";
import { saveButtons, warmUpCharts } from "/core/charts.js";
import { confirmed } from "/core/dialog.js";
import { h, notify, setSeen, tellTrouble } from "/core/dom.js";
import { plural, span } from "/core/format.js";
import { follow, inTurn, isUnderWay, latest, pause, retryWhileUnreachable, throttle } from "/core/live.js";
import { rememberQuery, routeTo } from "/core/route.js";
import { bearsOnPaper, drawSummary } from "/analysis/paper.js";
import { drawChosen } from "/study/chosen.js";
import { configurationCard } from "/study/configuration.js";
import { curveChoice } from "/study/curve_choice.js";
import { metricsOf } from "/study/data.js";
import { extendDialog, extendableAxes } from "/study/extend_sweep.js";
import { Failures } from "/study/failures.js";
import { drawHeadlines } from "/study/headlines.js";
import { heatMap } from "/study/heat_map.js";
import { linesChart } from "/study/lines.js";
import { logBoxes } from "/study/log_axes.js";
import { parallelChart } from "/study/parallel.js";
import { scatterChart, scatterChoice } from "/study/scatter.js";
import { SeenCharts } from "/study/seen_charts.js";
import { Selection } from "/study/selection.js";
import { drawPickers } from "/study/sweep_pickers.js";
import { editLabels, tagBadges } from "/study/sweep_labels.js";
import { studyBadge } from "/study/sweep_row.js";
import { queryOf, viewFrom } from "/study/sweep_view.js";
import { ResultTable } from "/study/table.js";

const reloadMs = 1500;
const lookMs = 4000;

/** @param {HTMLElement} main  @param {Visit} view */
export async function show(main, { id, query, signal }) {
  warmUpCharts().catch(() => {});  // told where a chart would be
  // Without the schema only a sentence on missing values knows less.
  const schemaIfAny = parameterSchema().catch(() => ({ properties: {} }));
  const given = Promise.all([findResults(id, {}, signal), schemaIfAny]);
  given.catch(() => {});  // told below, also if there is no such sweep
  const sweep = await findSweep(id, signal);
  showWhatComes(main, sweep);
  const [rows, schema] = await given;
  const page = new SweepPage(sweep, rows, schema, query, signal);
  main.replaceChildren(...page.parts());
  page.start();
  const other = query.get("with");
  if (other) await page.compareWith(other);
}

/// The name of the sweep, while its rows are on their way.
/** @param {HTMLElement} main  @param {Api.Sweep} sweep */
function showWhatComes(main, { id, name, counts }) {
  main.replaceChildren(h("h1", {}, name || id),
    h("p", { class: "quiet loading", role: "status" }, `Loading ${plural(counts.total, "job")} …`));
}

/// Sweep that stands beside another one.
/** @param {string} id  @param {AbortSignal} signal */
async function findComparison(id, signal) {
  const [sweep, rows] = await Promise.all([findSweep(id, signal), findResults(id, {}, signal)]);
  return { id, name: sweep.name || sweep.id, axes: sweep.axes, rows };
}

export class SweepPage {
  selection = new Selection();
  failures = new Failures();
  /** @type {{ id: string, name: string, axes: string[], rows: Api.Row[] } | null} */
  others = null;  // the sweep beside it, thin and with hollow marks
  title = h("h1");
  tags = h("p", { class: "small" });
  notes = h("p", { class: "notes" });
  csv = h("a", { class: "button" }, "CSV");
  status = h("p", { role: "status" });
  chosen = h("p", { class: "actions card" });
  pickers = h("p", { class: "actions" });
  compare = h("span");
  heat = h("div", { class: "chart tall" });
  lines = h("div", { class: "chart tall" });
  parallel = h("div", { class: "chart tall" });
  scatter = h("div", { class: "chart tall" });
  headlines = h("ul", { class: "headlines card", hidden: true });
  help = h("p", { class: "quiet small" });
  optimise = h("a", { class: "button" }, "Optimise");
  report = h("a", { class: "button" }, "Report");
  remove = h("button", { class: "danger", onclick: () => this.removeIt() }, "Delete");
  isFollowed = false;
  /** @type {HTMLButtonElement} */
  cancel;
  /** @type {HTMLButtonElement} */
  retry;
  /// Puts another sweep beside it, or none: "".
  /** @type {(id: string) => Promise<void>} */
  compareWith;
  reloadTook = 0;
  reload = inTurn(() => this.load());
  learnFailures = inTurn(() => this.tryLearnFailures());

  /**
   * @param {Api.Sweep} sweep
   * @param {Api.Row[]} rows
   * @param {any} schema
   * @param {URLSearchParams} query
   * @param {AbortSignal} signal
   */
  constructor(sweep, rows, schema, query, signal) {
    this.sweep = sweep;
    this.rows = rows;
    this.schema = schema;
    this.signal = signal;
    this.compareWith = latest((current, /** @type {string} */ id) => this.findOthers(id, current), signal);
    this.axes = sweep.axes;
    this.metrics = metricsOf(rows, this.axes);
    this.view = viewFrom(query, this);
    this.selection.set((query.get("jobs") ?? "").split(",").filter(Boolean));
    this.makeButtons();
    this.paper = this.#bearsOnPaper() ? h("p", { class: "unseen" }, "The paper's statements") : null;
    this.table = new ResultTable(this);
    this.logs = logBoxes(this, () => this.changed());
    this.curves = curveChoice(this, () => this.changed());
    this.scatterChoice = scatterChoice(this, () => this.changed());
    this.configuration = configurationCard(this);
    this.charts = new SeenCharts(this, [[heatMap, this.heat], [linesChart, this.lines],
      [parallelChart, this.parallel], [scatterChart, this.scatter]]);
  }

  parts() {
    this.drawHead();
    this.drawLinks();
    drawPickers(this);
    return [
      h("div", { class: "head below" },
        h("div", {}, this.title, this.status, this.tags, this.notes, this.paper), this.buttons),
      this.configuration.element, this.headlines, this.pickers, this.chosen,
      h("div", { class: "columns even" }, this.card("Heat map", this.heat, 0),
        this.card("Lines", this.lines, 1, { tools: [this.logs.element, this.curves.element] })),
      this.card("Parallel coordinates", this.parallel, 2, { help: this.help }),
      this.card("Scatter", this.scatter, 3, { tools: [this.scatterChoice.element] }),
      h("section", { class: "card" }, h("h2", {}, "Results"), this.table.element)];
  }

  /**
   * @param {string} title
   * @param {HTMLElement} element
   * @param {number} index
   * @param {{ help?: HTMLElement, tools?: HTMLElement[] }} more
   */
  card(title, element, index, { help, tools = [] } = {}) {
    const save = saveButtons(() => this.charts.at(index),
      () => `${this.sweep.name || this.sweep.id} ${title.toLowerCase()}`);
    return h("section", { class: "card" },
      h("div", { class: "head" }, h("h2", {}, title), h("span", { class: "actions" }, ...tools, save)), help,
        element);
  }

  start() {
    this.drawTexts();
    this.learnFailures();
    drawChosen(this.chosen, this.selection);
    this.selection.addEventListener("change", () => this.changed());
    this.charts.make();
    this.drawPaper();
    if (isUnderWay(this.sweep)) this.followIt();
    this.watchForRetries();
  }

  /// Somebody else may have jobs of a sweep that has ended computed again.
  async watchForRetries() {
    for (;;) {
      try {
        await pause(lookMs, this.signal);
        if (this.isFollowed || document.hidden) continue;
        const { ended_at: ended } = await findSweep(this.sweep.id, this.signal);
        if (ended === this.sweep.ended_at) continue;
        this.failures.doubt();
        await this.update();
      } catch (error) {
        if (error.status === 404) tellTrouble("This sweep has been deleted.");
        if (error.name === "AbortError" || error.status === 404) return;
      }
    }
  }

  /// Once at a time: a browser opens few connections to one service.
  followIt() {
    if (this.isFollowed) return;
    this.isFollowed = true;
    // A large sweep is fetched seldom: what it takes is a small part of the time.
    const reload = throttle(() => this.reload(), () => Math.max(reloadMs, 10 * this.reloadTook));
    follow(this.sweep.id, {
      progress: (news) => { Object.assign(this.sweep, { ...news, id: this.sweep.id }); this.drawHead(); reload(); },
      // After a retry the counts may be those that were told before.
      job: ({ state }) => { if (state === "failed") this.failures.doubt(); reload(); },
      done: () => { this.isFollowed = false; this.update(); },
    }, this.signal);
  }

  async update() {
    await this.reload();
    this.drawPaper();
    if (!this.signal.aborted && isUnderWay(this.sweep)) this.followIt();
  }

  async load() {
    try {
      let start = 0;
      [this.sweep, this.rows] = await retryWhileUnreachable(() => {
        start = performance.now();
        return Promise.all([findSweep(this.sweep.id, this.signal), findResults(this.sweep.id, {}, this.signal)]);
      }, tellTrouble, this.signal);
      this.drawHead();
      this.drawAll();
      this.reloadTook = performance.now() - start;
    } catch (error) {
      if (error.name !== "AbortError") tellTrouble(error.message);
      return;
    }
    await this.learnFailures();
  }

  async tryLearnFailures() {
    try {
      if (await this.failures.learn(this.sweep.id, this.rows, tellTrouble, this.signal)) this.drawTexts();
    } catch (error) {
      if (error.name !== "AbortError") tellTrouble(error.message);
    }
  }

  #bearsOnPaper() {
    return this.metrics.includes("peak_slider_acceleration_m_s2") && bearsOnPaper(this.axes);
  }

  drawPaper() {
    if (this.paper && !isUnderWay(this.sweep)) drawSummary(this.paper, this.sweep, this.signal);
  }

  drawAll() {
    this.drawTexts();
    this.charts.draw();
  }

  drawTexts() {
    this.configuration.draw();
    drawHeadlines(this.headlines, this);
    this.table.draw();
    this.logs.draw();
    this.curves.draw();
    this.scatterChoice.draw();
  }

  changed() {
    rememberQuery({ ...queryOf(this.view, this.selection.ids), with: this.others?.id });
    drawChosen(this.chosen, this.selection);
    this.drawLinks();
    this.drawAll();
  }

  drawHead() {
    const { id, name, notes = "", counts, eta_s: eta } = this.sweep;
    document.title = `RPSUP: ${name || id}`;
    this.title.replaceChildren(name || id, " ", studyBadge(this.sweep));
    this.csv.download = `${name || id}.csv`;
    this.notes.textContent = notes;
    this.notes.hidden = notes === "";
    this.tags.replaceChildren(...tagBadges(this.sweep));
    this.tags.hidden = !this.tags.hasChildNodes();
    const parts = Object.entries(counts).filter(([state, count]) => state !== "total" && count > 0)
      .map(([state, count]) => `${count.toLocaleString("en")} ${state}`);
    const left = isUnderWay(this.sweep) && eta !== null ? `; about ${span(eta)} left` : "";
    this.status.textContent = `${this.sweep.state}: ${parts.join(", ")} of ${plural(counts.total, "job")}${left}`;
    setSeen(this.cancel, isUnderWay(this.sweep));
    setSeen(this.retry, counts.failed + counts.cancelled > 0);
    this.remove.disabled = isUnderWay(this.sweep);
    this.remove.title = isUnderWay(this.sweep) ? "Cancel it first" : "";
  }

  /// Once: a button that was made anew would lose the focus, and a click that has begun.
  makeButtons() {
    const { id } = this.sweep;
    this.csv.href = resultsUrl(id, { format: "csv" });
    /** @type {(text: string, run: (id: string) => Promise<unknown>) => HTMLButtonElement} */
    const act = (text, run) =>
      h("button", { class: "passing", onclick: () => run(id).then(() => this.update())
        .catch((error) => notify(error.message, "trouble")) }, text);
    this.cancel = act("Cancel", cancelSweep);
    this.retry = act("Retry", (sweep) => retrySweep(sweep).then(() => this.failures.doubt()));
    const isOfStudy = Boolean(this.sweep.study_id);
    this.buttons = h("p", { class: "actions" }, this.cancel, this.retry,
      h("button", { onclick: () => this.edit() }, "Edit"),
      extendableAxes(this.sweep).length > 0 && !isOfStudy
        ? h("button", { onclick: () => this.extend() }, "Extend") : null,
      this.csv, this.report,
      h("a", { class: "button", href: routeTo("analyses", id) }, "Analysis"),
      h("a", { class: "button", href: routeTo("fits", "new", { sweep: id }) }, "Fit"), this.optimise,
      h("a", { class: "button", href: routeTo("new", "", { from: id }) }, "Duplicate"),
      isOfStudy ? null : this.remove);
  }

  /// Changes name, notes and tags.
  async edit() {
    const changed = await editLabels(this.sweep);
    if (!changed || this.signal.aborted) return;
    const { name, notes, tags } = changed;
    Object.assign(this.sweep, { name, notes, tags });
    this.drawHead();
  }

  /// Adds values to the axes; the page follows their jobs.
  async extend() {
    const extended = await extendDialog(this.sweep);
    if (extended && !this.signal.aborted) await this.update();
  }

  async removeIt() {
    if (!await confirmed(`Delete ${this.sweep.name || this.sweep.id} with its results?`, "Delete")) return;
    try {
      await deleteSweep(this.sweep.id);
      if (!this.signal.aborted) location.hash = "#/";
    } catch (error) {
      notify(error.message, "trouble");
    }
  }

  /// An optimisation begins with the metric that is looked at, and the report shows it.
  drawLinks() {
    const { id } = this.sweep;
    const { metric, x } = this.view;
    this.report.href = reportUrl(id, { metric, ...(typeof this.rows[0]?.[x] === "number" ? { x } : {}) });
    this.optimise.href = routeTo("optimisations", "new", { sweep: id, metric });
  }

  /** @param {string} id  @param {AbortSignal} current */
  async findOthers(id, current) {
    let others = null;
    try {
      if (id) others = await findComparison(id, current);
    } catch (error) {
      if (error.name === "AbortError") throw error;
      tellTrouble(`Not beside this sweep: ${error.message}`);
    }
    this.others = others;
    const picker = this.compare.querySelector("select");
    if (picker) picker.value = others?.id ?? "";
    this.changed();
  }
}
