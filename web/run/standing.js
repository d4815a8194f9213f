// SPDX-License-Identifier: Apache-2.0
// Progress of a job that has no result yet, or has failed.
import { h } from "/core/dom.js";
import { moment, number, plural, span } from "/core/format.js";
import { isUnderWay } from "/core/live.js";

/** @type {(from: string, to: string | Date) => number} */
const seconds = (from, to) => (Number(new Date(to)) - Number(new Date(from))) / 1000;

/// A table of what is known, made once: what is selected in it, and the page's focus, stay as its texts change.
/// @returns {element, draw(job, sweep, now)}; the sweep is the job's, or null
export function standingCard() {
  const rows = new Map();  // by what they tell
  const body = h("tbody");
  const rowOf = (name) => {
    if (!rows.has(name)) rows.set(name, h("tr", {}, h("th", { scope: "row" }, name), h("td")));
    return rows.get(name);
  };

  /** @param {Api.Job} job  @param {Api.Sweep | null} sweep  @param {Date} now */
  function draw(job, sweep, now) {
    const told = standingRows(job, sweep, now);
    for (const [name, row] of rows) if (!told.some(([wanted]) => wanted === name)) row.remove();
    told.forEach(([name, value], place) => {
      const row = rowOf(name);
      if (row.lastChild.textContent !== value) row.lastChild.textContent = value;
      if (body.children[place] !== row) body.insertBefore(row, body.children[place] ?? null);
    });
  }

  return { element: h("section", { class: "card", "aria-label": "State" }, h("h2", {}, "Progress"),
    h("table", {}, body)), draw };
}

/// [what, how it is] of a job; why it failed stands above it.
/** @param {Api.Job} job  @param {Api.Sweep | null} sweep  @param {Date} now  @returns {string[][]} */
function standingRows(job, sweep, now) {
  const { state, error, created_at: created, started_at: started, ended_at: ended, attempts } = job;
  return [["State", state],
    typeof error?.t_s === "number"
      && ["Simulated time", `${number(error.t_s)} s of ${number(job.parameters.duration_s)} s`],
    ["Submitted", moment(created)],
    started && ["Started", moment(started)],
    started && ["Computing time", span(Math.max(0, seconds(started, ended ?? now)))],
    ended && ["Ended", moment(ended)],
    attempts > 1 && ["Attempts", String(attempts)],
    sweep && ["Sweep", sweepText(sweep)]].filter(Boolean);
}

/** @param {Api.Sweep} sweep */
function sweepText(sweep) {
  const { counts, eta_s: eta } = sweep;
  const ended = counts.total - counts.queued - counts.running;
  const left = isUnderWay(sweep) && eta !== null ? `, about ${span(eta)} left for all of them` : "";
  return `${ended.toLocaleString("en")} of ${plural(counts.total, "job")} have ended${left}`;
}
