// SPDX-License-Identifier: Apache-2.0
// Verdicts say what they stand on: single runs, replicates, and at how many values was looked.   node verdicts.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { drawn } from "./given.mjs";
import { ask, endVisits, expectAccessible, leave, picture, runSweep, textOf, url, visit } from "./visitor.mjs";

after(endVisits);
const short = { duration_s: 0.3, run_up_s: 0.1 };

/** Texts of the cells of a table. */
const cells = (page, name) => page.getByRole("region", { name, exact: true }).locator("tbody tr")
  .evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));

/** The search with this request, once it has ended. */
async function runSearch(request) {
  let search = await ask("/v1/searches", request);
  for (const end = Date.now() + 120_000; search.state === "running"; search = await ask(`/v1/searches/${search.id}`)) {
    assert.ok(Date.now() < end);
    await new Promise((resolve) => { setTimeout(resolve, 100); });
  }
  return search;
}

test("flexibility helps or harms by replicates only", async () => {
  const parameters = { ...short, clearance_mm: 0.2 };
  const sweep = { crank_velocity_rad_s: [9, 11], coupler: ["rigid", "flexible"] };
  const single = await runSweep({ name: "single runs", parameters, sweep });
  assert.ok((await ask(`/v1/sweeps/${single.id}/flexibility`)).every(({ verdict }) => verdict === "one_run_each"));
  const page = await visit(`#/analyses/${single.id}`);
  await page.getByText("Each ratio comes from one run each, which may scatter by more than they differ: replicates give a verdict.").waitFor();
  assert.deepEqual((await cells(page, "Rigid and flexible")).map((row) => row.slice(2, 4)), [["–", "one run each"], ["–", "one run each"]]);
  assert.equal(await page.getByText(/[Rr]eversal/).count(), 0, "nothing is known of reversals");
  await expectAccessible(page);
  await picture(page, "flexibility_single");
  await leave(page);
  const many = await runSweep({ name: "replicated", parameters, sweep, replicates: { count: 2 } });
  const pairs = await ask(`/v1/sweeps/${many.id}/flexibility`);
  const other = await visit(`#/analyses/${many.id}`);
  await other.getByRole("region", { name: "Rigid and flexible" }).waitFor();
  const shown = await cells(other, "Rigid and flexible");
  assert.deepEqual(shown.map((row) => row[3]), pairs.map(({ verdict }) => (verdict === "either" ? "no difference" : verdict)));
  assert.ok(shown.every((row) => / to /.test(row[2])));
  assert.equal(await other.getByText("one run each").count(), 0);
  await leave(other);
});

test("a limit that was not exceeded says at how many values was looked, and has no band of single runs", async () => {
  const request = { parameters: short, over: { clearance_mm: { from: 0.05, to: 0.3, tolerance: 0.1, first: 3 } }, metric: "max_penetration_um", bound: 1000,
    sweep: { crank_velocity_rad_s: [8] } };
  const single = await runSearch({ name: "one run each", ...request });
  const page = await visit(`#/searches/${single.id}`);
  await page.getByText("before Max penetration [µm] first exceeds 1000.").waitFor();
  await page.getByText("One run at each value: how much the metric scatters is not known").waitFor();
  assert.deepEqual((await cells(page, "Limits"))[0].slice(1, 4), ["not exceeded at any of the 3 values looked at Look at more", "beyond 0.3", "3"]);
  await page.getByRole("link", { name: "Look at more" }).click();
  await page.waitForURL(/searches\/new/);
  assert.equal(await page.getByLabel("Number of initial values").inputValue(), "5");
  await page.goBack();
  assert.equal(await page.getByText(/in all/).count(), 0);
  await page.locator(".chart canvas").nth(1).waitFor();
  await expectAccessible(page);
  await picture(page, "limit_single", { fullPage: true });
  await leave(page);
  const many = await runSearch({ name: "two runs each", ...request, replicates: { count: 2 } });
  const other = await visit(`#/searches/${many.id}`);
  await other.getByText("first exceeds 1000 in more than 10 % of the replicates.").waitFor();
  await other.getByRole("columnheader", { name: "OK in all up to [mm]" }).waitFor();
  assert.equal(await other.getByText("One run at each value").count(), 0);
  await leave(other);
});

/** A limit over a velocity. */
const limit = (velocity, verdict, value) => ({ crank_velocity_rad_s: velocity, verdict, limit: value, limit_beyond: value === null ? null : value + 0.01,
  band_from: null, band_to: null, falls: [], points: [], evaluations: 3, lost_reason: null, monotonic: true });
/** A search that the service does not have. */
const given = { id: "sch_given", sweep_id: "swp_given", name: "given", state: "succeeded", error: null, progress: 1, counts: { succeeded: 9, total: 9 },
  axes: ["crank_velocity_rad_s"], parameter: "clearance_mm", metric: "max_penetration_um", bound: 4, quantile: 0.9,
  request: { over: { clearance_mm: { from: 0.05, to: 0.3 } } }, limits: [limit(10, "found", 0.2), limit(8, "always_exceeded", null), limit(5, "found", 0.1), limit(12, "lost", null)] };

test("the line of limits has a gap and a cross where there is no limit", async () => {
  const page = await visit("#/help");
  await page.route("**/v1/searches/sch_given", (route) => route.fulfill({ json: given }));
  await page.goto(`${url}/#/searches/sch_given`);
  await page.locator(".chart canvas").nth(1).waitFor();
  const { series } = await drawn(page, 0);
  assert.deepEqual(series[1].map(({ value }) => value), [[5, 0.1], [8, "-"], [10, 0.2], [12, "-"]]);
  const { text } = await textOf(page, () => page.getByRole("button", { name: "SVG" }).first().click());
  assert.equal(text.split(">×<").length - 1, 2, "crosses");
  await picture(page, "limit_gap");
  await leave(page);
});

test("the end of a search is shown also where the service is busy just then", async () => {
  const page = await visit("#/help");
  let asked = 0;
  await page.route("**/v1/searches/sch_given/events", (route) => route.fulfill({ status: 503, body: "{}" }));
  await page.route("**/v1/searches/sch_given", (route) => {
    asked += 1;
    if (asked > 2 && asked < 6) return route.fulfill({ status: 503, json: { detail: "the service is busy" } });
    return route.fulfill({ json: asked === 1 ? { ...given, state: "running", progress: 0.5 } : given });
  });
  await page.goto(`${url}/#/searches/sch_given`);
  await page.getByText("running: 50 %").waitFor();
  await page.getByText("the service is busy Trying again …").waitFor();
  await page.getByText("succeeded: 100 %").waitFor();
  await leave(page, /503/);
});

test("the paper's statements say that they stand on one run each", async () => {
  const sweep = { clearance_mm: [0, 0.25, 0.5], crank_velocity_rad_s: [10, 15], coupler: ["rigid", "flexible"] };
  const single = await runSweep({ parameters: short, sweep });
  const page = await visit(`#/sweeps/${single.id}`);
  await page.getByText(/The paper's statements: .*; one run each$/).waitFor();
  await page.getByRole("link", { name: "The paper's statements" }).click();
  await page.getByText("One run each: replicates would show which ratios scatter.").waitFor();
  await leave(page);
});
