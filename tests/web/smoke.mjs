// SPDX-License-Identifier: Apache-2.0
// The way through the dashboard with a small study: form, sweep, job, and back to the list.   node smoke.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { ask, endVisits, expectAccessible, expectNoSideways, leave, picture, resultsOf, runSweep, textOf, url, visit } from "./visitor.mjs";

after(endVisits);
const short = { duration_s: 0.4, run_up_s: 0.1 };

test("an empty service leads to the form", async () => {
  const page = await visit("");
  await page.getByRole("heading", { name: "No sweeps yet" }).waitFor();
  assert.equal(await page.getByRole("link", { name: "the REST interface is documented" }).getAttribute("href"), "/docs");
  await expectAccessible(page);
  await picture(page, "empty");
  await page.getByRole("link", { name: "Load the paper's sweep" }).click();
  await page.getByText("40 jobs").waitFor();
  await leave(page);
});

test("the form shows what is wrong where it is wrong, and submits what it shows", async () => {
  const page = await visit("#/new");
  const row = (path) => page.locator(`[data-path="${path}"]`);
  await page.getByLabel("Name", { exact: true }).fill("small");
  await row("duration_s").getByRole("textbox").fill("0.4");
  await row("run_up_s").getByRole("textbox").fill("0.1");
  await row("clearance_mm").getByRole("combobox").selectOption("list");
  await row("clearance_mm").getByRole("textbox").fill("-1, 0.25");
  await row("clearance_mm").getByText("-1 is not allowed: must be ≥ 0").waitFor();
  assert.ok(await page.getByRole("button", { name: "Submit" }).isDisabled());
  // More than the bearing's radius: only the service knows that.
  await row("clearance_mm").getByRole("textbox").fill("6, 0.25");
  await row("clearance_mm").getByText("must be less than bearing_radius_mm, which is 5 mm").waitFor();
  await page.getByRole("button", { name: "Submit" }).click();
  await page.getByRole("alert").getByText("/sweep/clearance_mm:").waitFor();
  await expectAccessible(page);
  await row("clearance_mm").getByRole("textbox").fill("0, 0.25");
  await page.getByText("2 jobs").waitFor();
  const shown = JSON.parse(await page.locator("aside pre").first().textContent());
  await page.getByRole("button", { name: "Submit" }).click();
  await page.waitForURL(/#\/sweeps\/swp_/);
  const sweep = await ask(`/v1/sweeps/${page.url().split("/").at(-1)}`);
  assert.deepEqual(sweep.request, shown);
  await page.getByText("2 succeeded of 2 jobs").waitFor();
  await leave(page, /422/);
});

test("a form is sent once, also where it is changed while it is under way", async () => {
  const page = await visit("#/new");
  await page.getByText("1 job", { exact: true }).waitFor();
  let sent = 0;
  let answer = null;
  await page.route("**/v1/sweeps", (route) => {
    if (route.request().method() !== "POST") return route.continue();
    ++sent;
    answer = () => route.fulfill({ status: 422, contentType: "application/problem+json", body: '{"title": "told later", "detail": "told later", "errors": []}' });
    return undefined;
  });
  const submit = page.getByRole("button", { name: "Submit" });
  await submit.click();
  assert.ok(await submit.isDisabled());
  await page.getByLabel("Name", { exact: true }).fill("changed meanwhile");
  assert.ok(await submit.isDisabled());
  await page.keyboard.press("Enter");
  await answer();
  await page.getByRole("alert").getByText("told later").waitFor();
  assert.equal(sent, 1);
  assert.ok(await submit.isEnabled());
  await leave(page, /422/);
});

test("a sweep whose answer was lost is stored once, though it is sent again", async () => {
  const page = await visit("#/new");
  await page.getByLabel("Name", { exact: true }).fill("lost");
  for (const [key, value] of Object.entries(short)) await page.locator(`[data-path="${key}"] input[type="text"]`).fill(String(value));
  await page.getByText("1 job", { exact: true }).waitFor();
  let sent = 0;
  await page.route("**/v1/sweeps", async (route) => {
    if (route.request().method() !== "POST") return route.continue();
    const response = await route.fetch();
    return ++sent === 1 ? route.abort() : route.fulfill({ response });
  });
  const submit = page.getByRole("button", { name: "Submit" });
  await submit.click();
  await page.getByRole("alert").getByText("The service does not answer.").waitFor();
  await submit.click();
  await page.waitForURL(/#\/sweeps\/swp_/);
  const { items } = await ask("/v1/sweeps?limit=100");
  assert.deepEqual([sent, items.filter(({ name }) => name === "lost").length], [2, 1]);
  await leave(page, /ERR_FAILED/);
});

test("a run that ends before its steady part says so", async () => {
  const sweep = await runSweep({ parameters: { duration_s: 0.3, run_up_s: 0.4 }, sweep: { clearance_mm: [0.1, 0.2] } });
  const page = await visit(`#/sweeps/${sweep.id}`);
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption("peak_slider_acceleration_m_s2");
  await page.getByText(/^2 computed jobs without a value of .*count from run_up_s on/).waitFor();
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption("steps");
  await page.getByText(/computed jobs without a value/).waitFor({ state: "hidden" });
  const [{ job_id: id }] = await resultsOf(sweep);
  await page.goto(`${url}/#/jobs/${id}`);
  await page.getByText("this run ends at 0.3 s, at or before run_up_s (0.4 s)").waitFor();
  await picture(page, "before_steady", { fullPage: true });
  await leave(page);
});

test("a request is used again whole", async () => {
  const request = { name: "whole", priority: 3, reuse: false, keep: "metrics", executor: "local", parameters: short, sweep: { coupler: ["rigid", "flexible"], youngs_modulus_pa: { from: 1e11, to: 2e11, count: 2, scale: "log" } },
    design: { type: "sobol", count: 3, over: { clearance_mm: { from: 0.1, to: 0.5 } } }, cases: [{ restitution: 0.8 }], replicates: { count: 2, perturbation: 1e-6, seed: 4 } };
  const sweep = await runSweep(request);
  assert.equal(sweep.counts.total, 24);
  const page = await visit(`#/new?from=${sweep.id}`);
  await page.getByText("24 jobs").waitFor();
  assert.deepEqual(JSON.parse(await page.locator("aside pre").first().textContent()), sweep.request);
  await page.getByLabel(/^Design of experiments/).fill('{"type": "sobol", "count": 0, "over": {"clearance_mm": {"from": 0.1, "to": 0.5}}}');
  await page.getByRole("button", { name: "Submit" }).click();
  await page.getByRole("alert").getByText("/design/count").waitFor();
  await page.goto(`${url}/#/sweeps/${sweep.id}`);
  await page.locator(".chart canvas").nth(2).waitFor();
  await picture(page, "designed", { fullPage: true });
  await leave(page, /422/);
});

test("a sweep is counted, and told what it costs and what is stored of it, before it is sent", async () => {
  await runSweep({ parameters: short });
  const page = await visit("#/new");
  const duration = page.locator('[data-path="duration_s"]').getByRole("textbox");
  const clearance = page.locator('[data-path="clearance_mm"]').getByRole("textbox");
  await page.getByText("1 job", { exact: true }).waitFor();
  await duration.fill(String(short.duration_s));
  await page.locator('[data-path="run_up_s"]').getByRole("textbox").fill(String(short.run_up_s));
  await page.getByText("All results are stored already: nothing is to be computed.").waitFor();
  await page.getByLabel("Clearance: kind of value", { exact: true }).selectOption("list");
  await page.getByText("Number of jobs unknown").waitFor();
  await clearance.fill("0.25; 0.3; 0.35");
  await page.getByText("3 jobs", { exact: true }).waitFor();
  await page.getByText(/^1 stored already, 2 to compute\. .* are free\. At most [\d,]+ at once\.$/).waitFor();
  // The reason why a submission would be refused is told at its field.
  await clearance.fill("0.25; 6");
  await page.locator('[data-path="clearance_mm"] .trouble').getByText(/\w/).waitFor();
  await page.getByRole("alert").getByText("/clearance_mm").waitFor();
  await clearance.fill("0.25; 0.3");
  await page.getByText("2 jobs", { exact: true }).waitFor();
  assert.equal(await page.getByRole("alert").textContent(), "");
  await leave(page, /422/);
});

test("the form counts the jobs that the service makes", async () => {
  const ends = { clearance_mm: { from: 0.1, to: 0.4 }, restitution: { from: 0.7, to: 0.9 } };
  const page = await visit("#/new");
  for (const [design, jobs] of [
    [{ type: "sobol", count: 4, over: ends }, 4],
    [{ type: "latin_hypercube", count: 5, over: ends }, 5],
    [{ type: "morris", trajectories: 2, over: ends }, 2 * (2 + 1)],
    [{ type: "saltelli", count: 4, over: ends }, 4 * (2 + 2)],
    [{ type: "zip", over: { clearance_mm: [0.1, 0.2], restitution: [0.7, 0.8] } }, 2],
    [{ type: "one_at_a_time", over: { clearance_mm: [0.1, 0.2], restitution: [0.75] } }, 1 + 2 + 1],
  ]) {
    await page.getByText("Replicates, cases, design and priority").click();
    await page.getByLabel(/^Design of experiments/).fill(JSON.stringify(design));
    await page.getByText(`${jobs} jobs`, { exact: true }).waitFor({ timeout: 5000 });
    assert.equal((await runSweep({ parameters: short, design })).counts.total, jobs, design.type);
    await page.getByText("Replicates, cases, design and priority").click();
  }
  await leave(page);
});

test("metrics and channels are defined where they are pointed at", async () => {
  const { id } = await runSweep({ parameters: short, sweep: { clearance_mm: [0.1, 0.2] } });
  const page = await visit(`#/sweeps/${id}`);
  const told = async (element, text) => {
    // While plots come in, what lies below them moves away from the mouse.
    for (const end = Date.now() + 60000; !(await page.getByRole("tooltip").getByText(text).isVisible()) && Date.now() < end;) {
      await page.mouse.move(0, 0);
      await element.hover();
      await page.waitForTimeout(700);
    }
    return page.getByRole("tooltip").textContent();
  };
  assert.equal(await told(page.getByRole("button", { name: /^Max penetration \[/ }), "penetration"),
    "max Δ: Largest radial penetration of the journal into the bore in the whole run; null without clearance [µm]");
  const metric = page.locator("label", { has: page.getByRole("combobox", { name: /^Metric/ }) });
  await told(metric, "steady window");
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption("rms_slider_acceleration_m_s2");
  await page.mouse.move(0, 0);
  await page.getByRole("tooltip").waitFor({ state: "hidden" });
  assert.match(await told(metric, "Root mean square"), /^Root mean square of the slider's acceleration .* \[m\/s²\]$/);
  const [{ job_id: job }] = await resultsOf(await ask(`/v1/sweeps/${id}`));
  await page.goto(`${url}/#/jobs/${job}`);
  assert.equal(await told(page.getByRole("heading", { name: "Contact force" }).locator(".term"), "normal forces"),
    "Σ f_n: Sum of the radial normal forces on the journal; null without clearance [N]");
  await picture(page, "definition");
  await leave(page);
});

test("definitions are reached with the keyboard, and Escape closes them", async () => {
  const { id } = await runSweep({ parameters: short, sweep: { clearance_mm: [0.1, 0.2] } });
  const page = await visit(`#/sweeps/${id}`);
  const tooltip = page.getByRole("tooltip");
  const metric = page.getByRole("combobox", { name: "Metric" });
  await metric.waitFor();
  // With the Tab key from the element before it.
  await page.evaluate(() => {
    const all = [...document.querySelectorAll("main a[href], main button, main summary, main select")];
    all[all.findIndex((each) => each.matches("[data-quantity] select")) - 1].focus();
  });
  for (let k = 0; k < 10 && !(await metric.evaluate((element) => element === document.activeElement)); k += 1) await page.keyboard.press("Tab");
  await tooltip.getByText("steady window").waitFor();
  const describedBy = () => metric.evaluate((element) => document.getElementById(element.getAttribute("aria-describedby"))?.textContent ?? "");
  assert.equal(await describedBy(), await tooltip.textContent());
  await expectAccessible(page);
  await metric.selectOption("impact_count");
  await tooltip.getByText("Number of onsets").waitFor();
  await page.keyboard.press("Escape");
  await tooltip.waitFor({ state: "hidden" });
  assert.equal(await describedBy(), "");
  const [{ job_id: job }] = await resultsOf(await ask(`/v1/sweeps/${id}`));
  await page.goto(`${url}/#/jobs/${job}`);
  const term = page.getByRole("region", { name: "Metrics" }).locator(".term").nth(1);
  await page.getByRole("region", { name: "Metrics" }).locator(".term").first().focus();
  await page.keyboard.press("Tab");
  assert.ok(await term.evaluate((element) => element === document.activeElement));
  await tooltip.waitFor();
  await page.keyboard.press("Tab");
  await page.keyboard.press("Escape");
  await tooltip.waitFor({ state: "hidden" });
  await leave(page);
});

test("definitions are reached with a finger", async () => {
  const { id } = await runSweep({ parameters: short, sweep: { clearance_mm: [0.1, 0.2] } });
  const [{ job_id: job }] = await resultsOf(await ask(`/v1/sweeps/${id}`));
  const page = await visit(`#/jobs/${job}`, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  const tooltip = page.getByRole("tooltip");
  await page.getByRole("heading", { name: "Contact force" }).locator(".term").tap();
  await tooltip.getByText("normal forces").waitFor();
  const { x, width } = await tooltip.boundingBox();
  assert.ok(x >= 0 && x + width <= 390, `from ${x}, ${width} wide`);
  await picture(page, "definition_390");
  await page.getByRole("heading", { level: 1 }).tap();
  await tooltip.waitFor({ state: "hidden" });
  // A heading of the table is sorted by the same tap, and made anew.
  await page.goto(`${url}/#/sweeps/${id}`);
  await page.getByRole("button", { name: /^Max penetration \[/ }).tap();
  await tooltip.getByText("penetration").waitFor();
  await expectNoSideways(page);
  await leave(page);
});

test("a sweep shows its metrics, and what is selected in its table is selected everywhere", async () => {
  const sweep = await runSweep({ name: "axes", parameters: short, sweep: { clearance_mm: [0.1, 0.2, 0.3], coupler: ["rigid", "flexible"] } });
  const page = await visit(`#/sweeps/${sweep.id}`);
  await page.locator(".chart canvas").nth(2).waitFor();
  await page.getByRole("checkbox", { name: /Select job_/ }).first().check();
  await page.getByText("1 job selected").waitFor();
  const [first] = await resultsOf(sweep);
  assert.match(page.url(), new RegExp(`jobs=${first.job_id}`));
  await expectAccessible(page);
  const csv = await textOf(page, () => page.getByRole("link", { name: "CSV", exact: true }).click());
  assert.equal(csv.name, `sweep-${sweep.id}.csv`);
  assert.equal(csv.text.trim().split("\n").length, 7);
  await page.getByRole("link", { name: "Open", exact: true }).click();
  await page.waitForURL(new RegExp(first.job_id));
  await leave(page);
});

test("a name is text wherever it is shown", async () => {
  const name = `<img src=x onerror="document.title='run'"></script><b>bold`;
  const sweep = await runSweep({ name, parameters: short, sweep: { clearance_mm: [0.15] } });
  for (const place of ["", `#/sweeps/${sweep.id}`]) {
    const page = await visit(place);
    await page.getByText(name).first().waitFor();
    assert.equal(await page.locator("img[src=x]").count(), 0);
    assert.notEqual(await page.title(), "run");
    await leave(page);
  }
});

test("a job shows its acceleration, its orbit and its linkage at one instant", async () => {
  const sweep = await runSweep({ parameters: { ...short, clearance_mm: 0.25 } });
  const [{ job_id: id }] = await resultsOf(sweep);
  const page = await visit(`#/jobs/${id}`);
  await page.locator("canvas.orbit[data-samples='401']").waitFor();
  await page.locator("canvas.scene[data-instant='0']").waitFor();
  await page.locator(".uplot").nth(4).waitFor();
  await page.getByLabel("Instant [s]").fill("0.2");
  await page.locator("canvas.scene[data-instant='0.2']").waitFor();
  await page.getByText("t = 0.2000 s").waitFor();
  await page.getByText("Spectrum and Poincaré section").click();
  await page.locator("details .chart canvas").nth(1).waitFor();
  await page.getByLabel("Window").selectOption("flat_top");
  await page.getByText("Wear of the bearing").click();
  await page.getByText(/^Maximum depth: /).waitFor();
  await page.getByLabel(/^Worn clearance/).fill("0.3");
  await page.keyboard.press("Tab");
  await page.getByText(/mm after .* h of this motion/).waitFor();
  await expectAccessible(page);
  await picture(page, "small_job", { fullPage: true });
  await leave(page);
});

test("another linkage is taken, swept over a number inside it, and seen in motion", async () => {
  const page = await visit("#/new");
  await page.getByRole("link", { name: /^Planar slider-crank/ }).click();
  await page.waitForURL(/linkage=slider_crank/);
  await page.locator('[data-path="duration_s"]').getByRole("textbox").fill("0.03");
  await page.getByLabel(/^Axes inside the linkage/).fill('{"linkage.joints.crank_pin.clearance.clearance_mm": [0.05, 0.1]}');
  await page.getByText("2 jobs").waitFor();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Submit" }).click();
  await page.waitForURL(/#\/sweeps\/swp_/);
  await page.getByText("2 succeeded of 2 jobs").waitFor();
  const sweep = { id: page.url().split("/").at(-1) };
  const rows = await resultsOf(sweep);
  assert.deepEqual(rows.map((row) => row["linkage.joints.crank_pin.clearance.clearance_mm"]), [0.05, 0.1]);
  assert.ok(rows.every((row) => row.peak_crank_pin_contact_force_n > 0 && row.peak_slider_pin_contact_force_n > 0));
  await page.goto(`${url}/#/jobs/${rows[0].job_id}`);
  await page.getByRole("heading", { name: "planar slider-crank with clearance at both ends of the rod, crank pin clearance 0.05 mm" }).waitFor();
  await page.locator("canvas.orbit[data-samples]").nth(1).waitFor();
  await page.locator("canvas.scene[data-instant='0']").waitFor();
  await page.locator(".uplot").nth(4).waitFor();
  await expectAccessible(page);
  await picture(page, "described", { fullPage: true });
  await page.getByText("Spectrum and Poincaré section").click();
  await page.getByRole("combobox", { name: /^Joint/ }).selectOption("slider_pin");
  assert.equal(await page.getByRole("combobox", { name: /^Angle of/ }).getByRole("option").count(), 2);
  await page.locator("details .chart canvas").nth(1).waitFor();
  await expectAccessible(page);
  await page.goto(`${url}/#/analyses/${sweep.id}`);
  await page.getByText(/No surrogate: it needs 6 points/).waitFor();
  await page.getByText("No revolution is complete after the run-up of these jobs.").waitFor();
  await page.goto(`${url}/#/new?linkage=bricard`);
  await page.getByText("1 job").waitFor();
  await leave(page);
});

test("a browser without WebGL shows the rest of a job", async () => {
  const sweep = await runSweep({ parameters: { ...short, clearance_mm: 0.25 } });
  const [{ job_id: id }] = await resultsOf(sweep);
  const page = await visit("");
  await page.addInitScript(() => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) { return kind.startsWith("webgl") ? null : getContext.call(this, kind, ...more); };
  });
  await page.goto(`${url}/?#/jobs/${id}`);
  await page.getByText("The linkage cannot be drawn").waitFor();
  await page.locator("canvas.orbit[data-samples='401']").waitFor();
  await leave(page, /WebGL/);
});

test("the list follows, searches, and deletes after asking", async () => {
  const page = await visit("");
  const row = page.getByRole("row").filter({ hasText: "axes" });
  await row.getByText("6 succeeded").waitFor();
  await expectAccessible(page);
  const later = await ask("/v1/sweeps", { name: "later", parameters: short, sweep: { clearance_mm: [0.15, 0.35] } });
  await page.getByRole("row").filter({ hasText: "later" }).getByText("100 %").waitFor();
  await page.getByLabel(/^Search \(name/).fill("later");
  await row.waitFor({ state: "detached" });
  await page.getByRole("button", { name: "Delete later" }).click();
  await page.getByRole("button", { name: "Keep it" }).click();
  assert.equal((await ask(`/v1/sweeps/${later.id}`)).state, "succeeded");
  await page.getByRole("button", { name: "Delete later" }).click();
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByText("No matching sweeps").waitFor();
  assert.equal((await fetch(`${url}/v1/sweeps/${later.id}`)).status, 404);
  await leave(page);
});

test("the list needs no more width than there is, and has each id in one line", async () => {
  const { id } = await runSweep({ parameters: short, sweep: { clearance_mm: [0.15] } });
  const page = await visit("");
  const link = page.locator(`a[title="${id}"]`);
  await link.waitFor();
  const listed = page.getByRole("region", { name: "Sweeps" });
  for (const width of [1400, 1200, 1000, 800, 390]) {
    await page.setViewportSize({ width, height: 844 });
    const [content, window_] = await listed.evaluate(({ scrollWidth, clientWidth }) => [scrollWidth, clientWidth]);
    assert.ok(content <= window_, `${content} pixels wide in ${window_}, in a window of ${width}`);
    await expectNoSideways(page);
    assert.equal(await link.evaluate((element) => element.getClientRects().length), 1, `lines of an id in a window of ${width}`);
    await picture(page, `list_${width}`);
  }
  await expectAccessible(page);
  await leave(page);
});

test("a sweep is cancelled and retried in the list", async () => {
  const page = await visit("");
  const long = await ask("/v1/sweeps", { name: "long", parameters: { duration_s: 2000, run_up_s: 0.1, output_rate_hz: 10 }, sweep: { clearance_mm: [0.11, 0.12, 0.13] } });
  const row = page.getByRole("row").filter({ hasText: "long" });
  await page.getByRole("button", { name: "Retry long" }).waitFor({ state: "hidden" });
  const again = page.getByRole("link", { name: "Duplicate long" });
  const before = await again.boundingBox();
  await page.getByRole("button", { name: "Cancel long" }).click();
  await row.getByText("3 cancelled").waitFor();
  assert.deepEqual(await again.boundingBox(), before, "no button moves");
  assert.equal((await ask(`/v1/sweeps/${long.id}`)).state, "cancelled");
  await page.getByRole("button", { name: "Retry long" }).click();
  await row.getByText(/[1-3] (queued|running)/).first().waitFor();
  assert.equal((await ask(`/v1/sweeps/${long.id}`)).counts.cancelled, 0);
  await page.getByRole("button", { name: "Cancel long" }).click();
  await row.getByText("3 cancelled").waitFor();
  await leave(page);
});

test("a duplicate keeps the parameters that have no field", async () => {
  const drive = { law: "velocity_table", times_s: [0, 0.01], velocities_rad_s: [0, 10] };
  const rod = { law: "harmonic", amplitude_m: 0.01, frequency_hz: 1 };
  const parameters = { duration_s: 0.02, run_up_s: 0.01, crank_drive: drive, rod_drive: rod };
  const sweep = await ask("/v1/sweeps", { name: "measured", parameters, sweep: { clearance_mm: [0.11] } });
  const page = await visit(`#/sweeps/${sweep.id}`);
  await page.getByRole("link", { name: "Duplicate" }).click();
  const written = page.getByLabel(/JSON object of crank_drive/);
  assert.deepEqual(JSON.parse(await written.inputValue()), { crank_drive: drive, rod_drive: rod });
  await picture(page, "measured_drive", { fullPage: true });
  await written.fill("{\"clearance_mm\": 1}");
  await page.getByText(/must be a JSON object of crank_drive, rod_drive/).waitFor();
  await written.fill(JSON.stringify({ crank_drive: drive, rod_drive: rod }));
  await page.getByRole("button", { name: "Submit" }).click();
  await page.waitForURL((address) => /#\/sweeps\/[^/?]+$/.test(address.hash) && !address.hash.includes(sweep.id));
  const again = await ask(`/v1/sweeps/${page.url().split("/").at(-1)}`);
  assert.notEqual(again.id, sweep.id);
  assert.deepEqual(again.request.parameters.crank_drive, drive);
  const job = (await resultsOf(again))[0].job_id;
  await page.goto(`${url}/#/jobs/${job}`);
  await page.getByText(/crank by velocity_table/).waitFor();
  await page.locator("canvas.scene[data-instant='0']").waitFor();
  await leave(page);
});

test("a sweep is followed once, however often its jobs are retried", async () => {
  const sweep = await ask("/v1/sweeps", { name: "again", parameters: { duration_s: 2000, run_up_s: 0.1, output_rate_hz: 10 }, sweep: { clearance_mm: [0.11, 0.12, 0.13] } });
  const page = await visit("#/new");
  let followed = 0;
  page.on("request", (request) => { followed += request.url().endsWith(`${sweep.id}/events`) ? 1 : 0; });
  await page.goto(`${url}/#/sweeps/${sweep.id}`);
  const last = (await resultsOf(sweep)).at(-1).job_id;
  for (let time = 0; time < 3; time += 1) {
    await ask(`/v1/jobs/${last}/cancel`, {});
    await page.getByRole("button", { name: "Retry" }).click();
    await page.getByRole("button", { name: "Retry" }).waitFor({ state: "detached" });
  }
  assert.equal(followed, 1);
  const again = page.getByRole("link", { name: "Duplicate" });
  const before = await again.boundingBox();
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.getByText("cancelled: 3 cancelled of 3 jobs").waitFor();
  assert.deepEqual(await again.boundingBox(), before, "no button moves");
  await page.getByRole("button", { name: "Retry" }).click();
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.getByText("cancelled: 3 cancelled of 3 jobs").waitFor();
  await leave(page);
});

test("a search is begun in its form, draws its limits and is deleted", async () => {
  const page = await visit("#/searches");
  await page.getByText("No searches yet").waitFor();
  await page.getByRole("link", { name: "New search" }).click();
  await page.getByText("3 limits to find").waitFor();
  await picture(page, "search_form", { fullPage: true });
  await expectAccessible(page);
  await page.getByRole("link", { name: "Empty form" }).click();
  await page.getByText("1 limit to find").waitFor();
  const shown = async () => JSON.parse(await page.locator("aside pre").first().textContent());
  assert.deepEqual(await shown(), { over: { clearance_mm: {} }, metric: "peak_slider_acceleration_m_s2" });
  // By the keyboard alone, as far as that goes.
  await page.getByLabel("Name", { exact: true }).focus();
  await page.keyboard.type("how far");
  for (const [label, text] of [["From [mm]", "0.05"], ["To [mm]", "0.5"], ["Tolerance [mm]", "0.1"], ["Number of initial values", "3"], ["Bound [m/s²]", "low"]]) {
    await page.getByLabel(label, { exact: true }).focus();
    await page.keyboard.type(text);
  }
  await page.getByLabel("Metric", { exact: true }).fill("max_penetration_um");
  const bound = page.locator(".field", { has: page.getByLabel("Bound [µm]", { exact: true }) });
  await bound.getByText("must be a number", { exact: true }).waitFor();
  assert.ok(await page.getByRole("button", { name: "Submit" }).isDisabled());
  await page.getByLabel("Bound [µm]", { exact: true }).fill("4");
  await page.getByLabel("Quantile", { exact: true }).fill("2");
  for (const [key, value] of Object.entries(short)) await page.locator(`[data-path="${key}"] input[type="text"]`).fill(String(value));
  await page.getByLabel("Crank velocity: kind of value").selectOption("list");
  await page.getByLabel("Crank velocity", { exact: true }).fill("8, 10");
  await page.getByText("Replicates and priority").click();
  await page.getByLabel("Replicates", { exact: true }).fill("2");
  await page.getByText("2 limits to find").waitFor();
  await page.getByRole("button", { name: "Submit" }).focus();
  await page.keyboard.press("Enter");
  // A fault that only the service finds stands at its field, and in the list of faults.
  await page.getByRole("alert").getByText("/quantile: must be").waitFor();
  const quantile = page.getByLabel("Quantile", { exact: true });
  assert.equal(await quantile.getAttribute("aria-invalid"), "true");
  await picture(page, "search_form_refused", { fullPage: true });
  await expectAccessible(page);
  await quantile.fill("0.9");
  const curl = await page.locator("aside pre").last().textContent();
  assert.match(curl, /^curl -d '\{"name":"how far".*' http.*\/v1\/searches$/);
  await page.getByRole("button", { name: "Submit" }).click();
  await page.getByText(/^succeeded: 100 %/).waitFor();
  await page.locator(".chart canvas").nth(1).waitFor();
  const search = await ask(`/v1/searches/${page.url().split("/").at(-1)}`);
  const request = { name: "how far", parameters: short, over: { clearance_mm: { from: 0.05, to: 0.5, tolerance: 0.1, first: 3 } }, metric: "max_penetration_um", bound: 4, quantile: 0.9,
    sweep: { crank_velocity_rad_s: [8, 10] }, replicates: { count: 2, perturbation: 1e-6, seed: 1 } };
  assert.deepEqual(search.request, request);
  assert.equal(await page.getByRole("region", { name: "Limits" }).getByRole("row").count(), 1 + search.limits.length);
  await page.getByRole("combobox", { name: "At" }).selectOption("1");
  await expectAccessible(page);
  await picture(page, "limits", { fullPage: true });
  const form = await visit(`#/searches/new?from=${search.id}`);
  await form.getByText("2 limits to find").waitFor();
  assert.deepEqual(JSON.parse(await form.locator("aside pre").first().textContent()), request);
  await leave(form);
  // Its jobs are a sweep, which leads back to it and is deleted with it only.
  const list = await visit("#/");
  const row = list.getByRole("row", { name: /how far/ });
  assert.equal(await row.getByRole("button", { name: /^Delete/ }).count(), 0);
  await row.getByRole("link", { name: "search", exact: true }).click();
  await list.getByText(/^succeeded: 100 %/).waitFor();
  assert.ok(list.url().endsWith(`#/searches/${search.id}`));
  await leave(list);
  await page.getByRole("button", { name: "Delete" }).click();
  await page.getByRole("button", { name: "Delete", exact: true }).last().click();
  await page.getByText("No searches yet").waitFor();
  assert.equal((await fetch(`${url}/v1/sweeps/${search.sweep_id}`)).status, 404);
  await leave(page, /422/);
});

test("a wear study is begun in its form, draws the bore and is deleted", async () => {
  const page = await visit("#/wear");
  await page.getByText("No wear studies yet").waitFor();
  await page.getByRole("link", { name: "New wear study" }).click();
  await page.getByText("Until 0.26 mm").waitFor();
  await picture(page, "wear_form", { fullPage: true });
  await page.getByRole("link", { name: "Empty form" }).click();
  await page.getByText("No end given").waitFor();
  await page.getByLabel("Name", { exact: true }).fill("worn");
  await page.getByLabel("Worn clearance [mm]", { exact: true }).fill("0.254");
  await page.getByLabel("Max depth step [µm]", { exact: true }).fill("2");
  await page.getByLabel("Sectors", { exact: true }).fill("3");
  for (const [key, value] of Object.entries(short)) await page.locator(`[data-path="${key}"] input[type="text"]`).fill(String(value));
  await page.getByLabel("Restitution: kind of value").selectOption("list");
  await page.getByLabel("Restitution", { exact: true }).fill("0.8, 0.9");
  await page.locator("[data-path='restitution']").getByText("must have a single value in a wear study").waitFor();
  await page.getByLabel("Restitution", { exact: true }).fill("");
  await page.locator("[data-path='restitution']").getByText("the list is empty").waitFor();
  await page.getByLabel("Restitution: kind of value").selectOption("one");
  await page.getByRole("button", { name: "Submit" }).click();
  await page.getByRole("alert").getByText("/sectors: must be an integer").waitFor();
  assert.equal(await page.getByLabel("Sectors", { exact: true }).getAttribute("aria-invalid"), "true");
  await expectAccessible(page);
  await page.getByLabel("Sectors", { exact: true }).fill("");
  await page.getByRole("button", { name: "Submit" }).click();
  await page.getByText(/^succeeded: 100 %/).waitFor();
  await page.locator(".chart canvas").nth(1).waitFor();
  const study = await ask(`/v1/wear-studies/${page.url().split("/").at(-1)}`);
  assert.deepEqual(study.request, { name: "worn", parameters: short, worn_clearance_mm: 0.254, max_depth_step_um: 2 });
  assert.equal(await page.getByRole("region", { name: "Cycles" }).getByRole("row").count(), 1 + study.cycles.length);
  await page.getByRole("combobox", { name: "Ring" }).selectOption("1");
  const bore = await textOf(page, () => page.getByRole("button", { name: "SVG" }).first().click());
  assert.ok(bore.text.includes(">0°<") && bore.text.includes(">330°<") && !bore.text.includes(">360°<"), "0° and 360° are one place");
  await expectAccessible(page);
  await picture(page, "wear", { fullPage: true });
  await page.getByRole("button", { name: "Delete" }).click();
  await page.getByRole("button", { name: "Delete", exact: true }).last().click();
  await page.getByText("No wear studies yet").waitFor();
  await leave(page, /422/);
});

test("a sweep is held against the paper's statements", async () => {
  const sweep = await runSweep({ name: "statements", parameters: { duration_s: 0.6, run_up_s: 0.3 }, sweep: { clearance_mm: [0, 0.25, 0.5], crank_velocity_rad_s: [10, 15], coupler: ["rigid", "flexible"] } });
  const rows = await ask(`/v1/sweeps/${sweep.id}/paper`);
  const numbered = rows.filter((row) => row.number !== null);
  assert.deepEqual(numbered.map((row) => [row.number, row.settings]), [1, 2, 3, 4, 5, 6, 7].map((number) => [number, 1]));
  const page = await visit(`#/sweeps/${sweep.id}`);
  await page.getByText(`The paper's statements: ${numbered.filter((row) => row.holds).length} of 7 hold; one run each`).waitFor();
  await page.getByRole("link", { name: "The paper's statements" }).click();
  await page.getByRole("heading", { name: "The paper's statements" }).waitFor();
  assert.equal(await page.locator("section.card h2").first().textContent(), "The paper's statements");
  const cells = (name) => page.getByRole("region", { name, exact: true }).locator("tbody tr")
    .evaluateAll((found) => found.map(({ cells: each }) => [...each].map((cell) => cell.textContent)));
  await page.getByRole("region", { name: "The paper's statements" }).waitFor();
  const shown = await cells("The paper's statements");
  assert.deepEqual(shown.map(([number, , , , verdict]) => [number, verdict]), numbered.map((row) => [String(row.number), row.holds ? "holds" : "outside the paper's"]));
  assert.deepEqual(shown.map(([, , paper]) => paper), ["1", "8.5", "4", "3.5", "1.25", "below 1", "below 1"]);
  // The ratio of two peaks of the results themselves.
  const peaks = (await resultsOf(sweep)).filter((row) => row.clearance_mm === 0.25 && row.coupler === "rigid")
    .sort((a, b) => a.crank_velocity_rad_s - b.crank_velocity_rad_s).map((row) => row.peak_slider_acceleration_m_s2);
  assert.ok(Math.abs(Number(shown[1][3]) / (peaks[1] / peaks[0]) - 1) < 0.01, `${shown[1][3]} of ${peaks}`);
  assert.equal((await cells("Other velocities")).length, 2);
  const csv = await textOf(page, () => page.getByRole("region", { name: "Other velocities" }).locator("xpath=following::a[text()='CSV']").first().click());
  assert.equal(csv.text.trim().split("\n").length, 1 + rows.length);
  await page.locator(".chart:not([hidden]) canvas").first().waitFor();
  await expectAccessible(page);
  await picture(page, "paper_statements", { fullPage: true });
  for (const [name, options] of [["dark", { colorScheme: "dark", viewport: { width: 1200, height: 1000 } }], ["phone", { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }]]) {
    const other = await visit(`#/analyses/${sweep.id}`, options);
    await other.getByRole("region", { name: "The paper's statements" }).waitFor();
    await expectNoSideways(other);
    await expectAccessible(other);
    await picture(other, `paper_statements_${name}`);
    await leave(other);
  }
  await leave(page);
});

test("a sweep says what its results mean", async () => {
  const over = { clearance_mm: { from: 0.1, to: 0.4 }, restitution: { from: 0.7, to: 0.9 } };
  const designed = await runSweep({ name: "indices", parameters: short, design: { type: "saltelli", count: 4, over } });
  const compared = await runSweep({ name: "pairs", parameters: { ...short, run_up_s: 0 }, sweep: { crank_velocity_rad_s: [10, 20, 30], coupler: ["rigid", "flexible"] }, replicates: { count: 2 } });
  const page = await visit(`#/sweeps/${compared.id}`);
  await page.getByRole("link", { name: "Analysis" }).click();
  for (const title of ["Effect of flexibility", "Surrogate", "Bifurcation diagram", "Largest Lyapunov exponent"]) await page.getByRole("heading", { name: title }).waitFor();
  await page.getByRole("region", { name: "Rigid and flexible" }).waitFor();
  await page.getByRole("region", { name: "Lyapunov exponents" }).waitFor();
  await page.locator(".chart:not([hidden]) canvas").nth(1).waitFor();
  await expectAccessible(page);
  await picture(page, "analyses", { fullPage: true });
  await page.getByRole("link", { name: "Report" }).click();
  await page.getByRole("heading", { name: "Reproduction" }).waitFor();
  assert.equal(await page.locator("svg").count(), 2, "heat maps and charts");
  assert.equal(await page.evaluate(() => getComputedStyle(document.querySelector("table")).borderCollapse), "collapse", "its style is allowed");
  await expectAccessible(page);
  await picture(page, "report", { fullPage: true });
  await page.goto(`${url}/#/analyses/${designed.id}`);
  await page.getByRole("region", { name: "Sensitivity" }).getByText("Restitution").waitFor();
  await page.getByText(/leave-one-out error/).waitFor();
  await page.locator(".chart canvas").nth(1).waitFor();
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption("impact_count");
  await page.waitForURL(/metric=impact_count/);
  await page.locator(".chart canvas").nth(1).waitFor();
  await expectAccessible(page);
  await picture(page, "sensitivity", { fullPage: true });
  // One that predicts worse than a mean is not praised with a part of the variance.
  await page.route("**/surrogate?**", async (route) => {
    const answer = await route.fetch();
    const made = await answer.json();
    await route.fulfill({ json: { ...made, surfaces: made.surfaces.map((surface) => ({ ...surface, predicted_part: -0.05 })) } });
  });
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption("peak_contact_force_n");
  await page.getByText(/leave-one-out error .*, no better than the mean, so of no use here/).waitFor();
  await leave(page);
});

test("a view that is not there says so", async () => {
  const page = await visit("#/jobs/none");
  await page.getByRole("heading", { name: "This page cannot be shown" }).waitFor();
  await leave(page, /404/);
});
