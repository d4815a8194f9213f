// SPDX-License-Identifier: Apache-2.0
// The page of a job: while it waits, when it has failed, when the service was away, and under fingers.   node job_page.mjs URL FOLDER
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";

import { ask, endVisits, expectAccessible, folder, leave, picture, resultsOf, runSweep, url, visit } from "./visitor.mjs";

after(endVisits);
const away = /ERR_FAILED/;
const minute = 60000;

/** A job that the service does not have, in the sweep of two jobs. */
const given = (state, more = {}) => ({ id: "job_given", sweep_id: "swp_given", state, error: null, attempts: 1, created_at: "2026-01-01T00:00:00Z", started_at: null, ended_at: null, run: null,
  parameters: { coupler: "rigid", clearance_mm: 0.25, crank_velocity_rad_s: 10, duration_s: 5 }, metrics: null, ...more });
const sweepOf = (counts) => ({ id: "swp_given", counts: { queued: 0, running: 0, succeeded: 0, failed: 0, cancelled: 0, total: 2, ...counts }, eta_s: 90 });

/** Answers as if there were such a job. @param told  {job, sweep}, which may change; without a job the service is away */
async function giveJob(page, told) {
  const answer = (key) => (route) => (told.job ? route.fulfill({ json: told[key] }) : route.abort());
  await page.route("**/v1/jobs/job_given", answer("job"));
  await page.route("**/v1/sweeps/swp_given", answer("sweep"));
}

/** A job with clearance that has been computed: its sweep's only one. */
async function computedJob(parameters = {}) {
  const [{ job_id: id }] = await resultsOf(await runSweep({ parameters: { duration_s: 0.4, run_up_s: 0.1, clearance_mm: 0.25, ...parameters } }));
  return ask(`/v1/jobs/${id}`);
}

test("a job that is waited for says how it stands, outlives a service that was away, and says why it failed", async () => {
  const page = await visit("#/wear");
  const told = { job: given("queued"), sweep: sweepOf({ queued: 2 }) };
  await giveJob(page, told);
  await page.goto(`${url}/#/jobs/job_given`);
  const row = (name) => page.getByRole("row").filter({ has: page.getByRole("rowheader", { name, exact: true }) });
  await row("State").getByText("queued").waitFor();
  await row("Sweep").getByText("0 of 2 jobs have ended, about 1 min 30 s left for all of them").waitFor();
  await page.getByRole("heading", { name: "Parameters" }).waitFor();
  await page.getByRole("button", { name: "Cancel" }).focus();
  await row("Submitted").getByRole("cell").evaluate((cell) => getSelection().selectAllChildren(cell));
  const selected = await page.evaluate(() => getSelection().toString());
  assert.match(selected, /2026/);
  told.job = given("running", { started_at: new Date(Date.now() - 5000).toISOString() });
  await row("State").getByText("running").waitFor();
  await page.getByText("Job job_given, running").waitFor();
  await row("Computing time").getByText(/^\d+(\.\d)? s$/).waitFor();
  await row("Computing time").getByText(/^1\d s$/).waitFor();
  // Only texts change meanwhile.
  assert.equal(await page.evaluate(() => getSelection().toString()), selected);
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Cancel");
  await expectAccessible(page);
  told.job = null;
  await page.getByText("The service does not answer. Trying again …").waitFor();
  await row("State").getByText("running").waitFor();
  Object.assign(told, { job: given("failed", { started_at: "2026-01-01T00:00:10Z", ended_at: "2026-01-01T00:00:40Z", error: { reason: "step_limit", detail: "the run needs more than 10 steps", t_s: 1.25 } }),
    sweep: sweepOf({ succeeded: 1, failed: 1 }) });
  await page.getByText("step_limit: the run needs more than 10 steps").waitFor();
  await page.getByText("The service does not answer.").waitFor({ state: "hidden" });
  await row("Simulated time").getByText("1.25 s of 5 s").waitFor();
  await row("Computing time").getByText("30 s").waitFor();
  await row("Sweep").getByText("2 of 2 jobs have ended").waitFor();
  assert.equal(await page.getByRole("button", { name: "Cancel" }).count(), 0);
  await expectAccessible(page);
  await picture(page, "failed_job");
  await leave(page, away);
});

test("a view that could not be shown is shown when the service is back", async () => {
  const page = await visit("#/wear");
  const told = { job: null, sweep: sweepOf({ failed: 2 }) };
  await giveJob(page, told);
  await page.goto(`${url}/#/jobs/job_given`);
  await page.getByText("The service does not answer. Trying again …").waitFor();
  told.job = given("cancelled");
  await page.getByRole("heading", { name: "Progress" }).waitFor();
  await leave(page, away);
});

