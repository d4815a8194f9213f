// SPDX-License-Identifier: Apache-2.0
// The page of a sweep of hundreds of jobs: which curves it draws and how, its headlines, its scatter.   node sweep_page.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { drawn, force, metric, row, visitRows } from "./given.mjs";
import { ask, endVisits, expectAccessible, expectNoSideways, leave, picture, runSweep, textOf, url, visit } from "./visitor.mjs";

after(endVisits);
const axes = ["crank_velocity_rad_s", "clearance_mm", "coupler"];
const velocities = Array.from({ length: 25 }, (_, k) => 4 + k / 2);
const clearances = Array.from({ length: 12 }, (_, k) => Number((0.05 * k).toFixed(2)));

/** 600 jobs, of which the one at 10 rad/s, 0.35 mm, flexible has the largest peak. */
const rows = velocities.flatMap((velocity) => clearances.flatMap((clearance) => ["rigid", "flexible"].map((coupler) => {
  const isLargest = velocity === 10 && clearance === 0.35 && coupler === "flexible";
  const value = isLargest ? 1000 : velocity * (1 + clearance) + (coupler === "rigid" ? 0 : 0.5);
  return row(`${velocity}_${clearance}_${coupler}`, { crank_velocity_rad_s: velocity, clearance_mm: clearance, coupler, [metric]: value,
    peak_slider_acceleration_time_s: 0.25, [force]: clearance === 0 ? null : 10 * value });
})));

/** Its lines: of each curve the name in the legend, colour, line style, mark and largest value. */
function curves(page) {
  return page.locator(".chart").nth(1).evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    return getInstanceByDom(element).getModel().getSeries().filter(({ id }) => id.startsWith("line:"))
      .map(({ option }) => ({ name: option.name, colour: option.color, pattern: option.lineStyle.type, symbol: option.symbol,
        largest: Math.max(...option.data.map((point) => (point.value ?? point)[1])) }));
  });
}

test("of 24 curves 12 are drawn: numbers by a colour scale, words by line style in the order asked, the largest peak among them", async () => {
  const page = await visitRows(axes, rows);
  const shown = await curves(page);
  assert.equal(shown.length, 12);
  assert.equal(shown.filter(({ largest }) => largest === 1000).length, 1);
  assert.deepEqual(shown.slice(0, 2).map(({ name, pattern }) => [name, pattern]), [["rigid", "solid"], ["flexible", "dashed"]]);
  assert.equal(new Set(shown.map(({ colour }) => colour)).size, 6, "both couplers of a clearance in its colour");
  assert.equal(new Set(shown.map(({ pattern }) => pattern)).size, 2);
  assert.deepEqual((await drawn(page, 1)).titles, ["12 of 24 curves, evenly spread, with the one of the largest value."]);
  const svg = await textOf(page, () => page.getByRole("button", { name: "SVG" }).nth(1).click());
  for (const text of ["Clearance [mm]", "0", "0.35", "0.55", "rigid", "flexible"]) assert.ok(svg.text.includes(`>${text}<`), text);
  assert.ok(!svg.text.includes(">0.05<"), "a tick at what is drawn only");
  await expectAccessible(page);
  await picture(page, "six_hundred", { fullPage: true });
  await leave(page);
});

