// SPDX-License-Identifier: Apache-2.0
// The list of studies of one kind, up to date by itself.
import { h } from "/core/dom.js";
import { moment } from "/core/format.js";
import { routeTo } from "/core/route.js";

/**
 * @template {Listed} Item
 * @typedef {{ api: Studies<any, Item, any>, route: string, title: string, question: string, listName: string,
 *   aim: { heading: string, textOf: (study: Item) => string },
 *   answerOf?: (study: any) => string, none: string, begin: string }} StudyKind
 */

const pollMs = 4000;

/**
 * @template {Listed} Item
 * @param {HTMLElement} main
 * @param {StudyKind<Item>} kind
 * @param {AbortSignal} signal
 */
export async function showStudies(main, kind, signal) {
  document.title = `RPSUP: ${kind.title.toLowerCase()}`;
  const body = h("tbody");
  const headings = ["Name", "State", kind.aim.heading, ...(kind.answerOf ? ["Answer"] : []), "Created"];
  /** @type {Map<string, string>} */
  const answers = new Map();  // of studies that have ended
  const status = h("p", { class: "quiet", role: "status" });
  const table = h("div", { class: "scroll card", tabindex: 0, role: "region", "aria-label": kind.listName },
    h("table", {}, h("thead", {}, h("tr", {}, headings.map((text) => h("th", { scope: "col" }, text)))), body));
  main.replaceChildren(h("h1", {}, kind.title), h("p", {}, kind.question),
    h("p", { class: "actions" }, h("a", { class: "button main", href: routeTo(kind.route, "new") }, kind.begin)),
    status, table);
  /** @type {(study: Item) => HTMLElement} */
  const row = (study) =>
    h("tr", {}, h("td", { class: "name" }, h("a", { href: routeTo(kind.route, study.id) }, study.name || study.id)),
    h("td", { class: study.state }, study.state), h("td", {}, kind.aim.textOf(study)),
    kind.answerOf ? h("td", { "data-answer": study.id }, answers.get(study.id) ?? "–") : null,
    h("td", { class: "fixed" }, moment(study.created_at)));
  /// Answers stand in no listing: each is asked for once.
  /** @param {Item[]} items */
  const learn = async (items) => {
    for (const { id, state } of items) {
      if (state === "running") answers.delete(id);
      if (!kind.answerOf || state === "running" || answers.has(id)) continue;
      answers.set(id, kind.answerOf(await kind.api.find(id, signal)));
      body.querySelector(`[data-answer="${id}"]`)?.replaceChildren(answers.get(id) ?? "");
    }
  };
  const refresh = async () => {
    try {
      const { items } = await kind.api.list({ limit: 100 }, signal);
      body.replaceChildren(...items.map(row));
      table.hidden = items.length === 0;
      status.textContent = items.length === 0 ? kind.none : "";
      await learn(items);
    } catch (error) {
      if (error.name !== "AbortError") status.textContent = `${error.message} Trying again …`;
    }
  };
  await refresh();
  const timer = setInterval(refresh, pollMs);
  signal.addEventListener("abort", () => clearInterval(timer));
}