test("a view whose module could not be loaded is shown when the service is back", async () => {
  const page = await visit("#/wear");
  const told = { job: null, sweep: sweepOf({ failed: 2 }) };
  await giveJob(page, told);
  for (const pattern of ["**/pages/job.js", "**/healthz"]) await page.route(pattern, (route) => (told.job ? route.continue() : route.abort()));
  await page.goto(`${url}/#/jobs/job_given`);
  await page.getByText("The service does not answer. Trying again …").waitFor();
  await page.waitForTimeout(3000);
  assert.ok(await page.getByText("The service does not answer. Trying again …").isVisible());
  told.job = given("cancelled");
  await page.getByRole("heading", { name: "Progress" }).waitFor();
  await leave(page, away);
});

test("a module that stays missing is asked for ever more seldom, and then no more", async () => {
  const page = await visit("#/wear");
  await giveJob(page, { job: given("cancelled"), sweep: sweepOf({ cancelled: 1 }) });
  let asked = 0;
  await page.route("**/pages/job.js", (route) => { asked += 1; return route.abort(); });
  await page.clock.install();
  await page.goto(`${url}/#/jobs/job_given`);
  // From page to page: on a busy machine one of them was once seen to be asked for twice.
  for (const seconds of [2, 5, 15, 45]) {
    await page.getByText("A part of this page could not be loaded, although the service answers. Trying again …").waitFor();
    const before = asked;
    const renewed = page.waitForEvent("load");
    await page.clock.fastForward(1000 * (seconds - 1));
    assert.equal(asked, before, `not within ${seconds - 1} s`);
    await page.clock.fastForward(1100);
    await renewed;
  }
  await page.getByText(/It has been tried several times/).waitFor();
  await page.getByText(/pages\/job\.js/).waitFor();
  const inAll = asked;
  assert.ok(inAll >= 5);
  await page.clock.fastForward(600_000);
  await page.waitForTimeout(500);
  assert.equal(asked, inAll);
  await expectAccessible(page);
  await picture(page, "missing_module");
  await page.unroute("**/pages/job.js");
  await page.getByRole("button", { name: "Try again" }).click();
  await page.getByRole("heading", { name: "Progress" }).waitFor();
  await leave(page, away);
});

test("plots outlive a service that was away", async () => {
  const { id } = await computedJob();
  const page = await visit(`#/jobs/${id}`);
  const plot = page.getByRole("group", { name: /^Contact force, over time/ });
  await plot.locator(".u-over").waitFor();
  await page.waitForLoadState("networkidle");
  const status = plot.getByRole("status");
  assert.deepEqual([await status.textContent(), await status.evaluate((element) => element.offsetHeight)], ["", 0]);
  let asked = 0;
  await page.route("**/trajectory?**", (route) => {
    if (route.request().url().includes("contact_force")) asked += 1;
    return route.abort();
  });
  await plot.focus();
  for (const key of ["+", "-", "+", "-", "+"]) {
    await page.keyboard.press(key);
    await page.waitForTimeout(400);
  }
  await plot.getByText("The service does not answer. Trying again …").waitFor();
  const before = asked;
  await page.waitForTimeout(2500);
  assert.ok(before >= 5 && asked - before <= 2, `${asked - before} requests in 2.5 s after ${before}`);
  assert.ok(await plot.locator(".u-over").isVisible());
  await page.unroute("**/trajectory?**");
  await plot.getByText("The service does not answer.").waitFor({ state: "hidden" });
  await leave(page, away);
});

test("the linkage is asked for in pauses while the service is away, and drawn when it is back", async () => {
  const { id } = await computedJob();
  const page = await visit("#/wear");
  const poses = /\/trajectory\?.*pose_/;
  let asked = 0;
  await page.route(poses, (route) => { asked += 1; return route.abort(); });
  await page.goto(`${url}/#/jobs/${id}`);
  await page.locator(".card[aria-label=Linkage]").getByText("The service does not answer. Trying again …").waitFor();
  const before = asked;
  await page.waitForTimeout(2500);
  assert.ok(asked - before <= 2, `${asked - before} requests in 2.5 s`);
  await page.unroute(poses);
  await page.locator("canvas.scene[data-instant='0']").waitFor();
  await leave(page, away);
});