test("the curves are chosen, twelve at most, and stand in the address", async () => {
  const page = await visitRows(axes, rows);
  await page.getByText("Curves: 12 of 24").click();
  const box = (name) => page.getByRole("checkbox", { name, exact: true });
  assert.ok(await box("0.05 mm, rigid").isDisabled());
  await page.getByText("At most 12 at once: take one out for another.").waitFor();
  await box("0 mm, flexible").uncheck();
  await page.getByText("Curves: 11 of 24").waitFor();
  await box("0.05 mm, rigid").check();
  await page.getByText("Curves: 12 of 24").waitFor();
  await expectAccessible(page);
  await picture(page, "curves_chosen");
  assert.deepEqual((await drawn(page, 1)).titles, ["12 of 24 curves, as chosen."]);
  const again = await visitRows(axes, rows, { query: new URL(page.url()).hash.replace(/^[^?]*/, "") });
  assert.deepEqual(await curves(again), await curves(page));
  await leave(again);
  await page.getByLabel("Search curves").fill("0.55");
  assert.equal(await page.locator(".menu[open] .list input").count(), 2);
  await page.getByRole("button", { name: "Evenly spread" }).click();
  await page.waitForURL((address) => !address.href.includes("curves="));
  // The choices for an axis are forgotten with it.
  await page.getByLabel("Search curves").fill("");
  await box("0 mm, flexible").uncheck();
  await page.getByRole("combobox", { name: "Facet by" }).selectOption("");
  await page.waitForURL((address) => !address.href.includes("curves="));
  assert.equal((await curves(page)).length, 12);
  await leave(page);
});

test("another sweep has thin lines and hollow marks, of the same curves", async () => {
  const page = await visitRows(axes, rows);
  await page.route("**/v1/sweeps/swp_other", (route) => route.fulfill({ json: { id: "swp_other", name: "other", axes } }));
  await page.route("**/v1/sweeps/swp_other/results", (route) => route.fulfill({ json: rows.map((each) => ({ ...each, [metric]: each[metric] + 1 })) }));
  await page.evaluate(() => { location.hash = "#/sweeps/swp_given?with=swp_other"; });
  await page.waitForFunction(() => document.querySelectorAll(".chart canvas").length > 3);
  await page.waitForTimeout(300);
  const shown = await curves(page);
  const theirs = shown.filter(({ name }) => name.endsWith("other"));
  assert.deepEqual([shown.length, theirs.length], [12, 6]);
  assert.ok(theirs.every(({ symbol }) => symbol.startsWith("empty")));
  assert.deepEqual(theirs.map(({ colour, pattern }) => [colour, pattern]), shown.slice(0, 6).map(({ colour, pattern }) => [colour, pattern]));
  await picture(page, "beside");
  await leave(page);
});

test("a sweep stands alone where the one beside it is gone", async () => {
  const page = await visitRows(axes, rows, { query: "?with=swp_gone" });
  await page.waitForURL((address) => !address.href.includes("with="));
  assert.equal((await curves(page)).length, 12);
  await leave(page, /404/);
});

test("the headlines tell the largest and the least value with their parameters, and why jobs failed", async () => {
  const failed = [0, 1, 2].map((k) => ({ job_id: `job_f${k}`, state: "failed", crank_velocity_rad_s: 20, clearance_mm: k, coupler: "rigid", [metric]: null }));
  const failures = failed.map(({ job_id: id }, k) => ({ job_id: id, error_reason: k === 0 ? "time_limit" : "step_limit", error_detail: "" }));
  const page = await visitRows(axes, [...rows, ...failed], { failures });
  const lines = page.locator(".headlines li");
  await page.getByText("3 jobs of 603 failed: 2 by step_limit, 1 by time_limit.").waitFor();
  assert.deepEqual((await lines.allTextContents()).slice(0, 3), [
    "Largest peak slider acceleration: 1000 m/s² at 0.25 s of the run, crank velocity 10 rad/s, clearance 0.35 mm, coupler flexible (job …xible)",
    "Least: 4 m/s² at 0.25 s of the run, crank velocity 4 rad/s, clearance 0 mm, coupler rigid (job …rigid)",
    "One run each: how much the values scatter is not known."]);
  assert.equal(await lines.first().getByRole("link").getAttribute("href"), "#/jobs/job_10_0.35_flexible");
  // The definition of a number stands in a tooltip, as in the choice of columns.
  await lines.first().locator("strong").hover();
  await page.getByRole("tooltip").getByText("m/s²").waitFor();
  await page.getByText(/^Columns: /).click();
  await page.locator(".menu label").filter({ hasText: "Peak contact force" }).hover();
  await page.getByRole("tooltip").getByText("[N]").waitFor();
  await page.getByText(/^Columns: /).click();
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption(force);
  assert.match(await lines.first().textContent(), /^Largest peak contact force: 10000 N, crank velocity 10 rad\/s/);
  await expectAccessible(page);
  await leave(page);
});

