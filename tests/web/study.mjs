// SPDX-License-Identifier: Apache-2.0
// The paper's study from the form to the linkage in motion, in what people see.   node study.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { ask, endVisits, expectAccessible, expectNoSideways, leave, picture, resultsOf, runSweep, textOf, url, visit } from "./visitor.mjs";

after(endVisits);
const minutes = 60000;
let study = null;
let rows = null;

/** The job of the study with these parameters. */
const jobWith = (clearance, velocity, coupler) =>
  rows.find((row) => row.clearance_mm === clearance && row.crank_velocity_rad_s === velocity && row.coupler === coupler).job_id;

/** Draws with the mouse from one part of an element's width to another, half way down. */
async function drawAcross(page, locator, from, to) {
  await locator.scrollIntoViewIfNeeded();
  const box = await locator.boundingBox();
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + from * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.x + to * box.width, y, { steps: 8 });
  await page.mouse.up();
}

test("the paper's sweep is submitted in the form and watched until it has finished", { timeout: 10 * minutes }, async () => {
  const page = await visit("#/new");
  await page.getByRole("link", { name: "Load the paper's sweep" }).click();
  await page.getByText("40 jobs").waitFor();
  const curl = await page.locator("aside pre").last().textContent();
  assert.match(curl, /^curl -d '\{"name":"paper","sweep":\{/);
  await picture(page, "form");
  await page.getByRole("button", { name: "Submit" }).click();
  await page.getByRole("heading", { name: "paper" }).waitFor();
  const list = await visit("");
  await list.getByRole("row").filter({ hasText: "paper" }).getByText("running", { exact: true }).waitFor();
  await list.getByText(/[1-9] succeeded/).waitFor({ timeout: 2 * minutes });
  await picture(list, "list_running");
  await page.locator(".chart canvas").nth(2).waitFor();
  await page.getByText(/^running: .*[1-9]\d* succeeded/).waitFor({ timeout: 2 * minutes });
  await picture(page, "sweep_running", { fullPage: true });
  await page.getByText("succeeded: 40 succeeded of 40 jobs").waitFor({ timeout: 8 * minutes });
  study = await ask(`/v1/sweeps/${page.url().match(/swp_\w+/)[0]}`);
  rows = await resultsOf(study);
  assert.equal(rows.length, 40);
  await list.getByRole("row").filter({ hasText: "paper" }).getByText("40 succeeded").waitFor();
  await picture(list, "list");
  await leave(list);
  await leave(page);
});

test("the sweep's parts are linked, and its table and charts are taken along", async () => {
  const page = await visit(`#/sweeps/${study.id}`);
  const heat = page.locator(".chart").first();
  await page.locator(".chart canvas").nth(2).waitFor();
  await picture(page, "sweep", { clip: { x: 0, y: 0, width: 1360, height: 1240 }, fullPage: true });
  const box = await heat.boundingBox();
  await page.mouse.click(box.x + 0.42 * box.width, box.y + 0.4 * box.height);
  await page.getByText("1 job selected").waitFor();
  assert.equal(await page.locator("tr.selected").count(), 1);
  await page.getByRole("button", { name: "Clear selection" }).click();
  await page.getByText("1 job selected").waitFor({ state: "hidden" });
  await page.getByRole("button", { name: /^Peak slider acceleration \[/ }).click();
  await page.getByRole("button", { name: /^Peak slider acceleration \[.*▲/ }).click();
  const largest = Math.max(...rows.map((row) => row.peak_slider_acceleration_m_s2));
  const top = rows.find((row) => row.peak_slider_acceleration_m_s2 === largest);
  assert.equal(await page.locator("tbody tr").first().getByRole("link").getAttribute("href"), `#/jobs/${top.job_id}`);
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption("peak_contact_force_n");
  await page.getByRole("button", { name: "Peak contact force [N]" }).waitFor();
  assert.match(page.url(), /metric=peak_contact_force_n/);

  const csv = await textOf(page, () => page.getByRole("link", { name: "CSV" }).click());
  assert.equal(csv.text, await (await fetch(`${url}/v1/sweeps/${study.id}/results?format=csv`)).text());
  const svg = await textOf(page, () => page.getByRole("button", { name: "SVG" }).first().click());
  assert.equal(svg.name, "paper heat map.svg");
  assert.match(svg.text, /^<svg [\s\S]*Clearance \[mm\]/);
  const png = await textOf(page, () => page.getByRole("button", { name: "PNG" }).nth(1).click());
  assert.equal(png.name, "paper lines.png");
  assert.match(png.text, /PNG/);
  await expectAccessible(page);
  await leave(page);
});

test("brushing an axis of the parallel coordinates selects jobs everywhere", async () => {
  const page = await visit(`#/sweeps/${study.id}`);
  const parallel = page.locator(".chart").nth(2);
  await parallel.locator("canvas").waitFor();
  await parallel.scrollIntoViewIfNeeded();
  const box = await parallel.boundingBox();
  // The first axis is the clearance: its upper part holds the largest one, four velocities and two couplers with 15 rad/s five times: 16 jobs.
  const [x, top, height] = [box.x + 60, box.y + 50, box.height - 105];
  await page.mouse.move(x, top + 2);
  await page.mouse.down();
  await page.mouse.move(x, top + 0.3 * height, { steps: 10 });
  await page.mouse.up();
  await page.getByText("16 jobs selected").waitFor();
  assert.equal(await page.locator("tr.selected").count(), 16);
  await page.getByLabel("Selected only").check();
  const clearances = await page.locator("tbody tr td:nth-child(4)").allTextContents();
  assert.deepEqual(clearances, Array(16).fill("0.5"));
  await picture(page, "parallel_brushed", { fullPage: true });
  await leave(page);
});

test("another sweep stands beside it", async () => {
  const other = await runSweep({ name: "denser", sweep: { clearance_mm: [0, 0.1, 0.25, 0.4, 0.5] } }, 120);
  const page = await visit(`#/sweeps/${study.id}?x=clearance_mm&y=coupler`);
  await page.getByLabel("Compare with").selectOption(other.id);
  await page.waitForURL(new RegExp(`with=${other.id}`));
  await page.locator(".chart canvas").nth(2).waitFor();
  await picture(page, "compared");
  const again = await visit(page.url().slice(page.url().indexOf("#")));
  await again.waitForFunction((id) => [...document.querySelectorAll("select")].some((select) => select.value === id), other.id);
  await leave(again);
  await leave(page);
});

test("the orbit is brushed in time, and every spike survives", async () => {
  const id = jobWith(0.25, 15, "rigid");
  const page = await visit(`#/jobs/${id}`);
  await page.locator("canvas.orbit[data-samples='5001']").waitFor();
  await page.locator("canvas.scene[data-instant]").waitFor();
  await page.getByRole("button", { name: "Overlay ideal linkage" }).click();
  await page.getByText("ideal linkage", { exact: true }).waitFor({ timeout: minutes });
  await page.getByLabel("Instant [s]").fill("3.618");
  await picture(page, "job", { clip: { x: 0, y: 0, width: 1360, height: 1400 }, fullPage: true });
  // The curve of the whole run has the peak that the metrics tell.
  const job = await ask(`/v1/jobs/${id}`);
  const drawn = await ask(`/v1/jobs/${id}/trajectory?channels=t_s,slider_acceleration_min_m_s2,slider_acceleration_max_m_s2&points=1600`);
  const extremes = [...drawn.columns.slider_acceleration_min_m_s2, ...drawn.columns.slider_acceleration_max_m_s2].map(Math.abs);
  assert.ok(Math.abs(Math.max(...extremes) / job.metrics.peak_slider_acceleration_whole_run_m_s2 - 1) < 1e-3);

  await drawAcross(page, page.locator(".overview .u-over"), 0.5, 0.7);
  await page.locator("canvas.orbit:not([data-samples='5001'])").waitFor();
  const samples = Number(await page.locator("canvas.orbit").getAttribute("data-samples"));
  assert.ok(Math.abs(samples - 1000) < 30, `${samples} samples in a fifth of the run`);
  await page.waitForURL(/from=2\.\d+&to=3\.\d+/);
  await page.getByLabel("Colour by").selectOption("force");
  await page.getByText("the rest of the run is pale").waitFor();
  await picture(page, "orbit_brushed", { fullPage: true });
  await page.getByLabel("Add channel").selectOption("friction_force_n");
  await page.getByRole("heading", { name: "Friction force [N]" }).waitFor();
  await page.waitForURL(/channels=friction_force_n/);
  // The address is enough to see the same again.
  const again = await visit(page.url().slice(page.url().indexOf("#")));
  await again.getByRole("heading", { name: "Friction force [N]" }).waitFor();
  assert.equal(Number(await again.locator("canvas.orbit[data-samples]").getAttribute("data-samples")), samples);
  await leave(again);
  await expectAccessible(page);
  await leave(page);
});

// A browser writes 4.90566 where it was given 4.905660, and Playwright then takes it for refused.
const pointAt = (page, instant) => page.getByLabel("Instant [s]").fill(String(Number(instant.toFixed(6))));

test("the linkage is scrubbed, played, and looked at closely", async () => {
  const id = jobWith(0.5, 15, "flexible");
  const { peak_slider_acceleration_time_s: peak } = (await ask(`/v1/jobs/${id}`)).metrics;
  const page = await visit(`#/jobs/${id}`);
  const scene = page.locator("canvas.scene");
  await page.locator("canvas.scene[data-instant='0']").waitFor();
  const still = await scene.screenshot();
  await page.getByLabel("Instant [s]").fill("2.4");
  await page.locator("canvas.scene[data-instant='2.4']").waitFor();
  assert.notDeepEqual(await scene.screenshot(), still);
  await picture(page, "scrubbed");
  // At the real speed the stretch around the peak would be over in 0.04 s; through its impact it is played slowly.
  await page.getByRole("button", { name: "Peak", exact: true }).click();
  await pointAt(page, peak - 0.01);
  await page.getByLabel("Speed").selectOption("1");
  const pace = await page.getByRole("button", { name: "Play" }).evaluate(async (play) => {
    const instant = () => Number(document.querySelector("input[aria-label='Instant [s]']").value);
    const [began, from] = [performance.now(), instant()];
    play.click();
    await new Promise((resolve) => { setTimeout(resolve, 300); });
    play.click();
    return (1000 * (instant() - from)) / (performance.now() - began);
  });
  assert.ok(pace > 0 && pace < 0.05, `${pace} s of the run in a second of the clock`);
  await page.getByRole("button", { name: "Whole run" }).click();
  await page.getByRole("button", { name: "Peak", exact: true }).click();
  await pointAt(page, peak - 0.0199);
  await page.getByRole("combobox", { name: /^View/ }).selectOption("joint");
  await page.getByLabel("Speed").selectOption("0.01");
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction((until) => Number(document.querySelector("canvas.scene").dataset.instant) > until, peak - 0.019, { timeout: minutes });
  await page.getByRole("button", { name: "Pause" }).click();
  const paused = await scene.getAttribute("data-instant");
  assert.ok(Number(paused) > peak - 0.02 && Number(paused) <= peak + 0.02);
  await pointAt(page, peak);
  await picture(page, "joint");
  await page.getByLabel("Clearance scale").selectOption("100");
  await page.getByLabel("Deflection scale").selectOption("100");
  await page.getByRole("combobox", { name: /^View/ }).selectOption("all");
  await picture(page, "exaggerated");
  await leave(page);
});

test("jobs are laid over each other", async () => {
  const [first, second] = [jobWith(0.25, 15, "rigid"), jobWith(0.5, 15, "rigid")];
  const page = await visit(`#/jobs/${first}`);
  await page.getByLabel("Overlay job").selectOption(second);
  await page.waitForURL(new RegExp(`with=${second}`));
  await page.getByRole("columnheader", { name: "0.5 mm" }).waitFor();
  await page.locator(".uplot").nth(4).waitFor();
  await picture(page, "overlay");
  await leave(page);
});

test("it is read in the dark, on a phone, and with the keyboard", async () => {
  const id = jobWith(0.25, 15, "rigid");
  for (const [name, view] of [["list", ""], ["form", "#/new?template=paper"], ["sweep", `#/sweeps/${study.id}`], ["job", `#/jobs/${id}`]]) {
    const phone = await visit(view, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    await phone.getByRole("heading", { level: 1 }).waitFor();
    await phone.waitForLoadState("networkidle");
    await expectNoSideways(phone);
    await picture(phone, `phone_${name}`, { fullPage: true });
    await leave(phone);
    const dark = await visit(view, { colorScheme: "dark" });
    await dark.getByRole("heading", { level: 1 }).waitFor();
    await dark.waitForLoadState("networkidle");
    await expectAccessible(dark);
    await picture(dark, `dark_${name}`);
    await leave(dark);
  }
  const page = await visit(`#/jobs/${id}`);
  await page.getByRole("group", { name: /^Slider acceleration, over time/ }).focus();
  await page.keyboard.press("+");
  await page.waitForURL(/from=1\.25&to=3\.75&/);
  await page.keyboard.press("ArrowRight");
  await page.waitForURL(/from=1\.75&to=4\.25&/);
  await page.keyboard.press("0");
  await page.waitForURL((address) => !address.href.includes("from="));
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.getByLabel("Theme").selectOption("dark");
  await page.getByLabel("Palette").selectOption("cividis");
  assert.notEqual(await ground(), light);
  await expectAccessible(page);
  await picture(page, "dark_chosen");
  await leave(page);
});

test("the page lives without server-sent events", async () => {
  const page = await visit("#/new");
  await page.route("**/events", (route) => route.fulfill({ status: 503, body: "{}" }));
  const sweep = await ask("/v1/sweeps", { name: "polled", parameters: { duration_s: 4 }, sweep: { clearance_mm: [0.31, 0.32, 0.33] } });
  await page.goto(`${url}/#/sweeps/${sweep.id}`);
  await page.getByText("succeeded: 3 succeeded of 3 jobs").waitFor({ timeout: 2 * minutes });
  await leave(page, /503/);
});
