// SPDX-License-Identifier: Apache-2.0
// One sweep in the list: its row is made once and then kept up to date.
import { findResults } from "/core/api.js";
import { h, setSeen } from "/core/dom.js";
import { moment, nameOf, number, shortMoment, span, unitOf } from "/core/format.js";
import { isUnderWay } from "/core/live.js";
import { routeTo } from "/core/route.js";
import { tagBadges } from "/study/sweep_labels.js";

const usualPeak = "peak_slider_acceleration_m_s2";
// of its cells
const classes = { box: "box", name: "name", state: "", jobs: "small", peaks: "peaks",
  created: "small created", actions: "acts" };
const shownOfId = 7;  // of its letters the last ones: the first tell the time and are much alike
const jobStates = ["queued", "running", "succeeded", "failed", "cancelled"];

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

/// @param act  is called with "cancel", "retry" or "delete"  @param box  that marks the sweep
/**
 * @param {(action: "cancel" | "retry" | "delete") => void} act
 * @param {HTMLElement} box
 * @param {AbortSignal} signal
 */
export function sweepRow(act, box, signal) {
  const cells = Object.fromEntries(Object.entries(classes).map(([key, name]) => [key, h("td", { class: name })]));
  const element = h("tr", {}, ...Object.values(cells));
  const buttons = {
    cancel: h("button", { onclick: () => act("cancel") }, "Cancel"),
    retry: h("button", { onclick: () => act("retry") }, "Retry"),
    delete: h("button", { class: "danger", onclick: () => act("delete") }, "Delete"),
  };
  const again = h("a", { class: "button" }, "Duplicate");
  cells.actions.append(h("span", { class: "actions" }, again, buttons.retry,
    h("span", { class: "either" }, buttons.delete, buttons.cancel)));
  cells.box.append(box);
  const bar = h("progress");
  const percent = h("span", { class: "quiet" });
  const left = h("span", { class: "small quiet" });
  const state = h("span");
  cells.state.append(h("div", { class: "line" }, state, " ", percent), left, bar);
  let drawn = "";
  let counted = -1;

  /** @param {Api.ListedSweep} sweep */
  function update(sweep) {
    const text = JSON.stringify(sweep);
    if (text === drawn) return;
    drawn = text;
    const name = sweep.name || sweep.id;
    cells.name.replaceChildren(h("div", { class: "line" }, h("a",
      { href: routeTo("sweeps", sweep.id), title: sweep.id },
      sweep.name || shortOf(sweep.id)), " ", studyBadge(sweep), ...tagBadges(sweep)),
    h("span", { class: "small quiet", title: sweep.axes.map(nameOf).join(" × ") },
      sweep.axes.map(nameOf).join(" × ")));
    state.className = sweep.state;
    state.textContent = sweep.executor === "local" ? sweep.state : `${sweep.state} on ${sweep.executor}`;
    const part = `${Math.floor(100 * sweep.progress)} %`;
    bar.value = sweep.progress;
    bar.setAttribute("aria-label", `Progress of ${name}`);
    percent.textContent = part;
    left.textContent = isUnderWay(sweep) && sweep.eta_s !== null ? `about ${span(sweep.eta_s)} left` : "";
    bar.hidden = !isUnderWay(sweep);
    cells.jobs.textContent = jobStates.filter((each) => sweep.counts[each] > 0)
      .map((each) => `${sweep.counts[each].toLocaleString("en")} ${each}`).join(", ");
    cells.created.textContent = shortMoment(sweep.created_at);
    cells.created.title = moment(sweep.created_at);
    setSeen(buttons.cancel, isUnderWay(sweep));
    setSeen(buttons.retry, sweep.counts.failed + sweep.counts.cancelled > 0);
    setSeen(buttons.delete, !isUnderWay(sweep) && !sweep.study_id);
    for (const button of Object.values(buttons)) button.setAttribute("aria-label", `${button.textContent} ${name}`);
    again.href = routeTo("new", "", { from: sweep.id });
    again.setAttribute("aria-label", `Duplicate ${name}`);
    if (sweep.counts.succeeded !== counted && sweep.counts.succeeded > 0) showPeaks(sweep);
    counted = sweep.counts.succeeded;
  }

  /** @param {Api.ListedSweep} sweep */
  async function showPeaks(sweep) {
    /** @type {(peak: string, order: string) => Promise<Api.Row | undefined>} */
    const extreme = async (peak, order) => {
      const rows = await findResults(sweep.id,
        { fields: `job_id,${peak}`, [`${peak}_ge`]: 0, order_by: order, limit: 1 }, signal);
      return rows[0];
    };
    try {
      // A described linkage has peaks by the names of its joints: the first one stands for them.
      const [any] = await findResults(sweep.id, { limit: 1 }, signal);
      const peak = usualPeak in any ? usualPeak : Object.keys(any).find((name) => name.startsWith("peak_"));
      if (!peak) return;
      const [least, largest] = await Promise.all([extreme(peak, peak), extreme(peak, `-${peak}`)]);
      const link = (row) => h("a", { href: routeTo("jobs", row.job_id) }, number(row[peak]));
      cells.peaks.replaceChildren(...(least && largest ? [link(least), " … ", link(largest), ` ${unitOf(peak)}`]
        : ["–"]));
    } catch (error) {
      if (error.name !== "AbortError") cells.peaks.textContent = "–";
    }
  }

  return { element, update };
}
