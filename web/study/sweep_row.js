// SPDX-License-Identifier: Apache-2.0
// One sweep in the list: its row is made once and then kept up to date.
import { findResults } from "/core/api.js";
import { h, setSeen } from "/core/dom.js";
import { moment, nameOf, number, shortMoment, span, unitOf } from "/core/format.js";
import { isUnderWay } from "/core/live.js";
import { routeTo } from "/core/route.js";
import { tagBadges } from "/study/sweep_labels.js";

const usualPeak = "peak_slider_acceleration_m_s2";
/// Classes of the cells.
const classes = { box: "box", name: "name", state: "", jobs: "small", peaks: "peaks",
  created: "small created", actions: "acts" };
const peaksMs = 30000;  // between two questions on the peaks of a sweep under way
const shownOfId = 7;  // last letters of an id: the first ones tell the time and are much alike
/** @type {Record<Api.State, true>} */
const isState = { queued: true, running: true, succeeded: true, failed: true, cancelled: true };
export const jobStates = /** @type {Api.State[]} */ (Object.keys(isState));

/// Page and name of the kinds of studies, by the first letters of their ids.
const studyKinds = { sch: ["searches", "search"], fit: ["fits", "fit"],
  opt: ["optimisations", "optimisation"] };

/// An id in one line: "swp_…f9mqab6".
const shortOf = (id) => `${id.slice(0, id.indexOf("_") + 1)}…${id.slice(-shownOfId)}`;

/// Page and name of the kind of a study.
/** @param {string} id  @returns {string[]} */
const kindOf = (id) => studyKinds[id.slice(0, id.indexOf("_"))] ?? ["wear", "wear study"];

/// Words of the badge of the study that a sweep belongs to; empty if there is none.
/** @param {{ study_id?: string | null }} sweep */
export const studyWords = ({ study_id: id }) => (id ? kindOf(id)[1] : "");

/// Link to the study that a sweep belongs to. @param {{ study_id: string | null }} sweep
export function studyBadge({ study_id: id }) {
  if (!id) return "";
  const [page, text] = kindOf(id);
  return h("a", { class: "badge", href: routeTo(page, id), title: `These jobs are those of the ${text} ${id}` }, text);
}

/** @typedef {"cancel" | "retry" | "delete"} Action */

export class SweepRow {
  #drawn = "";  // JSON of the sweep that the row shows
  #counted = 0;  // jobs that had succeeded when the peaks were asked for
  #askedAt = -Infinity;  // [ms]
  /** @type {Api.ListedSweep} */
  #sweep;
  #state = h("span");
  #percent = h("span", { class: "quiet" });
  #left = h("span", { class: "small quiet" });
  #bar = h("progress");
  #again = h("a", { class: "button" }, "Duplicate");