test("a spectrum that is asked for while the service is away is drawn when it is back", async () => {
  const { id } = await computedJob();
  const page = await visit(`#/jobs/${id}`);
  await page.route("**/spectrum?**", (route) => route.abort());
  await page.getByText("Spectrum and Poincaré section").click();
  const card = page.locator("details", { has: page.getByRole("heading", { name: "Spectrum of the steady window" }) });
  await card.getByText("The service does not answer. Trying again …").waitFor();
  await page.unroute("**/spectrum?**");
  await card.locator(".chart").first().locator("canvas").first().waitFor();
  await card.getByText("The service does not answer.").waitFor({ state: "hidden" });
  await leave(page, away);
});

test("jobs that have no curves are left out of an overlay", async () => {
  const { id } = await computedJob();
  const page = await visit("#/wear");
  await giveJob(page, { job: given("failed"), sweep: sweepOf({ failed: 2 }) });
  await page.goto(`${url}/#/jobs/${id}?with=job_given,job_of_nobody`);
  await page.getByText("without …given, …obody: deleted, not succeeded or without trajectory").waitFor();
  await page.locator(".uplot").nth(4).waitFor();
  await leave(page, /404/);
});

test("a job that keeps its metrics alone shows them", async () => {
  const { id } = await computedJob({ keep: "metrics" });
  const page = await visit(`#/jobs/${id}`);
  await page.getByText("No plots: this job keeps its metrics alone.").waitFor();
  await page.getByRole("region", { name: "Metrics" }).waitFor();
  await page.getByText("Parameters at their defaults").waitFor();
  assert.equal(await page.getByRole("link", { name: "CSV", exact: true }).count(), 0);
  await expectAccessible(page);
  await leave(page);
});

test("jobs are told apart by the mass of a link, and parameters of links and drives are listed", async () => {
  const crank = { law: "velocity_table", times_s: [0, 2], velocities_rad_s: [0, 10] };
  const sweep = await runSweep({ parameters: { duration_s: 0.02, run_up_s: 0.01, crank_drive: crank }, sweep: { "links.1,3.mass_kg": [0.3, 0.4] } });
  const [first, second] = await resultsOf(sweep);
  const page = await visit(`#/jobs/${first.job_id}?with=${second.job_id}`);
  await page.getByRole("heading", { level: 1, name: "link (1,3) mass 0.3 kg" }).waitFor();
  await page.getByRole("columnheader", { name: "0.4 kg", exact: true }).waitFor();
  const rows = await page.locator(".card", { has: page.getByRole("heading", { name: "Parameters", exact: true }) }).locator("tr")
    .evaluateAll((all) => all.map(({ cells }) => [...cells].map(({ textContent }) => textContent)));
  const row = (name) => rows.find(([text]) => text === name)?.slice(1);
  assert.deepEqual(row("Link (1,3) mass"), ["0.3", "kg"]);
  assert.equal(JSON.parse(row("Crank drive")[0]).law, crank.law);
  await picture(page, "link_mass");
  await leave(page);
});

test("plots tell the peaks that lie between their samples, and are saved with their names", async () => {
  const { id, metrics } = await computedJob();
  const page = await visit(`#/jobs/${id}`);
  const peak = (key) => String(Number(metrics[key].toPrecision(5)));
  const at = (key) => `at ${Number(metrics[key].toPrecision(6))} s`;
  await page.getByText(`Peak magnitude: ${peak("peak_contact_force_n")} N ${at("peak_contact_force_time_s")}. Peaks include values between the samples, which the curve joins at 1000 Hz.`).waitFor();
  await page.getByText(`Peak magnitude: Crank torque ${peak("peak_crank_torque_n_m")} N m ${at("peak_crank_torque_time_s")}; Rod force ${peak("peak_rod_force_n")} N ${at("peak_rod_force_time_s")}.`).waitFor();
  await page.getByText(`${at("peak_slider_acceleration_time_s")} from run_up_s on, ${peak("peak_slider_acceleration_whole_run_m_s2")} m/s² ${at("peak_slider_acceleration_whole_run_time_s")} in the whole run.`).waitFor();
  const card = page.locator(".card", { has: page.getByRole("heading", { name: "Drive torque and force" }) });
  const canvas = card.locator(".uplot canvas");
  const saved = async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), card.getByRole("button", { name: "PNG" }).click()]);
    const png = readFileSync(await download.path());
    writeFileSync(join(folder, "plot.png"), png);
    return png.readUInt32BE(20) - await canvas.evaluate(({ height }) => height);
  };
  await canvas.waitFor();
  assert.equal(await saved(), 28, "a line for the names");
  await page.setViewportSize({ width: 340, height: 800 });
  await page.waitForFunction((element) => element.width < 340, await canvas.elementHandle());
  assert.equal(await saved(), 56, "two lines where they are too long for one");
  await leave(page);
});

