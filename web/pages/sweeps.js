// SPDX-License-Identifier: Apache-2.0
// The list of sweeps, up to date by itself.
import { addressOf, cancelSweep, deleteSweep, findSweep, listExecutors, listSweeps, retrySweep } from "/core/api.js";
import { warmUpCharts } from "/core/charts.js";
import { confirmed } from "/core/dialog.js";
import { choice, h, notify } from "/core/dom.js";
import { nameOf, plural } from "/core/format.js";
import { ListOrder, Marked, askInSight } from "/core/list_tools.js";
import { debounce, isUnderWay, keepRunning, latest } from "/core/live.js";
import { rememberQuery, routeTo } from "/core/route.js";
import { executorsPanel } from "/study/executors.js";
import { SweepRow, jobStates, studyWords } from "/study/sweep_row.js";

const pageSize = 25;
const mostSearched = 1000;
const pollMs = 4000;
/** @type {(text: string | null) => Api.State | ""} */
const stateOf = (text) => jobStates.find((state) => state === text) ?? "";
const columns = [["box", ""], ["name", "Name"], ["state", "State"], ["jobs", "Jobs"], ["peaks", "Peak range"],
  ["created", "Created"], ["actions", "Actions"]];
const whatItIs = "RPSUP simulates a spatial linkage whose coupler bends and whose joint is worn: the journal hits "
  + "and slides in its bearing, and accelerations and "
  + "forces have peaks that an ideal linkage has not. A sweep is a set of such simulations over ranges of their "
  + "parameters; the service computes them in the "
  + "background and keeps what comes out, and charts and tables fill as it does.";

/** @typedef {Api.ListedSweep} Listing */

/// Keys by which sweeps can be ordered, with their headings.
/** @type {Record<string, [string, (sweep: Listing) => string | number]>} */
const orders = { name: ["Name", (sweep) => sweep.name || sweep.id], state: ["State", (sweep) => sweep.state],
  jobs: ["Jobs", (sweep) => sweep.counts.total], created: ["Created", (sweep) => sweep.created_at] };

/** @param {HTMLElement} main  @param {Visit} view */
export async function show(main, { query, signal }) {
  const view = new SweepList(query, signal);
  main.replaceChildren(...view.parts());
  await view.refresh();
  keepRunning(view.refresh, pollMs, signal);
  // The next view needs them. Safari tells no idle time.
  const later = globalThis.requestIdleCallback ?? setTimeout;
  later(() => Promise.all([warmUpCharts(), import("/pages/sweep.js")]).catch(() => {}));
}

class SweepList {
  pages = 1;
  /** @type {Api.ListedSweep[]} */
  sweeps = [];
  /** @type {Map<string, SweepRow>} */
  rows = new Map();
  status = h("p", { class: "quiet", role: "status" }, "Loading the sweeps …");
  body = h("tbody");
  more = h("button", { hidden: true, onclick: () => { this.pages += 1; this.refresh(); } }, "Show more");
  none = h("p", { class: "card", hidden: true }, "No matching sweeps.");
  executors = executorsPanel();
  /** @type {Marked<Listing>} */
  marked = new Marked({ nouns: ["sweep", "sweeps"], mayGo: (sweep) => !isUnderWay(sweep) && !sweep.study_id,
    remove: deleteSweep,
    done: () => this.refresh() });
  empty = this.#makeWelcome();

  /** @param {URLSearchParams} query  @param {AbortSignal} signal */
  constructor(query, signal) {
    this.signal = signal;
    this.refresh = latest((current) => this.#load(current), signal);
    this.learnPeaks = askInSight(() => this.rows.values(), (row) => row.showPeaks(), signal);
    this.state = stateOf(query.get("state"));
    this.search = query.get("search") ?? "";
    /** @type {ListOrder<Listing>} */
    this.order = new ListOrder(orders, query.get("sort"), () => { this.changed(); this.refresh(); });
    this.table = this.#makeTable();
  }

  #makeTable() {
    const headings = columns.map(([key, text]) => h("th", { scope: "col", class: `column-${key}` },
      key === "box" ? this.marked.all : this.order.heading(key, text)));
    return h("div", { class: "scroll card", hidden: true, tabindex: 0, role: "region", "aria-label": "Sweeps" },
      h("table", { class: "listing" }, h("thead", {}, h("tr", {}, headings)), this.body));
  }

