// Types of the pages, for the test system.javascript_types alone: browsers never see them.

/** Types of the interface: "openapi" is made of the service's own OpenAPI document. */
declare namespace Api {
  type Paths = import("openapi").paths;
  type Schemas = import("openapi").components["schemas"];

  type Json<Response> = Response extends { content: { "application/json": infer Answer } } ? Answer : never;
  /** The answer to a GET. */
  type Get<Path extends keyof Paths> =
    Paths[Path] extends { get: { responses: { 200: infer Response } } } ? Json<Response> : never;
  /** The answer to a POST. */
  type Post<Path extends keyof Paths> =
    Paths[Path] extends { post: { responses: infer All } } ? Json<All[keyof All & (200 | 201)]> : never;
  /** The body of a POST. */
  type Body<Path extends keyof Paths> =
    Paths[Path] extends { post: { requestBody: infer Request } } ? Json<Request> : never;
  /** The keys that a GET takes. A list is written with commas; a number may be one that a user has typed. */
  type Query<Path extends keyof Paths> =
    Paths[Path] extends { get: { parameters: { query?: infer Keys } } }
      ? { [Key in keyof Keys]: InAddress<Keys[Key]> } : never;
  type InAddress<Value> = Value extends unknown[] ? string : Value extends number ? number | string : Value;
  /** Query with keys by the names of columns, too: "state", "peak_contact_force_n_ge". */
  type Filters<Path extends keyof Paths> = Query<Path> & { [column: string]: string | number | undefined };
  /** Page of a listing asked for without "fields": its items have all of them. */
  type Page<Path extends keyof Paths> = { items: Listed<Path>[] } & Omit<Get<Path>, "items">;
  type Listed<Path extends keyof Paths> =
    Get<Path> extends { items: (infer Item)[] } ? Required<Item> : never;

  type State = Schemas["State"];
  type Sweep = Get<"/v1/sweeps/{id}">;
  type ListedSweep = Listed<"/v1/sweeps">;
  /** Notes and tags; a sweep of an older program has none. */
  type Labels = Partial<Pick<Sweep, "notes" | "tags">>;
  /** Size and cost of a sweep; null: unknown. */
  type Estimate = Required<Schemas["SweepEstimate"]>;
  type Limit = Required<Schemas["Limit"]>;
  type Search = Omit<Get<"/v1/searches/{id}">, "limits"> & { limits: Limit[] };
  type WearStudy = Get<"/v1/wear-studies/{id}">;
  type Fit = Get<"/v1/fits/{id}">;
  type Optimisation = Get<"/v1/optimisations/{id}">;
  type Measurement = Get<"/v1/measurements/{id}">;
  /** Parameters of a job, which has all of them. */
  type Parameters = Required<Omit<Schemas["Parameters"], "links">>
    & { links: Required<NonNullable<Schemas["Parameters"]["links"]>> };
  type Job = Omit<Get<"/v1/jobs/{id}">, "parameters"> & { parameters: Parameters };
  type DescribedLinkage = Exclude<Parameters["linkage"], string>;
  type DescribedJoint = DescribedLinkage["joints"][string];
  /** Keys of a described linkage whose values are parts by their names. */
  type PartsOfLinkage = { [Key in keyof DescribedLinkage]-?:
    string extends keyof NonNullable<DescribedLinkage[Key]> ? Key : never }[keyof DescribedLinkage];
  type BodyLoad = NonNullable<DescribedLinkage["loads"]>[string];
  /** A row of results that was asked for without "fields"; values of axes and metrics by their names. */
  type Row = Required<Pick<Schemas["ResultRow"], "job_id" | "state">>
    & Pick<Schemas["ResultRow"], "replicate"> & { [column: string]: any };
  /** Columns of samples by the names of their channels. */
  type Columns = { [Channel in keyof Schemas["Trajectory"]["columns"]]-?: number[] }
    & { [channel: string]: number[] };
  type Executor = Schemas["Executors"]["items"][number];
}

/** Address of a view, which ends with the signal. */
type Visit = { kind: string; id: string; query: URLSearchParams; signal: AbortSignal };
/** Page of a sweep, whose charts and table share rows, axes, view and selection. */
type SweepPage = import("/pages/sweep.js").SweepPage;
/** Rows that agree in some columns, whose values these are; mean and extremes of a metric. */
type Group = {
  values: (string | number)[]; jobs: string[]; count: number; min: number; max: number; mean: number | null;
};
type Extremes = { min: number; max: number };
/** Sweep on the page of its analyses, with its numeric axes and the chosen metric. jobId: of one of its jobs. */
type AnalysedSweep = { sweep: Api.Sweep; numbers: string[]; isRpsup: boolean; hasClearance: boolean; jobId: string;
  metric: string };
type Chart = Awaited<ReturnType<typeof import("/core/charts.js").makeChart>>;
/** A curve over time, of one or two channels at its edges. */
type Trace = {
  job: string; channel: string; envelope?: string[]; name: string; colour: () => string; dash?: number[];
  measured?: MeasuredCurve;
};
/** Curve of a measurement, whose id stands in the place of the job's: factor * x(t - shift) + offset. */
type MeasuredCurve = { run: number; factor: number; offset: number; shift: number };
type TimeWindow = import("/run/time_window.js").TimeWindow;

/** Item of a list of studies. */
type Listed = { id: string; name: string; state: string; created_at: string };
/** Requests to the service for studies of one kind. */
interface Studies<Kept, Item extends Listed, Request> {
  path: string;
  list(query: { limit?: number }, signal?: AbortSignal): Promise<{ items: Item[]; next_cursor: string }>;
  find(id: string, signal?: AbortSignal): Promise<Kept>;
  submit(request: Request): Promise<Kept>;
  cancel(id: string): Promise<Kept>;
  retry(id: string): Promise<Kept>;
  remove(id: string): Promise<null>;
  results(id: string, query: Record<string, string | number>, signal: AbortSignal): Promise<any[]>;
  resultsUrl(id: string, query?: { format?: "csv" }): string;
  eventsUrl(id: string): string;
}
type Searches = Studies<Api.Search, Api.Listed<"/v1/searches">, Api.Body<"/v1/searches">>;
type WearStudies = Studies<Api.WearStudy, Api.Listed<"/v1/wear-studies">, Api.Body<"/v1/wear-studies">>;
type Fits = Studies<Api.Fit, Api.Listed<"/v1/fits">, Api.Body<"/v1/fits">>;
type Optimisations =
  Studies<Api.Optimisation, Api.Listed<"/v1/optimisations">, Api.Body<"/v1/optimisations">>;
type AnyStudies = Searches | WearStudies | Fits | Optimisations;

interface Array<T> {
  filter(isGiven: BooleanConstructor): Exclude<T, false | null | undefined | "" | 0>[];
}
interface Window {
  /** Function of the package swagger-ui-dist, which has no types. */
  SwaggerUIBundle(options: object): unknown;
}