test("an orbit is saved with what it shows", async () => {
  const { id } = await computedJob();
  const page = await visit(`#/jobs/${id}`);
  const canvas = page.locator("canvas.orbit[data-samples]");
  await canvas.waitFor();
  await page.evaluate(() => {
    window.written = [];
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...place) { window.written.push(text); return fillText.call(this, text, ...place); };
  });
  const card = page.locator(".card", { has: page.getByRole("heading", { name: "Journal orbit" }) });
  const [download] = await Promise.all([page.waitForEvent("download"), card.getByRole("button", { name: "PNG" }).click()]);
  const png = readFileSync(await download.path());
  writeFileSync(join(folder, "orbit.png"), png);
  assert.ok(png.readUInt32BE(20) - await canvas.evaluate(({ height }) => height) >= 28, "lines above the orbit");
  const caption = ["Journal orbit", "Journal x [mm] across, Journal y [mm] up", "colour: time, 0 s to 0.4 s", "clearance 0.25 mm", id];
  const written = await page.evaluate(() => window.written);
  assert.deepEqual(written.filter((text) => caption.includes(text)), caption);  // other plots are still being drawn
  await leave(page);
});

test("a described linkage shows the clearance of every kind of joint, and its loads", async () => {
  const inertia = { inertia_kg_m2: [1e-3, 1e-3, 1e-3] };
  const linkage = { bodies: { block: { mass_kg: 1, ...inertia }, arm: { mass_kg: 0.5, centre_of_mass_m: [0.1, 0, 0], ...inertia }, tail: { mass_kg: 0.2, centre_of_mass_m: [0.05, 0, 0], ...inertia } },
    joints: { slide: { kind: "prismatic", from: "ground", to: "block", axis: "x", clearance: { block_width_mm: 40, block_height_mm: 30, clearance_mm: 0.1, clearance_height_mm: 0.2 } },
      ball: { kind: "spherical", from: "block", to: "arm", clearance: { bearing_radius_mm: 10 } },
      hook: { kind: "universal", from: "arm", to: "tail", at_m: [0.2, 0, 0], cross: { mass_kg: 0.05, ...inertia }, clearance: {} } },
    loads: { push: { body: "arm", at_m: [0.1, 0, 0], direction: [0, 0, 1], force_n: 2 }, twist: { body: "block", direction: [1, 0, 0], follows_body: true, torque_n_m: 0.1 } } };
  const { id } = await computedJob({ linkage, duration_s: 0.02, run_up_s: 0, clearance_mm: 0.3 });
  const page = await visit(`#/jobs/${id}`);
  for (const [joint, caption] of [["slide", "Rectangle: clearance 0.1 mm by 0.2 mm."], ["ball", "Circle: clearance 0.3 mm."], ["hook first", "Circle: clearance 0.3 mm."], ["hook second", "Circle: clearance 0.3 mm."]]) {
    const card = page.locator(".card", { has: page.getByRole("heading", { name: `Journal orbit of ${joint}`, exact: true }) });
    await card.getByText(caption).waitFor();
  }
  await page.locator("canvas.scene[data-instant='0']").waitFor();
  const names = await page.locator(".card[aria-label=Linkage] .legend span:not(.swatch)").allTextContents();
  assert.deepEqual(names.slice(0, 5).map((name) => name.trim()), ["arm", "block", "hook cross", "tail", "loads"]);
  await picture(page, "described_clearance", { fullPage: true });
  await leave(page);
});

