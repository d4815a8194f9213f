// SPDX-License-Identifier: Apache-2.0
// Lists: low rows, their order, several deleted together, empty ones that say how to begin, views that load.   node lists.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { ask, endVisits, expectAccessible, expectNoSideways, leave, picture, runSweep, textOf, url, visit } from "./visitor.mjs";

after(endVisits);
const short = { duration_s: 0.02, run_up_s: 0.01 };

test("empty pages say how to begin, and their examples are ready to be sent", async () => {
  const page = await visit("#/searches");
  for (const [route, heading] of [["searches", "No searches yet."], ["wear", "No wear studies yet."], ["optimisations", "No optimisations yet."], ["fits", "No fits yet."]]) {
    await page.goto(`${url}/#/${route}`);
    await page.getByRole("heading", { name: heading }).waitFor();
    assert.equal(await page.getByRole("link", { name: "Begin with the example" }).getAttribute("href"), `#/${route}/new`);
    assert.equal(await page.locator("table:visible").count(), 0);
    await expectAccessible(page);
  }
  await page.goto(`${url}/#/searches`);
  await page.getByRole("link", { name: "Begin with the example" }).click();
  await page.getByText("3 limits to find").waitFor();
  assert.ok(await page.getByRole("button", { name: "Submit" }).isEnabled());
  await page.goto(`${url}/#/measurements`);
  await page.getByText("Begin with New measurement: choose a CSV, NPZ or JSON file").waitFor();
  await expectAccessible(page);
  await picture(page, "empty_measurements");
  await leave(page);
});

test("sweeps are found by the words of their badges, and stand on phones in cards of one height", async () => {
  const { id: kept } = await runSweep({ name: "plain", parameters: short, sweep: { clearance_mm: [0.1, 0.2] } });
  const { items: [sweep] } = await ask("/v1/sweeps");
  const others = [["wear_a", "of wear", []], ["opt_a", "of an optimum", ["bench"]]].map(([study, name, tags], k) =>
    ({ ...sweep, id: `swp_given_${k}`, name, tags, study_id: study, counts: { ...sweep.counts, succeeded: 0, failed: 2 }, state: "failed" }));
  const page = await visit("#/help", { viewport: { width: 390, height: 844 } });
  await page.route("**/v1/sweeps?**", (route) => route.fulfill({ json: { items: [sweep, ...others], next_cursor: "" } }));
  await page.goto(`${url}/#/`);
  const names = () => page.locator(".listing tbody .name a[title]:not(.badge)").allTextContents();
  const search = page.getByRole("searchbox");
  for (const [words, found] of [["wear", ["of wear"]], ["study", ["of wear"]], ["optimisation", ["of an optimum"]], ["bench", ["of an optimum"]]]) {
    await search.fill(words);
    await page.getByText("1 sweep, 0 under way").waitFor();
    assert.deepEqual(await names(), found, words);
  }
  await search.fill("");
  await page.getByText("3 sweeps, 0 under way").waitFor();
  await page.locator(".peaks a").first().waitFor();
  const heights = await page.locator(".listing tbody tr").evaluateAll((all) => all.map(({ offsetHeight }) => offsetHeight));
  assert.ok(Math.max(...heights) - Math.min(...heights) <= 1, `${heights}`);
  await picture(page, "lists_badges_390");
  await fetch(`${url}/v1/sweeps/${kept}`, { method: "DELETE" });
  await leave(page);
});

test("peaks are asked for of the sweeps in sight, and all that are found can be looked through", async () => {
  const counts = { queued: 0, running: 0, succeeded: 2, failed: 0, cancelled: 0, total: 2 };
  const all = Array.from({ length: 1001 }, (_, k) => ({ id: `swp_${k}`, name: `sweep ${k}`, state: "succeeded", counts, progress: 1, eta_s: null, axes: [], tags: [], notes: "",
    created_at: "2026-01-01T00:00:00Z", executor: "local", study_id: null }));
  const page = await visit("#/help");
  await page.route("**/v1/sweeps?**", (route) => {
    const items = all.slice(0, Number(new URL(route.request().url()).searchParams.get("limit")));
    return route.fulfill({ json: { items, next_cursor: items.length < all.length ? "more" : "" } });
  });
  const asked = new Set();
  await page.route("**/results?**", (route) => {
    asked.add(route.request().url().match(/swp_\d+/)[0]);
    return route.fulfill({ json: [{ job_id: "job_given", peak_slider_acceleration_m_s2: 3 }] });
  });
  await page.goto(`${url}/#/?sort=name`);
  const rows = page.locator(".listing tbody tr");
  await rows.nth(999).waitFor();
  await rows.first().locator(".peaks a").first().waitFor();
  await page.waitForTimeout(1000);
  assert.ok(asked.size < 100, `peaks of ${asked.size} sweeps`);
  await page.getByRole("button", { name: "Show more" }).click();
  await rows.nth(1000).waitFor();
  await rows.nth(1000).scrollIntoViewIfNeeded();
  await rows.nth(1000).locator(".peaks a").first().waitFor();
  await leave(page);
});

