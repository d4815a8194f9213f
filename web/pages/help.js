// SPDX-License-Identifier: Apache-2.0
// Help: the words of the pages, how to begin, what the plots listen to, and the version of the program.
import { addressOf, findHealth } from "/core/api.js";
import { h } from "/core/dom.js";
import { routeTo } from "/core/route.js";

const words = [["Job", "One simulation."],
  ["Sweep", "A set of jobs over lists of values: a job for every combination."],
  ["Replicates", "Runs of the same job, all but the first with a slightly different contact stiffness. Their spread shows how far a value scatters."],
  ["Metric", "One number of a job, such as a peak. Point at its name, or touch it, to read what it is."],
  ["Channel", "One quantity of a job over time."],
    ["Run-up", "Time at the start of a job that metrics of the steady part leave out."],
  ["Journal and bearing", "Pin of the joint with clearance, and what it moves in."]];
const inputs = [["drag across a plot or the strip", "look closer"], ["wheel", "zoom"],
  ["drag with Shift", "move"],
  ["keys ← → + − 0", "move, zoom, all of it"], ["two fingers, one finger", "zoom, move"],
    ["click on a cell, a point or a row", "select its jobs in all views"],
  ["drag along an axis of parallel coordinates", "select the jobs between"]];

/** @param {string} label  @param {string[]} headings  @param {string[][]} rows */
function table(label, headings, rows) {
  return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label }, h("table", {},
    h("thead", {}, h("tr", {}, headings.map((text) => h("th", { scope: "col" }, text)))),
    h("tbody", {}, rows.map((row) => h("tr", {}, row.map((text) => h("td", {}, text)))))));
}

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { signal }) {
  document.title = "RPSUP: help";
  const version = h("p", { class: "quiet" });
  main.replaceChildren(h("h1", {}, "Help"),
    h("section", { class: "card" }, h("h2", {}, "How to begin"),
      h("ol", {}, h("li", {}, h("a", { href: routeTo("new", "", { template: "paper" }) },
        "Load the paper's sweep"), " and submit it: it takes seconds."),
        h("li", {}, "Look at the sentences at the top of its page, then at the heat map and the lines. Select jobs, and open or overlay them."),
        h("li", {}, "Duplicate it with other values, or ask for ",
          h("a", { href: routeTo("searches") }, "limits"), ", ",
          h("a", { href: routeTo("optimisations") }, "optima"), " and ",
            h("a", { href: routeTo("fits") }, "fits to measurements"), ".")),
      h("p", {}, "Scripts and notebooks use the ", h("a", { href: addressOf("/docs") }, "REST interface"),
        ", which has a page to try it with.")),
    h("section", { class: "card" }, h("h2", {}, "Words"), table("Words", ["Word", "Meaning"], words)),
    h("section", { class: "card" }, h("h2", {}, "Plots"), table("Plots", ["Input", "Effect"], inputs)),
      version);
  findHealth(signal).then((health) => { version.textContent = `RPSUP ${health.version}`; }).catch(() => {});
}
