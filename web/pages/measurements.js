// SPDX-License-Identifier: Apache-2.0
// Measurements: their list, the upload of a new one, and the view of one.
import { deleteMeasurement, listMeasurements } from "/core/api.js";
import { h } from "/core/dom.js";
import { moment, number, plural, titleOf } from "/core/format.js";
import { ListOrder, Marked } from "/core/list_tools.js";
import { rememberQuery, routeTo } from "/core/route.js";
import { removeMeasurement, showMeasurement } from "/measure/measurement_view.js";
import { showUpload } from "/measure/upload_form.js";

const pageSize = 100;
const headings = [["box", ""], ["name", "Name"], ["channels", "Channels"], ["samples", "Samples", "number"],
  ["duration", "Duration [s]", "number"], ["created", "Created"], ["actions", "Actions"]];

/** @typedef {Api.Listed<"/v1/measurements">} Listing */

/// Keys by which measurements can be ordered, with their headings.
/** @type {Record<string, [string, (measurement: Listing) => string | number]>} */
const orders = { name: ["Name", ({ id, name }) => name || id], samples: ["Samples", ({ samples }) => samples],
  duration: ["Duration [s]", ({ duration_s: duration }) => duration],
  created: ["Created", ({ created_at: created }) => created] };

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { id, query, signal }) {
  if (id === "new") return showUpload(main, signal);
  return id ? showMeasurement(main, id, query, signal) : showList(main, query, signal);
}

/** @param {HTMLElement} main  @param {URLSearchParams} query  @param {AbortSignal} signal */
async function showList(main, query, signal) {
  document.title = "RPSUP: measurements";
  const body = h("tbody");
  const status = h("p", { class: "quiet", role: "status" }, "Loading …");
  const empty = h("section", { class: "card", hidden: true }, h("h2", {}, "No measurements yet."),
    h("p", {}, "Begin with New measurement: choose a CSV, NPZ or JSON file with a column of times in seconds and a column for "
      + "each signal. The page shows the signals before they are sent, and asks which channel each of them is."));
  const trouble = h("p", { class: "trouble", role: "alert" });
  const more = h("button", { onclick: () => { limit += pageSize; refresh(); } }, "Show more");
  let limit = pageSize;
  /** @type {Listing[]} */
  let items = [];
  /** @type {ListOrder<Listing>} */
  const order = new ListOrder(orders, query.get("sort"), (sort) => { rememberQuery({ sort }); draw(); });
  /** @type {Marked<Listing>} */
  const marked = new Marked({ nouns: ["measurement", "measurements"], mayGo: () => true,
    remove: deleteMeasurement, also: "", done: () => refresh() });
  const table = h("div", { class: "scroll card", tabindex: 0, role: "region", "aria-label": "Measurements" },
    h("table", { class: "list" }, h("thead", {}, h("tr", {}, headings.map(([key, text, look]) =>
      h("th", { scope: "col", class: look }, key === "box" ? marked.all : order.heading(key, text))))),
    body));
  order.draw();
  const draw = () => {
    const shown = order.ordered(items);
    body.replaceChildren(...shown.map((each) => row(each, marked.box(each), trouble, refresh)));
    marked.update(shown);
  };
  const refresh = async () => {
    const page = await listMeasurements({ limit }, signal);
    const { next_cursor: next } = page;
    items = page.items;
    draw();
    table.hidden = items.length === 0;
    empty.hidden = items.length > 0;
    more.hidden = !next;
    status.textContent = "";
  };
  main.replaceChildren(h("h1", {}, "Measurements"),
    h("p", {}, "Signals of a lab. A fit finds the parameters with which jobs give them; any job can be "
      + "looked at "
      + "beneath them."),
    h("p", { class: "actions" }, h("a", { class: "button main", href: routeTo("measurements", "new") },
      "New measurement"), order.element), trouble, status, marked.bar, table, empty, more);
  await refresh();
}

/**
 * @param {Listing} measurement
 * @param {HTMLElement} box  that marks it
 * @param {HTMLElement} trouble
 * @param {() => unknown} refresh
 */
function row({ id, name: given, channels, samples, duration_s: duration, created_at: created }, box,
  trouble, refresh) {
  const name = given || id;
  return h("tr", {}, h("td", { class: "box" }, box), h("td", { class: "name" },
    h("a", { href: routeTo("measurements", id) }, name)),
    h("td", {}, channels.length > 4 ? plural(channels.length, "channel")
      : channels.map((channel) => titleOf(channel.name)).join(", ")),
    h("td", { class: "number" }, samples.toLocaleString("en")),
      h("td", { class: "number" }, number(duration)),
    h("td", { class: "fixed" }, moment(created)),
    h("td", {}, h("span", { class: "actions" },
      h("a", { class: "button", href: routeTo("fits", "new", { measurement: id }),
        "aria-label": `Fit ${name}` }, "Fit"),
      h("button", { class: "danger", "aria-label": `Delete ${name}`,
        onclick: () => removeMeasurement(id, name, trouble, refresh) }, "Delete"))));
}