  #makeWelcome() {
    return h("section", { class: "card", hidden: true }, h("h2", {}, "No sweeps yet"),
      h("p", {}, whatItIs),
      h("p", {}, "The paper's sweep is an example, ready to be submitted. For scripts and notebooks, ",
        h("a", { href: addressOf("/docs") }, "the REST interface is documented"), " on a page to try it with."),
      h("p", {}, h("a", { class: "button main", href: "#/new" }, "New sweep"), " ",
        h("a", { class: "button", href: routeTo("new", "", { template: "paper" }) }, "Load the paper's sweep")));
  }

  parts() {
    document.title = "RPSUP: sweeps";
    const refreshSoon = debounce(() => this.signal.aborted || this.refresh(), 300);
    const search = h("input",
      { type: "search", value: this.search,
        oninput: () => { this.search = search.value; this.changed(); refreshSoon(); } });
    const tools = h("p", { class: "actions" },
      h("label", { class: "choice" }, h("span", {}, "Search (name, badge, notes, id, axis)"), search),
      choice("State", [["", "any"], ...jobStates], this.state,
        (chosen) => { this.state = stateOf(chosen); this.changed(); this.refresh(); }),
      this.order.element, h("a", { class: "button main", href: "#/new" }, "New sweep"));
    this.order.draw();
    return [h("h1", {}, "Sweeps"), this.status, this.executors.element, tools, this.marked.bar, this.table,
      this.none, this.more,
      this.empty];
  }

  changed() {
    rememberQuery({ state: this.state, search: this.search, sort: this.order.isUsual ? ""
      : this.order.chosen });
    this.draw();
  }

  #query() {
    const size = this.search || !this.order.isUsual ? mostSearched : pageSize;
    return { limit: this.pages * size, state: this.state || undefined };
  }

  /** @param {AbortSignal} current */
  async #load(current) {
    try {
      const [page, executors] = await Promise.all([listSweeps(this.#query(), current), listExecutors(current)]);
      this.executors.update(executors.items);
      this.sweeps = page.items;
      this.more.hidden = !page.next_cursor;
      this.status.classList.remove("trouble");
      this.draw();
    } catch (error) {
      if (error.name === "AbortError") return;
      this.status.textContent = `${error.message} Trying again …`;
      this.status.classList.add("trouble");
    }
  }

  /** @param {Api.ListedSweep} sweep */
  matches(sweep) {
    const { name, id, tags = [], notes = "", axes } = sweep;
    const text = [name, id, ...tags, studyWords(sweep), notes, ...axes, ...axes.map(nameOf)].join(" ").toLowerCase();
    return this.search.toLowerCase().split(/\s+/).every((word) => text.includes(word));
  }

  draw() {
    const shown = this.order.ordered(this.sweeps.filter((sweep) => this.matches(sweep)));
    const actions = { cancel: cancelSweep, retry: retrySweep, delete: deleteSweep };
    const rows = shown.map((sweep) => {
      const row = this.rows.get(sweep.id)
        ?? new SweepRow((action) => this.act(actions[action], action, sweep.id), this.marked.box(sweep),
          this.signal);
      this.rows.set(sweep.id, row);
      row.update(sweep);
      return row.element;
    });
    // Rows that stay are left in their places, with the keyboard's focus in them.
    if (rows.length !== this.body.children.length
      || rows.some((row, i) => this.body.children[i] !== row)) this.body.replaceChildren(...rows);
    this.marked.update(shown);
    this.table.hidden = shown.length === 0;
    this.empty.hidden = shown.length > 0 || this.search !== "" || this.state !== "";
    this.none.hidden = shown.length > 0 || !this.empty.hidden;
    const busy = shown.filter(isUnderWay).length;
    this.status.textContent = `${this.more.hidden ? "" : "The newest "}${plural(shown.length, "sweep")}, ${busy} `
      + `under way`;
    this.learnPeaks();
  }

  async act(run, action, id) {
    const sweep = await findSweep(id).catch(() => ({ name: "", id }));
    const question = `Delete “${sweep.name || id}”? Results that no other sweep shares are deleted, too.`;
    if (action === "delete" && !(await confirmed(question, "Delete"))) return;
    try {
      await run(id);
    } catch (error) {
      notify(error.message, "trouble");
    }
    this.refresh();
  }
}