  /// @param act  is called with the action of a button  @param box  that marks the sweep
  /** @param {(action: Action) => void} act  @param {HTMLElement} box  @param {AbortSignal} signal */
  constructor(act, box, signal) {
    this.signal = signal;
    this.cells = Object.fromEntries(Object.entries(classes)
      .map(([key, name]) => [key, h("td", { class: name })]));
    this.element = h("tr", {}, ...Object.values(this.cells));
    this.buttons = {
      cancel: h("button", { onclick: () => act("cancel") }, "Cancel"),
      retry: h("button", { onclick: () => act("retry") }, "Retry"),
      delete: h("button", { class: "danger", onclick: () => act("delete") }, "Delete"),
    };
    this.cells.box.append(box);
    this.cells.state.append(h("div", { class: "line" }, this.#state, " ", this.#percent), this.#left,
      this.#bar);
    this.cells.actions.append(h("span", { class: "actions" }, this.#again, this.buttons.retry,
      h("span", { class: "either" }, this.buttons.delete, this.buttons.cancel)));
  }

  /** @param {Api.ListedSweep} sweep */
  update(sweep) {
    const text = JSON.stringify(sweep);
    if (text === this.#drawn) return;
    this.#drawn = text;
    this.#sweep = sweep;
    this.#drawName(sweep);
    this.#drawState(sweep);
    this.#drawJobs(sweep);
    this.#drawActions(sweep);
  }

  /** @param {Api.ListedSweep} sweep */
  #drawName(sweep) {
    const { id, name, axes } = sweep;
    const varied = axes.map(nameOf).join(" × ");
    this.cells.name.replaceChildren(h("div", { class: "line" },
      h("a", { href: routeTo("sweeps", id), title: id }, name || shortOf(id)), " ", studyBadge(sweep),
      ...tagBadges(sweep)), h("span", { class: "small quiet", title: varied }, varied));
  }

  /** @param {Api.ListedSweep} sweep */
  #drawState(sweep) {
    const { state, progress, eta_s: eta } = sweep;
    this.#state.className = state;
    this.#state.textContent = sweep.executor === "local" ? state : `${state} on ${sweep.executor}`;
    this.#percent.textContent = `${Math.floor(100 * progress)} %`;
    this.#left.textContent = isUnderWay(sweep) && eta !== null ? `about ${span(eta)} left` : "";
    this.#bar.value = progress;
    this.#bar.hidden = !isUnderWay(sweep);
    this.#bar.setAttribute("aria-label", `Progress of ${sweep.name || sweep.id}`);
  }

  /** @param {Api.ListedSweep} sweep */
  #drawJobs({ counts, created_at: created }) {
    this.cells.jobs.textContent = jobStates.filter((state) => counts[state] > 0)
      .map((state) => `${counts[state].toLocaleString("en")} ${state}`).join(", ");
    this.cells.created.textContent = shortMoment(created);
    this.cells.created.title = moment(created);
  }

  /** @param {Api.ListedSweep} sweep */
  #drawActions(sweep) {
    const { counts, study_id: study } = sweep;
    setSeen(this.buttons.cancel, isUnderWay(sweep));
    setSeen(this.buttons.retry, counts.failed + counts.cancelled > 0);
    setSeen(this.buttons.delete, !isUnderWay(sweep) && !study);
    this.#again.href = routeTo("new", "", { from: sweep.id });
    for (const button of [...Object.values(this.buttons), this.#again]) {
      button.setAttribute("aria-label", `${button.textContent} ${sweep.name || sweep.id}`);
    }
  }

  /// Shows the peaks of the jobs that have succeeded; of a sweep under way those of some time ago.
  async showPeaks() {
    const { id, counts: { succeeded } } = this.#sweep;
    const isEarly = isUnderWay(this.#sweep) && performance.now() < this.#askedAt + peaksMs;
    if (succeeded === this.#counted || isEarly) return;
    this.#askedAt = performance.now();
    const found = await findPeaks(id, this.signal);
    this.#counted = succeeded;
    if (!found) return;
    const { peak, least, largest } = found;
    const link = (row) => h("a", { href: routeTo("jobs", row.job_id) }, number(row[peak]));
    this.cells.peaks.title = nameOf(peak);
    this.cells.peaks.replaceChildren(...(least && largest
      ? [link(least), " … ", link(largest), ` ${unitOf(peak)}`] : ["–"]));
  }
}

/// Jobs with the least and the largest peak of a sweep; null if its jobs have no peaks.
/** @param {string} id  @param {AbortSignal} signal */
async function findPeaks(id, signal) {
  // A described linkage has peaks by the names of its joints: the first one stands for them.
  const [any] = await findResults(id, { limit: 1 }, signal);
  const peak = usualPeak in any ? usualPeak : Object.keys(any).find((name) => name.startsWith("peak_"));
  if (!peak) return null;
  const first = (order) => findResults(id,
    { fields: `job_id,${peak}`, [`${peak}_ge`]: 0, order_by: order, limit: 1 }, signal);
  const [[least], [largest]] = await Promise.all([first(peak), first(`-${peak}`)]);
  return { peak, least, largest };
}