test("the headlines tell how far replicates differ, where there are some", async () => {
  const values = [[10, 10.1], [20, 25]];
  const replicated = values.flatMap((pair, k) => pair.map((value, replicate) => row(`${k}${replicate}`, { clearance_mm: k, replicate, [metric]: value })));
  const page = await visitRows(["clearance_mm"], replicated);
  await page.getByText("Replicates of 2 settings differ by at most 22 % of their mean (5 m/s², 2 runs, clearance 1 mm, job …ob_10)").waitFor();
  assert.equal(await page.getByText("One run each").count(), 0);
  await leave(page);
});

test("any number stands over any other in the scatter, whose click selects", async () => {
  const page = await visitRows(axes, rows);
  const scatter = page.locator(".chart").nth(3);
  await scatter.locator("canvas").waitFor();
  const points = async () => (await drawn(page, 3)).series[0];
  assert.equal((await points()).length, 550, "jobs without a contact force have no place");
  assert.equal(await page.getByRole("combobox", { name: "Colour" }).inputValue(), "crank_velocity_rad_s");
  // An axis along which the jobs lie needs no colour: another one has it.
  await page.getByRole("combobox", { name: "Along" }).selectOption("crank_velocity_rad_s");
  assert.equal(await page.getByRole("combobox", { name: "Colour" }).inputValue(), "clearance_mm");
  await page.getByRole("combobox", { name: "Along" }).selectOption("clearance_mm");
  assert.equal(await page.getByRole("combobox", { name: "Colour" }).inputValue(), "crank_velocity_rad_s");
  await page.getByRole("combobox", { name: "Upwards" }).selectOption("crank_velocity_rad_s");
  await page.getByRole("combobox", { name: "Colour" }).selectOption("none");
  assert.equal((await drawn(page, 3)).series.length, 1);
  await page.getByRole("combobox", { name: "Colour" }).selectOption("coupler");
  await page.waitForURL(/scatter_x=clearance_mm&scatter_y=crank_velocity_rad_s&scatter_colour=coupler/);
  const { series, x, y } = await drawn(page, 3);
  assert.deepEqual([series.length, series[0].length, series[1].length], [2, 300, 300]);
  assert.deepEqual([x[0].name, y[0].name], ["Clearance [mm]", "Crank velocity [rad/s]"]);
  await page.getByRole("combobox", { name: "Along" }).selectOption("coupler");
  assert.equal((await drawn(page, 3)).x[0].type, "category");
  await page.getByRole("combobox", { name: "Along" }).selectOption("clearance_mm");
  const [px, py] = await scatter.evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    return getInstanceByDom(element).convertToPixel({ seriesIndex: 0 }, [0.25, 10]);
  });
  await scatter.click({ position: { x: px, y: py } });
  await page.getByText("1 job selected").waitFor();
  await page.waitForURL(/jobs=job_10_0\.25_/);
  await expectAccessible(page);
  await scatter.scrollIntoViewIfNeeded();
  await picture(page, "scatter");
  await leave(page);
});

