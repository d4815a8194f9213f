// SPDX-License-Identifier: Apache-2.0
// Pages of sweeps whose rows a test gives: what no short sweep has.
import { visit } from "./visitor.mjs";

export const metric = "peak_slider_acceleration_m_s2";
export const force = "peak_contact_force_n";

/** A row of a job that was computed. */
export const row = (number, values) => ({ job_id: `job_${number}`, state: "succeeded", ...values });

/** Address of the question why jobs have failed. */
export const reasons = "**/v1/sweeps/swp_given/results?state=failed**";

/** Rows of the paper's seven statements, and of one without a number, over so many settings. */
export function paperRows(settings) {
  const holds = (number) => settings === 1 && number !== 3;
  const found = (number) => (number === 5 ? { settings: 0, share: null, holds: null, found_least: null, found_largest: null }
    : { settings, share: settings === 1 ? Number(holds(number)) : 0.43, holds: holds(number), found_least: number ?? 8, found_largest: number === 6 ? 6.5 : number ?? 8 });
  const indices = (number) => (settings < 50 ? {} : { "index.bearing_length_mm": null, "index.coupler_damping_ratio": number === 2 ? 0.25 : 0.019,
    "index.restitution": number === 2 ? 0.6 : 0.02 });
  return [1, 2, 3, 4, 5, 6, 7, null].map((number) => ({ statement: `statement_${number}`, number, text: `ratio ${number}`, paper: number === 2 ? 8.5 : null,
    ...found(number), ...indices(number) }));
}

/** The page of a sweep that the service does not have. @param told  how it is looked at, the parameters of all jobs, rows of failures, more of the sweep, the window's width */
export async function visitRows(axes, rows, { query = "", parameters = {}, failures = [], more = {},
  width = 1360, isSchemaGone = false, isUnreachable = false } = {}) {
  const page = await visit("#/wear", { viewport: { width, height: 1000 } });
  if (isSchemaGone) await page.route("**/v1/parameters", (route) => route.abort());
  const count = (state) => rows.filter((each) => each.state === state).length;
  const counts = { queued: 0, running: 0, succeeded: count("succeeded"), failed: count("failed"), cancelled: 0, total: rows.length };
  const sweep = { id: "swp_given", name: "given", state: "succeeded", counts, progress: 1, eta_s: null, axes, request: { parameters } };
  const give = (pattern, found) => page.route(pattern, (route) => route.fulfill({ json: found(new URL(route.request().url())) }));
  await give("**/v1/sweeps/swp_given", () => ({ ...sweep, ...more }));
  await give("**/v1/sweeps/swp_given/paper**", () => paperRows(1));
  await give("**/v1/jobs/*", () => ({ run: null }));
  await give("**/v1/sweeps/swp_given/results**", ({ searchParams }) => (searchParams.has("state") ? failures : rows));
  if (isUnreachable) await page.route(reasons, (route) => route.abort());
  await page.evaluate((view) => { location.hash = view; }, `#/sweeps/swp_given${query}`);
  await page.locator(".chart canvas").nth(2).waitFor();
  return page;
}

/** A chart as ECharts holds it: the ends of its axes, its title, and the numbers of its lines. */
export function drawn(page, place) {
  return page.locator(".chart").nth(place).evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    const model = getInstanceByDom(element).getModel();
    const axis = (kind) => model.queryComponents({ mainType: kind }).map(({ option, axis: { scale } }) => ({ type: option.type, name: option.name, ends: scale.getExtent() }));
    return { x: axis("xAxis"), y: axis("yAxis"), parallel: axis("parallelAxis"), titles: model.queryComponents({ mainType: "title" }).map(({ option }) => option.text),
      colours: model.queryComponents({ mainType: "visualMap" }).map(({ option }) => [option.min, option.max]), series: model.getSeries().map(({ option }) => option.data), said: element.getAttribute("aria-label") };
  });
}