test("on a phone the header has two lines, and the link of the page is in sight", async () => {
  const page = await visit("#/help", { viewport: { width: 390, height: 844 } });
  await page.getByRole("heading", { name: "Help", level: 1 }).waitFor();
  const { height } = await page.locator("header").boundingBox();
  assert.ok(height < 90, `${height} pixels`);
  const link = await page.getByRole("link", { name: "Help" }).boundingBox();
  assert.ok(link.x >= 0 && link.x + link.width <= 390, `from ${link.x}`);
  assert.equal(await page.getByRole("combobox", { name: "Theme" }).count(), 1);
  await expectNoSideways(page);
  await expectAccessible(page);
  await leave(page);
});

test("sweeps have low rows, are sorted, and several are deleted together", async () => {
  for (const [k, name] of ["beta", "gamma", "alpha"].entries()) {
    await runSweep({ name, parameters: short, sweep: { clearance_mm: Array.from({ length: k + 1 }, (_, i) => 0.1 + i / 100) } });
  }
  const long = await ask("/v1/sweeps", { name: "delta", parameters: { duration_s: 2000, run_up_s: 0.1, output_rate_hz: 10 } });
  const page = await visit("");
  const names = () => page.locator(".listing tbody .name a[title]").allTextContents();
  await page.getByRole("link", { name: "alpha", exact: true }).waitFor();
  assert.deepEqual(await names(), ["delta", "alpha", "gamma", "beta"]);
  const heights = await page.locator(".listing tbody tr").evaluateAll((rows) => rows.map(({ offsetHeight }) => offsetHeight));
  assert.ok(heights.length === 4 && heights.every((height) => Math.abs(height - 40) <= 1), `${heights}`);
  await page.getByRole("button", { name: "Name", exact: true }).click();
  await page.waitForURL(/sort=name/);
  assert.deepEqual(await names(), ["alpha", "beta", "delta", "gamma"]);
  assert.equal(await page.getByRole("columnheader", { name: /^Name/ }).getAttribute("aria-sort"), "ascending");
  await page.getByRole("combobox", { name: "Sort by" }).selectOption("-jobs");
  assert.deepEqual((await names()).slice(0, 2), ["alpha", "gamma"]);
  await expectAccessible(page);
  for (const width of [390, 1280, 1920]) {
    await page.setViewportSize({ width, height: 900 });
    await expectNoSideways(page);
    await picture(page, `lists_${width}`);
  }
  await page.setViewportSize({ width: 1360, height: 900 });
  for (const name of ["alpha", "beta", "delta"]) await page.getByRole("checkbox", { name: `Select ${name}` }).check();
  await page.getByText("3 sweeps selected").waitFor();
  await page.getByText("1 sweep cannot be deleted: under way, or part of a study.").waitFor();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Delete selected" }).click();
  await page.getByText("Delete 2 sweeps: “alpha”, “beta”?").waitFor();
  await picture(page, "lists_delete");
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByRole("link", { name: "alpha", exact: true }).waitFor({ state: "detached" });
  assert.deepEqual((await ask("/v1/sweeps")).items.map(({ name }) => name), ["delta", "gamma"]);
  await page.getByText("1 sweep selected").waitFor();
  await page.getByRole("checkbox", { name: "Select all sweeps" }).check();
  await page.getByText("2 sweeps selected").waitFor();
  await ask(`/v1/sweeps/${long.id}/cancel`, {});
  await page.getByText("cannot be deleted").waitFor({ state: "hidden" });
  await page.getByRole("button", { name: "Delete selected" }).click();
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByRole("heading", { name: "No sweeps yet" }).waitFor();
  await leave(page);
});

test("studies are sorted and deleted together", async () => {
  const over = { clearance_mm: { from: 0.1, to: 0.2, first: 2, tolerance: 0.1 } };
  for (const name of ["second", "first"]) await ask("/v1/searches", { name, parameters: short, over, metric: "max_penetration_um", bound: 1000 });
  const page = await visit("#/searches");
  await page.locator("tbody tr").filter({ hasText: "succeeded" }).nth(1).waitFor();
  const names = () => page.locator("tbody .name").allTextContents();
  assert.deepEqual(await names(), ["first", "second"]);
  await page.getByRole("cell", { name: "not exceeded", exact: true }).nth(1).waitFor();
  await page.getByRole("combobox", { name: "Sort by" }).selectOption("-name");
  assert.deepEqual(await names(), ["second", "first"]);
  await page.getByRole("checkbox", { name: "Select all searches" }).check();
  await page.getByText("2 searches selected").waitFor();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Delete selected" }).click();
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByRole("heading", { name: "No searches yet." }).waitFor();
  assert.deepEqual((await ask("/v1/searches")).items, []);
  await leave(page);
});