test("brushes on two axes of more than two thousand jobs select together", async () => {
  const crowd = Array.from({ length: 2001 }, (_, k) => row(k, { crank_velocity_rad_s: k % 50, clearance_mm: Math.floor(k / 50), [metric]: k }));
  const page = await visitRows(["crank_velocity_rad_s", "clearance_mm"], crowd);
  const parallel = page.locator(".chart").nth(2);
  await parallel.scrollIntoViewIfNeeded();
  await parallel.locator("canvas").first().waitFor();
  /** Brushes the upper half of the first or second of three axes; gives the number of selected jobs a while later. */
  const brush = async (place) => {
    const box = await parallel.boundingBox();
    const [x, top, height] = [box.x + 60 + place * (box.width - 150) / 2, box.y + 50, box.height - 105];
    await page.mouse.move(x, top + 2);
    await page.mouse.down();
    await page.mouse.move(x, top + height / 2, { steps: 10 });
    await page.mouse.up();
    await page.waitForTimeout(1000);  // many jobs are drawn late
    return Number((await page.getByText(/ jobs selected$/).textContent()).replace(/\D/g, ""));
  };
  const first = await brush(0);
  assert.ok(first > 800 && first < 1200, `${first} jobs of the upper half of an axis`);
  const both = await brush(1);
  assert.ok(both > 350 && both < 650, `${both} jobs of the upper halves of two axes`);
  await leave(page);
});

test("six hundred jobs are read on a phone, in the dark and on a wide screen", async () => {
  for (const width of [390, 1280, 1920]) {
    const page = await visitRows(axes, rows, { width });
    await page.getByLabel("Theme").selectOption("dark");
    await expectNoSideways(page);
    await expectAccessible(page);
    // The names of axes stand whole, and no select sticks out of its card.
    const gap = await page.locator(".chart").nth(2).evaluate((element, count) => (element.clientWidth - 150) / (count - 1), (await drawn(page, 2)).parallel.length);
    assert.ok(gap >= 83, `${gap} pixels from axis to axis`);
    const outside = await page.locator(".card select").evaluateAll((all) => all.filter((each) => each.getBoundingClientRect().right > each.closest(".card").getBoundingClientRect().right).length);
    assert.equal(outside, 0);
    await picture(page, `six_hundred_${width}`);
    for (const menu of [/^Curves: /, /^Columns: /]) {
      await page.getByText(menu).click();
      const box = await page.locator(".menu[open] > .card").boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= width, `a menu from ${box.x}, ${box.width} wide`);
      await picture(page, `menu_${width}`);
      await page.getByText(menu).click();
    }
    await leave(page);
  }
});

