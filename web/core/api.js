// The only place that asks the service.

/// What the service refused, with every fault and its place in the request.
export class Refusal extends Error {
  constructor(problem, status) {
    super(problem.detail || problem.title || `The service answered ${status}.`);
    this.name = "Refusal";
    this.status = status;
    this.faults = problem.errors ?? [];
  }
}

/// The service is not there, or something in front of it says so: asking again may help, as while it starts anew.
export const isAway = (error) => error.name === "Away" || [502, 503, 504].includes(error.status);

/// There was no answer.
class Away extends Error {
  constructor() {
    super("The service does not answer.");
    this.name = "Away";
  }
}

export async function ask(path, { method = "GET", body, signal } = {}) {
  const headers = body === undefined ? {} : { "Content-Type": "application/json" };
  let answer;
  let text;
  try {
    answer = await fetch(path, { method, headers, signal, body: body === undefined ? undefined : JSON.stringify(body) });
    text = await answer.text();
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Away();
  }
  if (answer.status === 204) return null;
  if (!answer.ok) throw new Refusal(problemOf(text), answer.status);
  return JSON.parse(text);
}

function problemOf(text) {
  try {
    return JSON.parse(text);
  } catch {
    return {};
  }
}

const sweepPath = (id) => `/v1/sweeps/${encodeURIComponent(id)}`;
const jobPath = (id) => `/v1/jobs/${encodeURIComponent(id)}`;
const withQuery = (path, query) => {
  const set = Object.entries(query).filter(([, value]) => value !== undefined && value !== "");
  return set.length === 0 ? path : `${path}?${new URLSearchParams(set)}`;
};

export const findHealth = (signal) => ask("/healthz", { signal });
export const listSweeps = (query, signal) => ask(withQuery("/v1/sweeps", query), { signal });
export const listExecutors = (signal) => ask("/v1/executors", { signal });
export const listJobs = (query, signal) => ask(withQuery("/v1/jobs", query), { signal });
export const findSweep = (id, signal) => ask(sweepPath(id), { signal });
export const submitSweep = (request) => ask("/v1/sweeps", { method: "POST", body: request });
export const cancelSweep = (id) => ask(`${sweepPath(id)}/cancel`, { method: "POST" });
export const retrySweep = (id) => ask(`${sweepPath(id)}/retry`, { method: "POST" });
export const deleteSweep = (id) => ask(sweepPath(id), { method: "DELETE" });
export const findResults = (id, query, signal) => ask(resultsUrl(id, query), { signal });
export const findJob = (id, signal) => ask(jobPath(id), { signal });
export const submitJob = (parameters) => ask("/v1/jobs", { method: "POST", body: parameters });
export const cancelJob = (id) => ask(`${jobPath(id)}/cancel`, { method: "POST" });
/// What the service does with studies of one kind.
function studies(path) {
  const of = (id) => `${path}/${encodeURIComponent(id)}`;
  return {
    path,
    list: (query, signal) => ask(withQuery(path, query), { signal }),
    find: (id, signal) => ask(of(id), { signal }),
    submit: (request) => ask(path, { method: "POST", body: request }),
    cancel: (id) => ask(`${of(id)}/cancel`, { method: "POST" }),
    retry: (id) => ask(`${of(id)}/retry`, { method: "POST" }),
    remove: (id) => ask(of(id), { method: "DELETE" }),
    resultsUrl: (id, query = {}) => withQuery(`${of(id)}/results`, query),
    eventsUrl: (id) => `${of(id)}/events`,
  };
}

export const searches = studies("/v1/searches");
export const wearStudies = studies("/v1/wear-studies");

export const eventsUrl = (id) => `${sweepPath(id)}/events`;

/// What is worked out of a sweep: paper, sensitivity, surrogate, flexibility, bifurcation, lyapunov.
export const analysisUrl = (id, analysis, query = {}) => withQuery(`${sweepPath(id)}/${analysis}`, query);
export const findAnalysis = (id, analysis, query, signal) => ask(analysisUrl(id, analysis, query), { signal });
export const reportUrl = (id) => `${sweepPath(id)}/report`;
/// What is worked out of a job, as columns: spectrum, poincare.
export const findMotion = (id, analysis, query, signal) => ask(withQuery(`${jobPath(id)}/${analysis}`, query), { signal }).then(({ columns }) => columns);

export const findWear = (id, query, signal) => ask(withQuery(`${jobPath(id)}/wear`, query), { signal });

export function resultsUrl(id, query = {}) {
  return withQuery(`${sweepPath(id)}/results`, query);
}

export function trajectoryUrl(id, query = {}) {
  return withQuery(`${jobPath(id)}/trajectory`, query);
}

/// Columns of a trajectory by their names. @param query  channels (a list), from, to, points
export async function findTrajectory(id, { channels, ...query }, signal) {
  const answer = await ask(trajectoryUrl(id, { channels: channels?.join(","), ...query }), { signal });
  return answer.columns;
}

/// One of the linkages that the program brings along, as a set of parameters.
export const exampleLinkage = (name, signal) => ask(`/linkages/${name}.json`, { signal });

/// The JSON Schemas of all requests, by their names in the interface's description.
export const requestSchemas = (signal) => ask("/v1/openapi.json", { signal }).then(({ components }) => components.schemas);

let schema = null;

/// The JSON Schema of the parameters, asked for once.
export function parameterSchema() {
  schema ??= ask("/v1/parameters").catch((error) => {
    schema = null;
    throw error;
  });
  return schema;
}
