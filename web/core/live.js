// SPDX-License-Identifier: Apache-2.0
// Follows sweeps and studies as they run: by server-sent events, and by asking again where those are not to be had.
import { eventsUrl, findSweep, isTransient } from "/core/api.js";

const pollMs = 2000;

/** @type {(sweep: Pick<Api.Sweep, "counts">) => boolean} */
export const isUnderWay = (sweep) => sweep.counts.queued + sweep.counts.running > 0;

/** @typedef {Pick<Api.Sweep, "state" | "counts" | "progress" | "eta_s">} Progress */
/** @typedef {{ progress?: (now: Progress) => void, job?: (job: Api.Job) => void, done?: () => void }} Told */

/// Tells each change of a sweep until it has ended or the signal is given.
/// @param told.progress  gets counts, progress and time left
/// @param told.job       gets a job that has ended
/// @param told.done      the sweep has ended
/**
 * @param {string} id
 * @param {Told} told
 * @param {AbortSignal} signal
 */
export function follow(id, told, signal) {
  followEvents({ events: eventsUrl(id), find: () => findSweep(id, signal), isUnderWay }, told, signal);
}

/// The same of a study. @param api  of its kind
/**
 * @param {AnyStudies} api
 * @param {string} id
 * @param {{ progress?: (now: any) => void, done?: () => void }} told
 * @param {AbortSignal} signal
 */
export function followStudy(api, id, told, signal) {
  followEvents({ events: api.eventsUrl(id), find: () => api.find(id, signal),
    isUnderWay: ({ state }) => state === "running" }, told, signal);
}

function followEvents(source, told, signal) {
  const events = new EventSource(source.events);
  const stop = () => events.close();
  signal.addEventListener("abort", stop, { once: true });
  events.addEventListener("progress", (event) => told.progress?.(JSON.parse(event.data)));
  events.addEventListener("job", (event) => told.job?.(JSON.parse(event.data)));
  events.addEventListener("done", () => {
    stop();
    told.done?.();
  });
  events.addEventListener("error", () => {
    // A connection that broke is taken up again by the browser; one that was refused is not.
    if (events.readyState === EventSource.CLOSED && !signal.aborted) poll(source, told, signal);
  });
}

async function poll(source, told, signal) {
  while (!signal.aborted) {
    try {
      const now = await source.find();
      told.progress?.(now);
      if (!source.isUnderWay(now)) return told.done?.();
    } catch (error) {
      if (error.name === "AbortError" || error.status === 404) return undefined;
    }
    await new Promise((resolve) => { setTimeout(resolve, pollMs); });
  }
  return undefined;
}

/// Result of a function that asks the service; it is called again while the service is away or busy.
/// @param tell  is given what there is to say meanwhile, and "" at the end
/**
 * @template Found
 * @param {() => Promise<Found>} asked
 * @param {(text: string) => void} tell
 * @param {AbortSignal} signal
 * @returns {Promise<Found>}
 */
export async function retryWhileUnreachable(asked, tell, signal) {
  for (;;) {
    try {
      const found = await asked();
      tell("");
      return found;
    } catch (error) {
      if (!isTransient(error)) throw error;
      tell(`${error.message} Trying again …`);
    }
    await pause(pollMs, signal);
  }
}

/// Resolves after so many milliseconds. @throws an AbortError when the signal is given
/** @param {number} milliseconds  @param {AbortSignal} signal  @returns {Promise<void>} */
export function pause(milliseconds, signal) {
  return new Promise((resolve, reject) => {
    const stop = () => { clearTimeout(timer); reject(signal.reason); };
    const timer = setTimeout(() => { signal.removeEventListener("abort", stop); resolve(); }, milliseconds);
    signal.addEventListener("abort", stop, { once: true });
  });
}

/// A function that runs the given one with a signal of its own, which is given as soon as it is called again:
/// an answer to what was asked before covers no newer one.
/**
 * @template {unknown[]} Given
 * @param {(signal: AbortSignal, ...given: Given) => Promise<void>} run
 * @param {AbortSignal} signal
 * @returns {(...given: Given) => Promise<void>}
 */
export function latest(run, signal) {
  let overtaken = new AbortController();
  return async (...given) => {
    overtaken.abort();
    overtaken = new AbortController();
    try {
      await run(AbortSignal.any([signal, overtaken.signal]), ...given);
    } catch (error) {
      if (error.name !== "AbortError") throw error;
    }
  };
}

/// A function that runs the given one after its earlier runs, so that no answer covers a newer one. Who calls while
/// a call waits for its turn is given that one.
/** @param {() => Promise<void>} run  @returns {() => Promise<void>} */
export function inTurn(run) {
  /** @type {Promise<void> | null} */
  let waiting = null;
  let running = Promise.resolve();
  return () => {
    waiting ??= running.then(() => {
      waiting = null;
      running = run();
      return running;
    });
    return waiting;
  };
}

/// Runs a function again so many milliseconds after its end, while the page is seen, until the signal is given.
/** @param {() => Promise<void>} run  @param {number} milliseconds  @param {AbortSignal} signal */
export async function keepRunning(run, milliseconds, signal) {
  while (!signal.aborted) {
    await new Promise((resolve) => { setTimeout(resolve, milliseconds); });
    if (!signal.aborted && !document.hidden) await run();
  }
}

/// A function that runs the given one at most once in so many milliseconds (or as many as a function gives), and
/// always after the last call.
/** @param {() => unknown} run  @param {number | (() => number)} milliseconds */
export function throttle(run, milliseconds) {
  let timer = null;
  return () => {
    timer ??= setTimeout(() => {
      timer = null;
      run();
    }, typeof milliseconds === "function" ? milliseconds() : milliseconds);
  };
}

/// A function that runs the given one once it has not been called for so many milliseconds.
/** @param {() => unknown} run  @param {number} milliseconds */
export function debounce(run, milliseconds) {
  /** @type {number | undefined} */
  let timer;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(run, milliseconds);
  };
}
