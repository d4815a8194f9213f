// SPDX-License-Identifier: Apache-2.0
// Measurements: their list, the upload of a new one, and the view of one.
import { listMeasurements } from "/core/api.js";
import { h } from "/core/dom.js";
import { moment, number, plural, titleOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { removeMeasurement, showMeasurement } from "/measure/measurement_view.js";
import { showUpload } from "/measure/upload_form.js";

const pageSize = 100;
const headings = [["Name"], ["Channels"], ["Samples", "number"], ["Duration [s]", "number"], ["Created"],
  ["Actions"]];

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { id, query, signal }) {
  if (id === "new") return showUpload(main, signal);
  return id ? showMeasurement(main, id, query, signal) : showList(main, signal);
}

/** @param {HTMLElement} main  @param {AbortSignal} signal */
async function showList(main, signal) {
  document.title = "RPSUP: measurements";
  const body = h("tbody");
  const status = h("p", { class: "quiet", role: "status" }, "Loading …");
  const empty = h("section", { class: "card", hidden: true }, h("h2", {}, "No measurements yet."),
    h("p", {}, "Begin with New measurement: choose a CSV, NPZ or JSON file with a column of times in seconds and a column for "
      + "each signal. The page shows the signals before they are sent, and asks which channel each of them is."));
  const trouble = h("p", { class: "trouble", role: "alert" });
  const more = h("button", { onclick: () => { limit += pageSize; refresh(); } }, "Show more");
  let limit = pageSize;
  const table = h("div", { class: "scroll card", tabindex: 0, role: "region", "aria-label": "Measurements" },
    h("table", { class: "list" }, h("thead", {}, h("tr", {}, headings.map(([text, look]) =>
      h("th", { scope: "col", class: look }, text)))), body));
  const refresh = async () => {
    const { items, next_cursor: next } = await listMeasurements({ limit }, signal);
    body.replaceChildren(...items.map((each) => row(each, trouble, refresh)));
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
      "New measurement")), trouble, status, table, empty, more);
  await refresh();
}

/**
 * @param {Api.Listed<"/v1/measurements">} measurement
 * @param {HTMLElement} trouble
 * @param {() => unknown} refresh
 */
function row({ id, name: given, channels, samples, duration_s: duration, created_at: created }, trouble,
  refresh) {
  const name = given || id;
  return h("tr", {}, h("td", { class: "name" }, h("a", { href: routeTo("measurements", id) }, name)),
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