test("an answer to what was asked before covers no newer one", async () => {
  const { id } = await computedJob();
  const page = await visit(`#/jobs/${id}`);
  await page.locator("canvas.orbit[data-samples='401']").waitFor();
  /** Holds back what is asked with a word in its address, until it is let go; gives how often that was asked. */
  const holdBack = async (pattern, word) => {
    const held = [];
    await page.route(pattern, (route) => (route.request().url().includes(word) ? held.push(route) : route.continue()));
    return { asked: () => held.length, letGo: () => Promise.all(held.map((route) => route.continue().catch(() => {}))) };
  };
  // The journal's path: first half of the run, held back, then the first quarter.
  const half = await holdBack(/journal_x_mm.*&to=/, "&to=0.2&");
  const strip = page.getByLabel("To [s]");
  await strip.fill("0.2");
  while (half.asked() === 0) await page.waitForTimeout(50);
  await strip.fill("0.1");
  await page.locator("canvas.orbit[data-samples='101']").waitFor();
  await half.letGo();
  await page.waitForTimeout(1000);
  assert.equal(await page.locator("canvas.orbit").getAttribute("data-samples"), "101");
  // The spectrum of a channel, held back, then another one's.
  await page.getByText("Spectrum and Poincaré section").click();
  await page.locator("details .chart canvas").nth(1).waitFor();
  const force = await holdBack("**/spectrum?**", "channel=contact_force_n");
  const channel = page.getByRole("combobox", { name: /^Channel/ });
  await channel.selectOption("contact_force_n");
  while (force.asked() === 0) await page.waitForTimeout(50);
  await channel.selectOption("journal_x_mm");
  const titled = () => page.locator("details .chart").first().evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    return getInstanceByDom(element).getModel().queryComponents({ mainType: "yAxis" })[0].option.name;
  });
  while (await titled() !== "Amplitude: Journal x [mm]") await page.waitForTimeout(50);
  await force.letGo();
  await page.waitForTimeout(1000);
  assert.equal(await titled(), "Amplitude: Journal x [mm]");
  const spectrum = page.locator("details .chart").first().locator("canvas");
  assert.ok(await spectrum.isVisible());
  // A spectrum that is not to be had leaves the chart where it is, for the next one.
  await page.route("**/spectrum?**window=flat_top**", (route) => route.fulfill({ status: 422, contentType: "application/problem+json", body: '{"detail": "not this window"}' }));
  await page.getByLabel("Window").selectOption("flat_top");
  await page.getByText("not this window").waitFor();
  await page.getByLabel("Window").selectOption("hann");
  await page.getByText("not this window").waitFor({ state: "hidden" });
  assert.ok(await spectrum.isVisible());
  // The list of all sweeps, held back, then the one of those that have failed.
  await page.goto(`${url}/#/`);
  await page.getByRole("row").nth(1).waitFor();
  const all = await holdBack(/\/v1\/sweeps\?/, "?limit=25");
  while (all.asked() === 0) await page.waitForTimeout(50);
  await page.unroute(/\/v1\/sweeps\?/);
  await page.route(/\/v1\/sweeps\?.*state=failed/, (route) => route.fulfill({ json: { items: [], next_cursor: "" } }));
  await page.getByRole("combobox", { name: /^State/ }).selectOption("failed");
  await page.getByText("No matching sweeps.").waitFor();
  await all.letGo();
  await page.waitForTimeout(1000);
  assert.ok(await page.getByText("No matching sweeps.").isVisible());
  await leave(page, /422/);
});

test("a run without a steady part has a peak all the same", async () => {
  const { id, metrics } = await computedJob({ run_up_s: 0.4 });
  assert.equal(metrics.peak_slider_acceleration_m_s2, null);
  const page = await visit(`#/jobs/${id}`);
  const whole = String(Number(metrics.peak_slider_acceleration_whole_run_m_s2.toPrecision(5)));
  const at = String(Number(metrics.peak_slider_acceleration_whole_run_time_s.toPrecision(6)));
  await page.getByText(`Peak magnitude: ${whole} m/s² at ${at} s in the whole run. Peaks include`).waitFor();
  await leave(page);
});

// The built-in linkage as it was before its yoke turned about the guide.
const across = { yoke_axis: "across", gravity_direction: "-y", guide_offset_z_m: 0.2, rod_start_m: 0.2, rod_law: "cycloidal", rod_stroke_mm: 50 };
const turning = { duration_s: 1, run_up_s: 0.3 };  // more than one turn of the crank

test("up in the picture is against gravity", async () => {
  const rsup = await (await fetch(`${url}/linkages/rsup.json`)).json();
  for (const [name, parameters, up] of [["default", {}, "0 0 1"], ["across", across, "0 1 0"], ["weightless", { gravity_m_s2: 0 }, "0 1 0"], ["gravity along x", { gravity_direction: "x" }, "-1 0 0"],
    ["negative gravity", { gravity_m_s2: -9.81 }, "0 0 -1"], ["described", { ...rsup, duration_s: 0.1, clearance_mm: undefined }, "0 0 1"]]) {
    const { id } = await computedJob(parameters);
    const page = await visit(`#/jobs/${id}`);
    const scene = page.locator("canvas.scene[data-up]");
    await scene.waitFor();
    assert.equal(await scene.getAttribute("data-up"), up, name);
    await picture(page, `scene_${name.replaceAll(" ", "_")}`);
    await leave(page);
  }
});

