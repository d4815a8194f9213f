// SPDX-License-Identifier: Apache-2.0
// The only place that asks the service.

/// Refusal of a request by the service, with every fault and its place in the request.
export class Refusal extends Error {
  /** @param {Partial<Api.Schemas["Problem"]>} problem  @param {number} status */
  constructor(problem, status) {
    super(problem.detail || problem.title || `The service answered ${status}.`);
    this.name = "Refusal";
    this.status = status;
    this.faults = problem.errors ?? [];
  }
}

/// True of an error that may pass: the service, or something in front of it, does not answer, starts anew or is busy.
/// Asking again may help.
export const isTransient = (error) =>
  error.name === "Unreachable" || [502, 503, 504].includes(error.status);

/// The service does not answer.
class Unreachable extends Error {
  constructor() {
    super("The service does not answer.");
    this.name = "Unreachable";
  }
}

/// Path before those of the service, if a proxy shows it under one: "/rpsup".
const base = new URL("..", import.meta.url).pathname.replace(/\/$/, "");
/// Path of the service as the browser reaches it. @type {(path: string) => string}
export const addressOf = (path) => base + path;

/// Answer to a request. @param type  of a body that is sent as it is; without it the body is sent as JSON
/// @param key  by which the service knows the request again
/**
 * @param {string} path
 * @param {{ method?: string, body?: any, type?: string, key?: string, signal?: AbortSignal }} options
 * @returns {Promise<any>} of JSON; null where there is none
 */
export async function ask(path, { method = "GET", body, type, key, signal } = {}) {
  /** @type {Record<string, string>} */
  const headers = body === undefined ? {} : { "Content-Type": type ?? "application/json" };
  if (key) headers["Idempotency-Key"] = key;
  let answer;
  let text;
  try {
    answer = await fetch(path,
      { method, headers, signal, body: body === undefined || type ? body : JSON.stringify(body) });
    text = await answer.text();
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Unreachable();
  }
  if (answer.status === 204) return null;
  if (!answer.ok) throw new Refusal(problemOf(text), answer.status);
  return JSON.parse(text);
}

/// Keys of submissions without an answer, by path and body.
/** @type {Map<string, string>} */
const unanswered = new Map();

const freshKey = () => crypto.getRandomValues(new Uint32Array(4)).join("-");

/// Text that tells the body of a request from others.
/** @param {any} body */
function markOf(body) {
  if (body instanceof File) return `${body.name} ${body.size} ${body.lastModified}`;
  return typeof body === "string" ? body : JSON.stringify(body);
}

/// Answer to a submission. What is sent again for want of an answer has the same key, and is stored once.
/** @param {string} path  @param {any} body  @param {string} [type]  @returns {Promise<any>} */
async function submit(path, body, type) {
  const sent = `${path} ${markOf(body)}`;
  const key = unanswered.get(sent) ?? freshKey();
  try {
    const answer = await ask(path, { method: "POST", body, type, key });
    unanswered.delete(sent);
    return answer;
  } catch (error) {
    // 409: the first one is still being stored.
    if (isTransient(error) || error.status === 409) unanswered.set(sent, key);
    else unanswered.delete(sent);
    throw error;
  }
}

function problemOf(text) {
  try {
    return JSON.parse(text);
  } catch {
    return {};
  }
}

/** @type {(id: string) => string} */
const sweepPath = (id) => addressOf(`/v1/sweeps/${encodeURIComponent(id)}`);
/** @type {(id: string) => string} */
const jobPath = (id) => addressOf(`/v1/jobs/${encodeURIComponent(id)}`);
/** @type {(path: string, query?: object) => string} */
const withQuery = (path, query = {}) => {
  const set = Object.entries(query).filter(([, value]) => value !== undefined && value !== "");
  return set.length === 0 ? path : `${path}?${new URLSearchParams(set)}`;
};

/// Whether the service answers, and the version of its program.
/** @type {(signal?: AbortSignal) => Promise<Api.Get<"/healthz">>} */
export const findHealth = (signal) => ask(addressOf("/healthz"), { signal });
/** @type {(query: Api.Query<"/v1/sweeps">, signal: AbortSignal) => Promise<Api.Page<"/v1/sweeps">>} */
export const listSweeps = (query, signal) => ask(withQuery(addressOf("/v1/sweeps"), query), { signal });
/** @type {(signal: AbortSignal) => Promise<Api.Get<"/v1/executors">>} */
export const listExecutors = (signal) => ask(addressOf("/v1/executors"), { signal });
/** @type {(id: string, signal?: AbortSignal) => Promise<Api.Sweep>} */
export const findSweep = (id, signal) => ask(sweepPath(id), { signal });
/** @type {(request: Api.Body<"/v1/sweeps">) => Promise<Api.Sweep>} */
export const submitSweep = (request) => submit(addressOf("/v1/sweeps"), request);
/// Number and cost of the jobs of a sweep that is not submitted. @throws what a submission would
/** @type {(request: Api.Body<"/v1/sweeps">, signal: AbortSignal) => Promise<Api.Estimate>} */
export const estimateSweep = (request, signal) => ask(addressOf("/v1/sweeps?dry_run=true"),
  { method: "POST", body: request, signal });