test("a sweep is renamed, noted and tagged, and found by its tag", async () => {
  const sweep = await runSweep({ name: "first name", parameters: { duration_s: 0.02, run_up_s: 0.01 }, sweep: { clearance_mm: [0.1, 0.2] } });
  const page = await visit(`#/sweeps/${sweep.id}`);
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  const dialog = page.getByRole("dialog", { name: "Name, notes and tags" });
  assert.equal(await dialog.getByLabel("Name").inputValue(), "first name");
  await dialog.getByLabel("Name").fill("not kept");
  await page.keyboard.press("Escape");
  await dialog.waitFor({ state: "hidden" });
  assert.equal((await ask(`/v1/sweeps/${sweep.id}`)).name, "first name");
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  await dialog.getByLabel("Tags").fill("x".repeat(5000));
  await dialog.getByRole("button", { name: "Save" }).click();
  await dialog.getByRole("alert").getByText(/\w/).waitFor();
  assert.equal(await dialog.getByLabel("Tags").getAttribute("aria-invalid"), "true");
  await dialog.getByLabel("Name").fill("second name");
  await dialog.getByLabel("Notes").fill("worn bearing\nmeasured <b>twice</b>");
  await dialog.getByLabel("Tags").fill("bench, worn, bench,");
  await expectAccessible(page);
  await picture(page, "edit_sweep");
  await dialog.getByRole("button", { name: "Save" }).click();
  await page.getByRole("heading", { name: "second name" }).waitFor();
  await page.getByText("measured <b>twice</b>").waitFor();
  assert.deepEqual(await page.locator(".badge.tag").allTextContents(), ["bench", "worn"]);
  assert.equal(await page.getByRole("link", { name: "CSV" }).getAttribute("download"), "second name.csv");
  const { name, notes, tags } = await ask(`/v1/sweeps/${sweep.id}`);
  assert.deepEqual([name, notes, tags], ["second name", "worn bearing\nmeasured <b>twice</b>", ["bench", "worn"]]);
  await expectAccessible(page);
  await picture(page, "noted");
  await page.goto(`${url}/#/`);
  await page.getByLabel(/^Search \(name/).fill("BENCH");
  await page.getByText("1 sweep, 0 under way").waitFor();
  assert.deepEqual(await page.locator(".listing tbody .badge.tag").allTextContents(), ["bench", "worn"]);
  await page.getByLabel(/^Search \(name/).fill("benches");
  await page.getByText("No matching sweeps.").waitFor();
  await page.getByLabel(/^Search \(name/).fill("second worn");
  await page.getByText("1 sweep, 0 under way").waitFor();
  await expectAccessible(page);
  await picture(page, "tagged");
  await page.setViewportSize({ width: 390, height: 900 });
  await expectNoSideways(page);
  await picture(page, "tagged_390");
  await leave(page, /422/);
});

test("a sweep tells its configuration, is extended, reported and deleted", async () => {
  const sweep = await runSweep({ name: "set up", parameters: { duration_s: 0.02, run_up_s: 0.01, restitution: 0.9 },
    sweep: { clearance_mm: { from: 0.1, to: 0.2, count: 2 }, coupler: ["rigid"] } });
  const page = await visit(`#/sweeps/${sweep.id}`);
  const configuration = page.locator("details", { has: page.getByText("Configuration", { exact: true }) }).first();
  const values = async () => Object.fromEntries(await configuration.locator("dl > div").evaluateAll((parts) =>
    parts.filter((each) => !each.hidden).map((each) => [...each.children].map((part) => part.textContent))));
  await configuration.getByText(/^RPSUP \d.*engine/).waitFor();
  const shown = await values();
  assert.deepEqual([shown.Clearance, shown.Coupler, shown.Duration, shown["Everything else"]],
    ["0.1 to 0.2 mm, 2 values", "rigid", "0.02 s", "defaults"]);
  assert.equal(shown.Restitution, undefined, "a parameter with its default value");
  await configuration.getByText("Request", { exact: true }).click();
  await configuration.locator("pre:not(:empty)").waitFor();
  assert.deepEqual(JSON.parse(await configuration.locator("pre").textContent()), sweep.request);
  await expectAccessible(page);
  await picture(page, "configuration");
  await page.getByRole("button", { name: "Extend", exact: true }).click();
  const dialog = page.getByRole("dialog", { name: "More values for the axes" });
  await dialog.getByRole("button", { name: "Extend" }).click();
  await dialog.getByText("Write a value into a field.").waitFor();
  await dialog.getByLabel("Clearance [mm]").fill("0.25; 0,3");
  await dialog.getByLabel("Coupler").fill("soft");
  await dialog.getByRole("button", { name: "Extend" }).click();
  await dialog.getByText(/coupler/).first().waitFor();
  await dialog.getByLabel("Coupler").fill("");
  await expectAccessible(page);
  await dialog.getByRole("button", { name: "Extend" }).click();
  await page.getByText("succeeded: 4 succeeded of 4 jobs").waitFor();
  assert.deepEqual((await ask(`/v1/sweeps/${sweep.id}`)).request.sweep.clearance_mm, [0.1, 0.2, 0.25, 0.3]);
  await page.getByLabel("Metric").selectOption("impact_count");
  const report = await page.getByRole("link", { name: "Report" }).getAttribute("href");
  const answer = await fetch(new URL(report, url));
  assert.equal(answer.status, 200);
  assert.match(await answer.text(), /Largest impact count/);
  await page.goto(String(new URL(report, url)));
  await expectNoSideways(page);
  await expectAccessible(page);
  await page.goBack();
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByRole("dialog").getByRole("button", { name: "Delete" }).click();
  await page.waitForURL(/#\/$/);
  assert.equal((await fetch(`${url}/v1/sweeps/${sweep.id}`)).status, 404);
  await leave(page, /422/);
});