test("a job of an older program is drawn as it was computed", async () => {
  const { id, parameters } = await computedJob(across);
  const added = ["yoke_axis", "gravity_direction", "crank_start_rad", "guide_angle_deg", "rod_law", "rod_start_m"];
  assert.deepEqual(added.filter((key) => !(key in parameters)), []);
  const page = await visit("#/wear");
  await page.route(`**/v1/jobs/${id}`, async (route) => {
    const job = await (await route.fetch()).json();
    await route.fulfill({ json: { ...job, parameters: Object.fromEntries(Object.entries(job.parameters).filter(([key]) => !added.includes(key))) } });
  });
  await page.goto(`${url}/#/jobs/${id}`);
  const scene = page.locator("canvas.scene[data-up]");
  await scene.waitFor();
  assert.equal(await scene.getAttribute("data-up"), "0 1 0");
  await page.getByRole("combobox", { name: /^View/ }).selectOption("joint");
  await leave(page);
});

/** Measures of the 3-D view of a job: the distances of its moving places from the middle of the first look
    (1: the picture's edge), that of the slider from the guide's bar [m], and the angle by which the close-up
    looks past the bearing's axis [rad]. */
function seenOf(page, job, columns, aspect) {
  return page.evaluate(async ({ parameters, poses, ratio }) => {
    const [{ loadThree }, { Stage }, { Linkage }, { shownOf }] = await Promise.all(["three", "stage", "linkage", "scene_card"].map((name) => import(`/scene/${name}.js`)));
    const libraries = await loadThree();
    const { THREE } = libraries;
    const canvas = document.createElement("canvas");
    Object.assign(canvas.style, { display: "block", width: `${400 * ratio}px`, height: "400px" });
    document.body.append(canvas);
    const life = new AbortController();
    const links = ["1_1", "1_2", "1_3", "2_1", "2_2"];
    const stage = new Stage(libraries, canvas, shownOf(parameters), life.signal);
    const linkage = new Linkage(THREE, parameters, links);
    linkage.group.updateMatrixWorld(true);
    stage.camera.updateMatrixWorld(true);
    const bar = linkage.group.getObjectByName("guide");
    const [from, to] = [0, 1].map((x) => bar.localToWorld(new THREE.Vector3(x, 0, 0)));
    const frame = (link, k) => ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"].map((part) => poses[`pose_${link}_${part}`][k]);
    const placeOf = (link, k) => new THREE.Vector3(...frame(link, k).slice(0, 3));
    const seen = { edge: 0, offGuide: 0 };
    poses.t_s.forEach((_, k) => {
      for (const link of ["1_3", "2_1"]) {
        const { x, y } = placeOf(link, k).project(stage.camera);
        seen.edge = Math.max(seen.edge, Math.abs(x), Math.abs(y));
      }
      const slider = placeOf("2_1", k).sub(from);
      seen.offGuide = Math.max(seen.offGuide, slider.cross(to.clone().sub(from)).length());
    });
    const last = poses.t_s.length - 1;
    linkage.place(Object.fromEntries(links.map((link) => [link, frame(link, last)])), { clearance: 1, bend: 1 });
    stage.follow(linkage.joint, 0.1, linkage.jointAxis);
    const journal = new THREE.Vector3(0, 0, 1).applyQuaternion(new THREE.Quaternion(...frame("2_2", last).slice(3)));
    seen.past = Math.acos(Math.abs(stage.camera.position.clone().sub(stage.controls.target).normalize().dot(journal)));
    life.abort();
    canvas.remove();
    return seen;
  }, { parameters: job.parameters, poses: columns, ratio: aspect });
}

test("the first look shows the whole linkage, its guide where the slider moves, and the close-up looks along the bearing", async () => {
  const page = await visit("#/wear");
  for (const parameters of [{}, across, { guide_angle_deg: 20, guide_offset_y_m: 0.03 }, { gravity_direction: "-y" }, { gravity_direction: "-x" }]) {
    const job = await computedJob({ ...parameters, ...turning });
    const { columns } = await ask(`/v1/jobs/${job.id}/trajectory?points=4000`);
    for (const aspect of [0.8, 1.4]) {
      const { edge, offGuide, past } = await seenOf(page, job, columns, aspect);
      const told = `${JSON.stringify(parameters)}, aspect ${aspect}: edge ${edge}, off the guide ${offGuide}, past ${past}`;
      assert.ok(edge > 0.6 && edge < 1, told);
      assert.ok(offGuide < 1e-6, told);
      assert.ok(past < 0.5, told);  // atan(0.35 sqrt(2)) = 0.46: from a little aside and above
    }
  }
  await leave(page);
});