/** @type {(id: string) => Promise<Api.Post<"/v1/sweeps/{id}/cancel">>} */
export const cancelSweep = (id) => ask(`${sweepPath(id)}/cancel`, { method: "POST" });
/** @type {(id: string) => Promise<Api.Post<"/v1/sweeps/{id}/retry">>} */
export const retrySweep = (id) => ask(`${sweepPath(id)}/retry`, { method: "POST" });
/** @type {(id: string, labels: Api.Schemas["SweepDescription"]) => Promise<Api.Sweep>} */
export const changeSweep = (id, labels) => ask(sweepPath(id), { method: "PATCH", body: labels });
/** @type {(id: string, addition: Api.Body<"/v1/sweeps/{id}/extend">) => Promise<Api.Sweep>} */
export const extendSweep = (id, addition) => ask(`${sweepPath(id)}/extend`, { method: "POST", body: addition });
/** @type {(id: string) => Promise<null>} */
export const deleteSweep = (id) => ask(sweepPath(id), { method: "DELETE" });
/**
 * @type {(id: string, query: Api.Filters<"/v1/sweeps/{id}/results">, signal: AbortSignal) =>
 *   Promise<Api.Row[]>}
 */
export const findResults = (id, query, signal) => ask(resultsUrl(id, query), { signal });
/** @type {(id: string, signal: AbortSignal) => Promise<Api.Job>} */
export const findJob = (id, signal) => ask(jobPath(id), { signal });
/** @type {(parameters: Api.Body<"/v1/jobs">) => Promise<Api.Job>} */
export const submitJob = (parameters) => submit(addressOf("/v1/jobs"), parameters);
/** @type {(id: string) => Promise<Api.Post<"/v1/jobs/{id}/cancel">>} */
export const cancelJob = (id) => ask(`${jobPath(id)}/cancel`, { method: "POST" });
/// Requests to the service for studies of one kind.
/** @param {string} path  @returns {Studies<any, any, any>} */
function studies(path) {
  /** @type {(id: string) => string} */
  const of = (id) => `${path}/${encodeURIComponent(id)}`;
  return {
    path,
    list: (query, signal) => ask(withQuery(path, query), { signal }),
    find: (id, signal) => ask(of(id), { signal }),
    submit: (request) => submit(path, request),
    cancel: (id) => ask(`${of(id)}/cancel`, { method: "POST" }),
    retry: (id) => ask(`${of(id)}/retry`, { method: "POST" }),
    remove: (id) => ask(of(id), { method: "DELETE" }),
    results: (id, query, signal) => ask(withQuery(`${of(id)}/results`, query), { signal }),
    resultsUrl: (id, query) => withQuery(`${of(id)}/results`, query),
    eventsUrl: (id) => `${of(id)}/events`,
  };
}

/** @type {Searches} */
export const searches = studies(addressOf("/v1/searches"));
/** @type {WearStudies} */
export const wearStudies = studies(addressOf("/v1/wear-studies"));
/** @type {Fits} */
export const fits = studies(addressOf("/v1/fits"));
/** @type {Optimisations} */
export const optimisations = studies(addressOf("/v1/optimisations"));

/// Samples of a fit with measured and predicted value. @param query  columns with the values to filter by
/**
 * @type {(id: string, query: Api.Filters<"/v1/fits/{id}/signals">, signal: AbortSignal) =>
 *   Promise<Required<Api.Schemas["FitSignalRows"][number]>[]>}
 */
export const findFitSignals = (id, query, signal) =>
  ask(withQuery(`${fits.path}/${encodeURIComponent(id)}/signals`, query), { signal });

/** @type {(id?: string) => string} */
const measurementPath = (id) => addressOf(`/v1/measurements${id ? `/${encodeURIComponent(id)}` : ""}`);
/**
 * @type {(query: Api.Query<"/v1/measurements">, signal: AbortSignal) =>
 *   Promise<Api.Page<"/v1/measurements">>}
 */
export const listMeasurements = (query, signal) => ask(withQuery(measurementPath(), query), { signal });
/** @type {(id: string, signal: AbortSignal) => Promise<Api.Measurement>} */
export const findMeasurement = (id, signal) => ask(measurementPath(id), { signal });
/** @type {(id: string) => Promise<null>} */
export const deleteMeasurement = (id) => ask(measurementPath(id), { method: "DELETE" });
/// Stores the text or the bytes of a file. @param query  name, time, channels
/** @type {(content: string | File, type: string, query: object) => Promise<Api.Measurement>} */
export const submitMeasurement = (content, type, query) =>
  submit(withQuery(measurementPath(), query), content, type);