test("more studies than a page has are shown when they are asked for", async () => {
  const study = (k) => ({ id: `sea_${k}`, name: `search ${k}`, state: "running", created_at: "2026-01-01T00:00:00Z", parameter: "clearance_mm", metric: "max_penetration_um", bound: 4 });
  const all = Array.from({ length: 101 }, (_, k) => study(k));
  const page = await visit("#/help");
  await page.route(/\/v1\/searches\?/, (route) => {
    const items = all.slice(0, Number(new URL(route.request().url()).searchParams.get("limit")));
    return route.fulfill({ json: { items, next_cursor: items.length < all.length ? "more" : "" } });
  });
  await page.goto(`${url}/#/searches`);
  await page.getByText("The newest 100.", { exact: true }).waitFor();
  assert.equal(await page.locator("tbody tr").count(), 100);
  await page.getByRole("button", { name: "Show more" }).click();
  await page.getByRole("link", { name: "search 100", exact: true }).waitFor();
  await page.getByRole("button", { name: "Show more" }).waitFor({ state: "hidden" });
  await leave(page);
});

test("the CSV of a measurement is that of the run that is shown", async () => {
  const channel = "slider_acceleration_m_s2";
  const times = Array.from({ length: 20 }, (_, k) => k / 100);
  const runs = [1, 2].map((factor) => ({ time_s: times, values: { [channel]: times.map((time) => factor * time) } }));
  const body = JSON.stringify({ name: "twice", channels: [{ name: channel }], runs });
  const sent = await fetch(`${url}/v1/measurements`, { method: "POST", body, headers: { "Content-Type": "application/json" } });
  const { id } = await sent.json();
  const page = await visit(`#/measurements/${id}`);
  const csv = () => textOf(page, () => page.getByRole("link", { name: "CSV", exact: true }).click());
  const first = await csv();
  await page.getByRole("combobox", { name: "Run" }).selectOption("1");
  const second = await csv();
  const last = ({ text }) => Number(text.trim().split(/[\n,]/).at(-1));
  assert.deepEqual([last(first), last(second)], [0.19, 0.38]);
  await fetch(`${url}/v1/measurements/${id}`, { method: "DELETE" });
  await leave(page);
});

test("measurements are sorted and deleted together", async () => {
  const channel = "slider_acceleration_m_s2";
  for (const [name, samples] of [["long", 30], ["short", 20]]) {
    const times = Array.from({ length: samples }, (_, k) => k / 100);
    const body = JSON.stringify({ name, channels: [{ name: channel }], runs: [{ time_s: times, values: { [channel]: times } }] });
    const sent = await fetch(`${url}/v1/measurements`, { method: "POST", body, headers: { "Content-Type": "application/json" } });
    assert.ok(sent.ok, await sent.text());
  }
  const page = await visit("#/measurements");
  const names = () => page.locator("tbody .name").allTextContents();
  await page.getByRole("link", { name: "short", exact: true }).waitFor();
  assert.deepEqual(await names(), ["short", "long"]);
  await page.getByRole("button", { name: "Samples" }).click();
  await page.getByRole("button", { name: "Samples ▲" }).click();
  assert.deepEqual(await names(), ["long", "short"]);
  assert.match(page.url(), /sort=-samples/);
  await page.getByRole("checkbox", { name: "Select all measurements" }).check();
  await page.getByText("2 measurements selected").waitFor();
  await expectAccessible(page);
  await picture(page, "measurements");
  await page.getByRole("button", { name: "Delete selected" }).click();
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByRole("heading", { name: "No measurements yet." }).waitFor();
  await leave(page);
});

test("pages of one sweep or job without its id are the list", async () => {
  for (const kind of ["sweeps", "analyses", "jobs"]) {
    const page = await visit(`#/${kind}`);
    await page.getByRole("heading", { name: "Sweeps", level: 1 }).waitFor();
    await leave(page);
  }
});

test("a view says that it loads", async () => {
  const page = await visit("#/wear");
  await page.getByRole("heading", { name: "Wear" }).first().waitFor();
  let go = () => {};
  const held = new Promise((resolve) => { go = resolve; });
  await page.route("**/v1/parameters", async (route) => { await held; await route.continue(); });
  await page.evaluate(() => { location.hash = "#/new"; });
  await page.locator("#main").getByText("Loading …").waitFor();
  go();
  await page.getByRole("heading", { name: "New sweep" }).waitFor();
  assert.equal(await page.getByText("Loading …").count(), 0);
  await leave(page);
});
