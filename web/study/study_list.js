// SPDX-License-Identifier: Apache-2.0
// The list of studies of one kind, up to date by itself.
import { h } from "/core/dom.js";
import { moment } from "/core/format.js";
import { ListOrder, Marked, askInSight } from "/core/list_tools.js";
import { keepRunning, latest } from "/core/live.js";
import { rememberQuery, routeTo } from "/core/route.js";

/**
 * @template {Listed} Item
 * @typedef {{ api: Studies<any, Item, any>, route: string, title: string, question: string, listName: string, nouns: string[],
 *   aim: { heading: string, textOf: (study: Item) => string },
 *   answerOf?: (study: any) => string, none: string, begin: string }} StudyKind
 */

const pollMs = 4000;
const pageSize = 100;

/// Shown in place of an empty list: how to begin.
/** @param {Pick<StudyKind<any>, "none" | "route">} kind */
function emptyCard({ none, route }) {
  return h("section", { class: "card", hidden: true }, h("h2", {}, none),
    h("p", {}, "The form begins with an example, which can be submitted as it stands and changed as you like. A list "
      + "of these stands here as soon as there is one, and follows them as they run."),
    h("p", {}, h("a", { class: "button", href: routeTo(route, "new") }, "Begin with the example")));
}

/**
 * @template {Listed} Item
 * @param {HTMLElement} main
 * @param {StudyKind<Item>} kind
 * @param {AbortSignal} signal
 */
export async function showStudies(main, kind, signal) {
  document.title = `RPSUP: ${kind.title.toLowerCase()}`;
  const list = new StudyList(kind, signal);
  main.replaceChildren(...list.parts());
  await list.refresh();
  keepRunning(list.refresh, pollMs, signal);
}

/** @template {Listed} Item */
class StudyList {
  /** @type {Item[]} */
  items = [];
  /** @type {Map<string, string>} */
  answers = new Map();  // of studies that have ended
  /** @type {Map<string, { text: string, element: HTMLElement, study: Item }>} */
  rows = new Map();
  body = h("tbody");
  status = h("p", { class: "quiet", role: "status" }, "Loading …");
  limit = pageSize;
  more = h("button",
    { hidden: true, onclick: () => { this.limit += pageSize; this.refresh(); } }, "Show more");

  /** @param {StudyKind<Item>} kind  @param {AbortSignal} signal */
  constructor(kind, signal) {
    this.kind = kind;
    this.signal = signal;
    this.refresh = latest((current) => this.#load(current), signal);
    this.learn = askInSight(() => this.rows.values(), ({ study }) => this.#learn(study), signal);
    this.empty = emptyCard(kind);
    /** @type {ListOrder<Item>} */
    this.order = new ListOrder({ name: ["Name", (study) => study.name || study.id],
      state: ["State", (study) => study.state],
      created: ["Created", (study) => study.created_at] },
        new URLSearchParams(location.hash.split("?")[1]).get("sort"),
      (sort) => { rememberQuery({ sort }); this.draw(); });
    /** @type {Marked<Item>} */
    this.marked = new Marked({ nouns: kind.nouns, mayGo: ({ state }) => state !== "running",
      remove: kind.api.remove, done: () => this.refresh() });
  }

  parts() {
    const { title, question, listName, aim, answerOf, begin, route } = this.kind;
    const headings = [["box", ""], ["name", "Name"], ["state", "State"], ["aim", aim.heading],
      ...(answerOf ? [["answer", "Answer"]] : []), ["created", "Created"]];
    const cells = headings.map(([key, text]) =>
      h("th", { scope: "col" }, key === "box" ? this.marked.all : this.order.heading(key, text)));
    this.table = h("div", { class: "scroll card", hidden: true, tabindex: 0, role: "region",
      "aria-label": listName },
      h("table", { class: "list" }, h("thead", {}, h("tr", {}, cells)), this.body));
    this.order.draw();
    return [h("h1", {}, title), h("p", {}, question),
      h("p", { class: "actions" }, h("a", { class: "button main", href: routeTo(route, "new") }, begin),
        this.order.element),
      this.status, this.marked.bar, this.table, this.more, this.empty];
  }

  /** @param {AbortSignal} current */
  async #load(current) {
    try {
      const { items, next_cursor: next } = await this.kind.api.list({ limit: this.limit }, current);
      this.items = items;
      this.more.hidden = !next;
      this.status.textContent = next ? `The newest ${items.length}.` : "";
      this.draw();
    } catch (error) {
      if (error.name !== "AbortError") this.status.textContent = `${error.message} Trying again …`;
    }
  }

  draw() {
    const items = this.order.ordered(this.items);
    const rows = items.map((study) => this.row(study));
    // Rows that stay are left in their places, with the keyboard's focus in them.
    if (rows.length !== this.body.children.length || rows.some((row, i) => this.body.children[i] !== row)) {
      this.body.replaceChildren(...rows);
    }
    this.marked.update(items);
    if (this.table) this.table.hidden = items.length === 0;
    this.empty.hidden = items.length > 0;
    this.learn();
  }

  /** @param {Item} study */
  row(study) {
    const { kind } = this;
    const answer = this.answers.get(study.id) ?? "–";
    const text = JSON.stringify([study, answer]);
    const known = this.rows.get(study.id);
    if (known?.text === text) return known.element;
    const element = h("tr", {}, h("td", { class: "box" }, this.marked.box(study)),
      h("td", { class: "name" }, h("a", { href: routeTo(kind.route, study.id) }, study.name || study.id)),
      h("td", { class: study.state }, study.state), h("td", {}, kind.aim.textOf(study)),
      kind.answerOf ? h("td", {}, answer) : null, h("td", { class: "fixed" }, moment(study.created_at)));
    this.rows.set(study.id, { text, element, study });
    return element;
  }

  /// Learns the answer of a study that has ended, which stands in no listing, once.
  /** @param {Item} study */
  async #learn({ id, state }) {
    const { answerOf, api } = this.kind;
    if (state === "running") this.answers.delete(id);
    if (!answerOf || state === "running" || this.answers.has(id)) return;
    this.answers.set(id, answerOf(await api.find(id, this.signal)));
    this.draw();
  }
}