test("fingers move and zoom the plots", { timeout: 2 * minute }, async () => {
  const { id } = await computedJob();
  const page = await visit(`#/jobs/${id}?from=0.1&to=0.3`, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  const over = page.getByRole("group", { name: /^Contact force, over time/ }).locator(".u-over");
  await over.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await over.boundingBox();
  // The strip has no fingers of its own: there the browser scrolls and zooms the page.
  const touchAction = (area) => area.evaluate((element) => getComputedStyle(element).touchAction);
  assert.deepEqual([await touchAction(over), await touchAction(page.locator(".overview .u-over"))], ["pan-y", "auto"]);
  const session = await page.context().newCDPSession(page);
  const touch = (type, parts) => session.send("Input.dispatchTouchEvent", { type, touchPoints: parts.map((part, finger) => ({ id: finger, x: x + part * width, y: y + height / 2 })) });
  const shown = () => page.evaluate(() => ["from", "to"].map((key) => Number(new URLSearchParams(location.hash.split("?")[1]).get(key))));
  const near = (found, wanted) => found.every((value, k) => Math.abs(value - wanted[k]) < 0.005);
  const expectShown = async (wanted) => {
    for (const end = Date.now() + 5000; !near(await shown(), wanted) && Date.now() < end;) await page.waitForTimeout(50);
    assert.ok(near(await shown(), wanted), `${await shown()} instead of ${wanted}`);
  };
  await touch("touchStart", [0.75]);
  await touch("touchMove", [0.5]);
  await touch("touchMove", [0.25]);
  await touch("touchEnd", []);
  await expectShown([0.2, 0.4]);
  await touch("touchStart", [0.25, 0.5]);
  await touch("touchMove", [0.25, 0.6]);
  await touch("touchMove", [0.25, 0.75]);
  await touch("touchEnd", []);
  await expectShown([0.225, 0.325]);
  // Fingers that meet or cross leave the plot alone, and are followed again once they are apart.
  await touch("touchStart", [0.25, 0.75]);
  for (const part of [0.5, 0.26, 0.25, 0.2, 0]) await touch("touchMove", [0.25, part]);
  await page.waitForTimeout(800);
  await expectShown([0.2, 0.4]);
  await touch("touchMove", [0.25, 0.75]);
  await expectShown([0.225, 0.325]);
  await touch("touchEnd", []);
  await leave(page);
});

test("plots of loads reach up to their peaks, which samples miss", async () => {
  const { id, metrics } = await computedJob({ clearance_mm: 0.5 });
  const { columns } = await ask(`/v1/jobs/${id}/trajectory?channels=t_s,contact_force_n,contact_force_max_n`);
  const peak = metrics.peak_contact_force_n;
  assert.ok(Math.max(...columns.contact_force_n) < peak, "else the test shows nothing");
  assert.ok(Math.abs(Math.max(...columns.contact_force_max_n) / peak - 1) < 1e-6);
  const page = await visit(`#/jobs/${id}`);
  const card = page.locator("section.card")
    .filter({ has: page.getByRole("heading", { name: "Contact force [N]", exact: true }) });
  await card.locator(".uplot").waitFor();
  // Ends of bands have no entry in the legend, whose entries share a line.
  const entries = await card.locator(".u-legend tr").evaluateAll((rows) => rows
    .filter((each) => each.getClientRects().length > 0).map((each) => each.getBoundingClientRect().top));
  assert.equal(entries.length, 2);
  assert.equal(new Set(entries).size, 1);
  // Nobody chooses the ends as channels of their own.
  const offered = await page.getByLabel("Add channel").locator("option").evaluateAll((all) => all.map(({ value }) => value));
  assert.ok(offered.includes("contact_force_n") && !offered.some((name) => /_(min|max)_/.test(name)), offered.join());
  await card.scrollIntoViewIfNeeded();
  await picture(page, "peaks");
  await leave(page);
});

test("a stretch is computed finely, and opens where it was looked at", async () => {
  const { id, parameters } = await computedJob();
  const page = await visit(`#/jobs/${id}`);
  const button = page.getByRole("button", { name: /^Compute finely/ });
  await button.waitFor();
  await page.goto(`${url}/#/jobs/${id}?from=0.2&to=0.25`);
  await page.getByText("0.2 s to 0.25 s").waitFor();
  await page.getByRole("button", { name: "Compute finely, at 100 kHz" }).click();
  await page.getByText(/Finer run: job ….*, succeeded/).waitFor();
  await expectAccessible(page);
  await picture(page, "finer");
  await page.getByText("Finer run").getByRole("link").click();
  await page.waitForURL((to) => !to.hash.includes(id));
  await page.getByText("0.2 s to 0.25 s").waitFor();
  const finer = await ask(`/v1/jobs/${page.url().match(/job_\w+/)[0]}`);
  assert.deepEqual([finer.parameters.duration_s, finer.parameters.output_rate_hz], [0.25, 100000]);
  assert.deepEqual({ ...finer.parameters, duration_s: 0, output_rate_hz: 0 }, { ...parameters, duration_s: 0, output_rate_hz: 0 });
  assert.ok(await page.getByRole("button", { name: "Compute finely", exact: true }).isDisabled());
  await leave(page);
});

test("the force on the journal is an arrow, whose scale the legend tells", async () => {
  const { id, metrics, parameters } = await computedJob();
  const page = await visit(`#/jobs/${id}`);
  const canvas = page.locator("canvas.scene[data-force]");
  await canvas.waitFor();
  const scale = page.getByText(/^force on the journal: as long as the crank at [\d.]+ N$/);
  const told = async () => Number((await scale.textContent()).match(/at ([\d.]+) N/)[1]);
  const first = await told();
  assert.ok(Math.abs(first * 1.5 / metrics.peak_joint_reaction_n - 1) < 0.01, `${first} N`);
  await page.getByLabel("Force scale").selectOption("10");
  assert.ok(Math.abs(await told() * 10 / first - 1) < 0.01);
  // The arrow is the force at the instant.
  const columns = ["reaction_x_n", "reaction_y_n", "reaction_z_n"];
  const found = await ask(`/v1/jobs/${id}/trajectory?channels=t_s,${columns}`);
  const row = 250;
  const force = Math.hypot(...columns.map((name) => found.columns[name][row]));
  await page.goto(`${url}/#/jobs/${id}?t=${found.columns.t_s[row]}`);
  await page.waitForFunction((wanted) => Math.abs(JSON.parse(document.querySelector("canvas.scene")?.dataset.force ?? "{}").joint / wanted - 1) < 1e-3, force);
  assert.equal(parameters.clearance_mm, 0.25);
  await page.getByLabel("Force scale").selectOption("10");
  await picture(page, "force_arrow");
  await expectAccessible(page);
  await leave(page);
});

test("forces in the joints of a described linkage are arrows, too", async () => {
  const request = JSON.parse(readFileSync(new URL("../../web/linkages/slider_crank.json", import.meta.url)));
  const { id, metrics } = await computedJob({ ...request, duration_s: 0.2, run_up_s: 0 });
  const joints = ["crank_pin", "slider_pin"];
  const channels = joints.flatMap((joint) => ["x", "y", "z"].map((axis) => `${joint}_force_${axis}_n`));
  const { columns } = await ask(`/v1/jobs/${id}/trajectory?channels=t_s,${channels}`);
  const forceAt = (joint, row) => Math.hypot(...channels.filter((name) => name.startsWith(joint)).map((name) => columns[name][row]));
  const row = columns.t_s.findIndex((_, k) => k > 0 && forceAt("crank_pin", k) > 0 && forceAt("slider_pin", k) > 0);
  const page = await visit(`#/jobs/${id}?t=${columns.t_s[row]}`);
  await page.waitForFunction(([t, wanted]) => {
    const { instant, force } = document.querySelector("canvas.scene")?.dataset ?? {};
    return Number(instant) === t && Object.entries(wanted).every(([joint, size]) => Math.abs(JSON.parse(force)[joint] / size - 1) < 1e-3);
  }, [columns.t_s[row], Object.fromEntries(joints.map((joint) => [joint, forceAt(joint, row)]))]);
  // The largest force of all joints is one and a half times as long as the length that the legend tells.
  const scale = page.getByText(/^force on each journal: \d+ mm at [\d.]+ N$/);
  const told = Number((await scale.textContent()).match(/at ([\d.]+) N/)[1]);
  const largest = Math.max(...joints.map((joint) => metrics[`peak_${joint}_reaction_n`]));
  assert.ok(Math.abs(told * 1.5 / largest - 1) < 0.01, `${told} N, ${largest} N at most`);
  await page.getByLabel("Force scale").selectOption("10");
  await page.getByText("Wear of the bearing").click();
  const depth = page.getByText(/^Maximum depth: /);
  await depth.waitFor();
  const before = await depth.textContent();
  await page.getByRole("combobox", { name: /^Joint/ }).selectOption("slider_pin");
  await page.waitForFunction((text) => [...document.querySelectorAll("p[role=status]")]
    .some(({ textContent }) => textContent.startsWith("Maximum depth: ") && textContent !== text), before);
  await picture(page, "described_forces");
  await expectAccessible(page);
  await leave(page);
});