/** @param {string} id  @param {Api.Query<"/v1/measurements/{id}/data">} query */
export const measurementDataUrl = (id, query = {}) => withQuery(`${measurementPath(id)}/data`, query);
/// Columns of a run, with its time as "t_s".
/**
 * @type {(id: string, query: Api.Query<"/v1/measurements/{id}/data">, signal: AbortSignal) =>
 *   Promise<Record<string, number[]>>}
 */
export const findMeasured = (id, query, signal) => ask(measurementDataUrl(id, query), { signal })
  .then(({ columns }) => columns);

/** @type {(id: string) => string} */
export const eventsUrl = (id) => `${sweepPath(id)}/events`;

/** @typedef {"paper" | "sensitivity" | "surrogate" | "flexibility" | "bifurcation" | "lyapunov"} Analysis */

/// Analysis of a sweep.
/**
 * @type {<Name extends Analysis>(id: string, analysis: Name,
 *   query?: Api.Query<`/v1/sweeps/{id}/${Name}`>) => string}
 */
export const analysisUrl = (id, analysis, query) => withQuery(`${sweepPath(id)}/${analysis}`, query);
/**
 * @type {<Name extends Analysis>(id: string, analysis: Name, query: Api.Query<`/v1/sweeps/{id}/${Name}`>,
 *   signal: AbortSignal) => Promise<Api.Get<`/v1/sweeps/{id}/${Name}`>>}
 */
export const findAnalysis = (id, analysis, query, signal) => ask(analysisUrl(id, analysis, query), { signal });
/** @type {(id: string, query?: Api.Query<"/v1/sweeps/{id}/report">) => string} */
export const reportUrl = (id, query) => withQuery(`${sweepPath(id)}/report`, query);
/// Analysis of a job, as columns: spectrum, poincare.
/**
 * @type {<Name extends "spectrum" | "poincare">(id: string, analysis: Name,
 *   query: Api.Query<`/v1/jobs/{id}/${Name}`>, signal: AbortSignal) => Promise<Record<string, number[]>>}
 */
export const findMotion = (id, analysis, query, signal) => ask(withQuery(`${jobPath(id)}/${analysis}`, query),
  { signal }).then(({ columns }) => columns);

/**
 * @type {(id: string, query: Api.Query<"/v1/jobs/{id}/wear">, signal: AbortSignal) =>
 *   Promise<Api.Get<"/v1/jobs/{id}/wear">>}
 */
export const findWear = (id, query, signal) => ask(withQuery(`${jobPath(id)}/wear`, query), { signal });

/** @param {string} id  @param {Api.Filters<"/v1/sweeps/{id}/results">} query */
export function resultsUrl(id, query = {}) {
  return withQuery(`${sweepPath(id)}/results`, query);
}

/** @param {string} id  @param {Api.Query<"/v1/jobs/{id}/trajectory">} query */
export function trajectoryUrl(id, query = {}) {
  return withQuery(`${jobPath(id)}/trajectory`, query);
}

/// Columns of a trajectory by their names. @param query  channels (a list), from, to, points
/**
 * @param {string} id
 * @param {{ channels?: string[], from?: number, to?: number, points?: number }} query
 * @param {AbortSignal} signal
 * @returns {Promise<Api.Columns>}
 */
export async function findTrajectory(id, { channels, ...query }, signal) {
  const answer = await ask(trajectoryUrl(id, { channels: channels?.join(","), ...query }), { signal });
  return answer.columns;
}

/// Poses of the links of a linkage at t = 0 by their names, and the number of its degrees of freedom.
/** @type {(parameters: any, signal: AbortSignal) => Promise<Api.Post<"/v1/linkages/assembly">>} */
export const findAssembly = (parameters, signal) => ask(addressOf("/v1/linkages/assembly"),
  { method: "POST", body: { parameters }, signal });

/// One of the linkages that the program brings along, as a set of parameters.
/** @type {(name: string, signal: AbortSignal) => Promise<Api.Schemas["Parameters"]>} */
export const exampleLinkage = (name, signal) => ask(addressOf(`/linkages/${name}.json`), { signal });

/// The JSON Schemas of all requests, by their names in the interface's description.
/** @type {(signal: AbortSignal) => Promise<Record<string, any>>} */
export const requestSchemas = (signal) => ask(addressOf("/v1/openapi.json"), { signal })
  .then(({ components }) => components.schemas);

/** @type {Promise<any> | null} */
let schema = null;

/// The JSON Schema of the parameters, asked for once.
/** @returns {Promise<any>} */
export function parameterSchema() {
  schema ??= ask(addressOf("/v1/parameters")).catch((error) => {
    schema = null;
    throw error;
  });
  return schema;
}
