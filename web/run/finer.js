// SPDX-License-Identifier: Apache-2.0
// A button that has the stretch of time in sight computed once more with more samples.
import { findJob, submitJob } from "/core/api.js";
import { h } from "/core/dom.js";
import { number } from "/core/format.js";
import { latest, pause, retryWhileUnreachable } from "/core/live.js";
import { routeTo } from "/core/route.js";

const samplesInSight = 5000;
const mostHz = 100000;
const mostSamples = 2e6;  // of a run
const pollMs = 500;

/// Rate at which the stretch has enough samples, in steps of 1, 2 and 5; 0: the job's own rate gives as many.
/** @param {Pick<TimeWindow, "from" | "to">} stretch  @param {number} own  the job's rate [Hz] */
function finerRate({ from, to }, own) {
  const most = Math.min(mostHz, mostSamples / to);
  const wanted = Math.min(samplesInSight / (to - from), most);
  const decade = 10 ** Math.floor(Math.log10(wanted));
  const step = [5, 2, 1].find((each) => each * decade <= wanted * (1 + 1e-9)) ?? 1;
  const rate = step * decade;
  return rate > own * (1 + 1e-9) ? rate : 0;
}

/// The button, and a link to the run that it has asked for.
/** @param {TimeWindow} times  @param {Api.Job} job  @param {AbortSignal} signal */
export function finerButton(times, job, signal) {
  const told = h("span", { class: "small", role: "status" });
  const button = h("button", { onclick: () => run().catch((error) => { told.textContent = error.message; }) });

  function draw() {
    const rate = finerRate(times, job.parameters.output_rate_hz);
    button.disabled = rate === 0;
    button.textContent = rate === 0 ? "Compute finely" : `Compute finely, at ${number(rate / 1000)} kHz`;
    button.title = rate === 0 ? "Look closer first: this stretch has samples enough."
      : `A job with the same parameters that ends at ${number(times.to, 6)} s`;
  }

  const run = latest(async (current) => {
    const { from, to } = times;
    const rate = finerRate(times, job.parameters.output_rate_hz);
    const short = (value) => Number(value.toPrecision(7));
    told.textContent = "Submitting …";
    const { id, state } = await submitJob({ ...job.parameters, duration_s: short(to), output_rate_hz: rate,
      keep: "all" });
    current.throwIfAborted();
    const link = h("a", { href: routeTo("jobs", id, { from: short(from), to: short(to) }) },
      `job …${id.slice(-5)}`);
    const tell = (text) => text && told.replaceChildren("Finer run: ", link, `, ${text}`);
    for (let now = state; ; { state: now } = await retryWhileUnreachable(() => findJob(id, current), tell, current)) {
      tell(now);
      if (now !== "queued" && now !== "running") break;
      await pause(pollMs, current);
    }
  }, signal);

  times.addEventListener("change", draw, { signal });
  draw();
  return [button, told];
}
