// Where a job stands that has no result: not yet, or not at all.
import { h } from "/core/dom.js";
import { moment, number, plural, span } from "/core/format.js";
import { isUnderWay } from "/core/live.js";

const seconds = (from, to) => (new Date(to) - new Date(from)) / 1000;

/// A table of what is known. @param sweep  the job's, or null
export function standingCard(job, sweep, now) {
  return h("section", { class: "card", "aria-label": "State" }, h("h2", {}, "Where it stands"),
    h("table", {}, h("tbody", {}, standingRows(job, sweep, now).map(([name, value]) => h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, value))))));
}

/// [what, how it is] of a job; why it failed stands above it.
export function standingRows(job, sweep, now) {
  const { state, error, created_at: created, started_at: started, ended_at: ended, attempts } = job;
  return [["State", state],
    error?.t_s != null && ["The run came to", `${number(error.t_s)} s of ${number(job.parameters.duration_s)} s`],
    ["Submitted", moment(created)],
    started && ["Started", moment(started)],
    started && [ended ? "Computed for" : "Computing for", span(Math.max(0, seconds(started, ended ?? now)))],
    ended && ["Ended", moment(ended)],
    attempts > 1 && ["Attempts", String(attempts)],
    sweep && ["Its sweep", sweepText(sweep)]].filter(Boolean);
}

function sweepText(sweep) {
  const { counts, eta_s: eta } = sweep;
  const ended = counts.total - counts.queued - counts.running;
  const left = isUnderWay(sweep) && eta !== null ? `, about ${span(eta)} left for all of them` : "";
  return `${ended.toLocaleString("en")} of ${plural(counts.total, "job")} have ended${left}`;
}
