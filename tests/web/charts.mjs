// SPDX-License-Identifier: Apache-2.0
// The page of a sweep with rows that no short sweep has: nearly equal, missing, decades apart.
//   node charts.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { drawn, force, metric, paperRows, reasons, row, visitRows } from "./given.mjs";
import { endVisits, expectAccessible, leave, picture, textOf, visit } from "./visitor.mjs";

after(endVisits);

test("values that differ in their eighth digit are drawn as equal", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], [[0, "rigid", 38.9], [0, "flexible", 38.9000004], [1, "rigid", 38.9000001], [1, "flexible", 38.9000003]]
    .map(([clearance, coupler, value], k) => row(k, { clearance_mm: clearance, coupler, [metric]: value })));
  const [heat, lines, parallel] = [await drawn(page, 0), await drawn(page, 1), await drawn(page, 2)];
  for (const [least, largest] of [...heat.colours, lines.y[0].ends, parallel.parallel.at(-1).ends]) {
    assert.ok(largest - least >= 1e-3 * 38.9 && largest - least < 0.1 * 38.9, `${least} to ${largest}`);
    assert.ok(least < 38.9 && largest > 38.9000004);
  }
  await picture(page, "nearly_equal", { fullPage: true });
  await leave(page);
});

test("the least span of an axis leaves other values alone", async () => {
  const page = await visit("#/wear");
  const [near, apart, equal, negative, zero] = await page.evaluate(async () => {
    const { widened } = await import("/study/span.js");
    return [[100, 100.05], [100, 101], [100, 100], [-100.01, -100], [0, 1e-9]].map(([min, max]) => widened({ min, max }));
  });
  assert.ok(Math.abs(near.min - 99.9) < 1e-9 && Math.abs(near.max - 100.1) < 1e-9);
  assert.equal(apart, null);
  assert.equal(equal, null);
  assert.ok(negative.min <= -100.05 && negative.max >= -99.96);
  assert.equal(zero, null);
  await leave(page);
});

test("no line is as dark as the dark page", async () => {
  const page = await visitRows(["clearance_mm"], [0.1, 0.2].map((clearance, k) => row(k, { clearance_mm: clearance, [metric]: k + 1 })));
  await page.getByLabel("Theme").selectOption("dark");
  for (const name of ["viridis", "cividis"]) {
    await page.getByLabel("Palette").selectOption(name);
    const contrasts = await page.locator(".chart").nth(2).evaluate(async (element) => {
      const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
      const { colour } = await import("/core/theme.js");
      const light = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255).map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4))
        .reduce((sum, part, k) => sum + [0.2126, 0.7152, 0.0722][k] * part, 0);
      const [{ option }] = getInstanceByDom(element).getModel().queryComponents({ mainType: "visualMap" });
      return option.inRange.color.map((stop) => (light(stop) + 0.05) / (light(colour("card")) + 0.05));
    });
    assert.ok(contrasts.length > 3 && Math.min(...contrasts) > 2.4, `${name}: ${contrasts.map((contrast) => contrast.toFixed(2))}`);
  }
  await picture(page, "dark_lines", { fullPage: true });
  await leave(page);
});

test("axes are logarithmic where values lie decades apart, and as they were where somebody says so", async () => {
  const values = [1e-8, 1e-6, 1e-4];
  const page = await visitRows(["relative_tolerance"], values.map((tolerance, k) => row(k, { relative_tolerance: tolerance, [metric]: 10 ** k, [force]: k - 1 })));
  assert.deepEqual([(await drawn(page, 1)).x[0].type, (await drawn(page, 1)).y[0].type], ["log", "value"]);
  await page.getByLabel("log scale: peak slider acceleration").check();
  await page.getByLabel("log scale: relative tolerance").uncheck();
  await page.waitForURL(/x_scale=linear&metric_scale=log/);
  assert.deepEqual([(await drawn(page, 1)).x[0].type, (await drawn(page, 1)).y[0].type], ["value", "log"]);
  await expectAccessible(page);
  await picture(page, "logarithmic");
  // A metric that is not positive everywhere cannot be so.
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption(force);
  await page.getByLabel("log scale: peak contact force").waitFor({ state: "hidden" });
  assert.equal((await drawn(page, 1)).y[0].type, "value");
  await leave(page);
});

test("a scale is forgotten with its axis or metric", async () => {
  const values = [1e-8, 1e-6, 1e-4];
  const rows = values.flatMap((tolerance, k) => values.map((step, i) => row(`${k}${i}`, { relative_tolerance: tolerance, absolute_tolerance: step, [metric]: 10 ** k, [force]: 10 ** i })));
  const page = await visitRows(["relative_tolerance", "absolute_tolerance"], rows, { query: "?x=relative_tolerance&x_scale=linear&metric_scale=log" });
  const types = async () => [(await drawn(page, 1)).x[0].type, (await drawn(page, 1)).y[0].type];
  assert.deepEqual(await types(), ["value", "log"]);
  await page.getByRole("combobox", { name: "x axis" }).selectOption("absolute_tolerance");
  assert.deepEqual(await types(), ["log", "log"]);
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption(force);
  assert.deepEqual(await types(), ["log", "value"]);
  await page.waitForURL((address) => !/_scale=/.test(address.href));
  await leave(page);
});

test("what a chart averages over, and of which metric, stands in it", async () => {
  const rows = [0.1, 0.2].flatMap((clearance) => ["rigid", "flexible"].map((coupler, k) => row(`${clearance}${k}`, { clearance_mm: clearance, coupler, [metric]: clearance + k })));
  const page = await visitRows(["clearance_mm", "coupler"], rows, { query: "?x=clearance_mm" });
  assert.equal((await drawn(page, 0)).titles[0], "Peak slider acceleration [m/s²]\nmean over coupler");
  assert.deepEqual((await drawn(page, 1)).titles, ["Mean over coupler; bars: range."]);
  const svg = await textOf(page, () => page.getByRole("button", { name: "SVG" }).first().click());
  assert.match(svg.text, /Peak slider acceleration \[m\/s²\][\s\S]*mean over coupler/);
  await page.getByRole("combobox", { name: "y axis / series" }).selectOption("coupler");
  assert.equal((await drawn(page, 0)).titles[0], "Peak slider acceleration [m/s²]");
  // A title that is not shown would still be told to those who do not see it.
  const { titles, said } = await drawn(page, 1);
  assert.deepEqual(titles, [""]);
  assert.doesNotMatch(said, /The first|Mean/);
  await leave(page);
});

test("what tells lines apart stands above them, and in the saved picture", async () => {
  const rows = [5, 10, 12].flatMap((velocity) => ["rigid", "flexible"].flatMap((coupler) => [0, 1].map((clearance) =>
    row(`${velocity}${coupler}${clearance}`, { clearance_mm: clearance, crank_velocity_rad_s: velocity, coupler, [metric]: velocity + clearance }))));
  const names = ["Crank velocity [rad/s]", "5", "10", "12", "rigid", "flexible"];
  for (const width of [1440, 390]) {
    const page = await visitRows(["clearance_mm", "crank_velocity_rad_s", "coupler"], rows, { query: "?x=clearance_mm&y=crank_velocity_rad_s&panel=coupler", width });
    const [type, bottom, top] = await page.locator(".chart").nth(1).evaluate(async (element) => {
      const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
      const chart = getInstanceByDom(element);
      const [legend, grid] = ["legend", "grid"].map((mainType) => chart.getModel().queryComponents({ mainType })[0]);
      const { group } = chart.getViewOfComponentModel(legend);
      const box = group.getBoundingRect();
      return [legend.option.type, group.y + box.y + box.height, grid.coordinateSystem.getRect().y];
    });
    assert.equal(type, "plain", "none is turned away");
    assert.ok(bottom <= top, `names down to ${bottom}, the chart from ${top} pixels on`);
    const svg = await textOf(page, () => page.getByRole("button", { name: "SVG" }).nth(1).click());
    assert.deepEqual(names.filter((name) => !svg.text.includes(`>${name}<`)), []);
    await picture(page, `names_${width}`, { fullPage: true });
    await leave(page);
  }
});

test("the paper's statements over many settings tell in how many they hold, and what decides each", async () => {
  const axes = ["clearance_mm", "crank_velocity_rad_s", "coupler"];
  const page = await visitRows(axes, [10, 15].map((velocity, k) => row(k, { clearance_mm: 0.25, crank_velocity_rad_s: velocity, coupler: "rigid", [metric]: velocity })));
  await page.getByText("The paper's statements: 5 of the 6 statements that can be judged hold; "
    + "1 needs jobs that the sweep does not have; one run each").waitFor();
  await page.route("**/v1/sweeps/swp_given/{flexibility,surrogate,bifurcation}**", (route) => route.fulfill({ status: 409, contentType: "application/problem+json", body: '{"detail": "not here"}' }));
  await page.route("**/v1/sweeps/swp_given/paper**", (route) => route.fulfill({ json: paperRows(1000) }));
  await page.getByRole("link", { name: "The paper's statements" }).click();
  const cells = (name) => page.getByRole("region", { name, exact: true }).locator("tbody tr")
    .evaluateAll((rows) => rows.map(({ cells: each }) => [...each].map((cell) => cell.textContent)));
  await page.getByRole("region", { name: "The paper's statements" }).waitFor();
  const many = "in 43 % of 1,000 settings";
  assert.deepEqual(await cells("The paper's statements"), [["1", "Ratio 1", "below 1", "1", many], ["2", "Ratio 2", "8.5", "2", many], ["3", "Ratio 3", "below 1", "3", many], ["4", "Ratio 4", "below 1", "4", many],
    ["5", "Ratio 5", "below 1", "–", "–"], ["6", "Ratio 6", "below 1", "6 to 6.5", many], ["7", "Ratio 7", "below 1", "7", many]]);
  assert.deepEqual(await cells("Other velocities"), [["Ratio null", "below 1", "8", many]]);
  // From 0.02 on, largest first.
  const decided = await cells("First-order sensitivity indices");
  assert.deepEqual([decided.length, decided[0], decided[1]], [7, ["1", "Restitution0.02"], ["2", "Restitution0.6Coupler damping ratio0.25"]]);
  await expectAccessible(page);
  await picture(page, "paper_settings", { fullPage: true });
  await page.getByRole("link", { name: "Sweep", exact: true }).click();
  await page.getByText("The paper's statements: each holds in 43 % of the settings").waitFor();
  await leave(page, /409/);
});

test("more lines than are drawn are counted", async () => {
  const rows = Array.from({ length: 40 }, (_, k) => [0, 1].map((x) => row(`${k}_${x}`, { x_mm: x, kind: `kind ${k}`, [metric]: k + x }))).flat();
  const page = await visitRows(["x_mm", "kind"], rows, { query: "?x=x_mm&y=kind" });
  assert.deepEqual((await drawn(page, 1)).titles, ["12 of 40 curves, evenly spread, with the one of the largest value."]);
  await leave(page);
});

test("more panels than are drawn are counted", async () => {
  const rows = Array.from({ length: 20 }, (_, k) => [0, 1].map((x) => row(`${k}_${x}`, { x_mm: x, kind: `kind ${k}`, [metric]: k + x }))).flat();
  const page = await visitRows(["x_mm", "kind"], rows, { query: "?x=x_mm&panel=kind" });
  assert.equal((await drawn(page, 0)).titles[0], "Peak slider acceleration [m/s²]\n12 of 20 values of kind");
  await leave(page);
});

test("no line leads across a value that is missing", async () => {
  const rows = [row(0, { clearance_mm: 0, impact_count: 0, [force]: null, [metric]: 1 }), row(1, { clearance_mm: 0.1, impact_count: 5, [force]: 10, [metric]: 2 }),
    row(2, { clearance_mm: 0.2, impact_count: 6, [force]: 20, [metric]: null }), row(3, { clearance_mm: 0.3, impact_count: 7, [force]: null, [metric]: null }),
    row(4, { clearance_mm: 0.4, impact_count: 7, [force]: 20, [metric]: 4 })];
  const page = await visitRows(["clearance_mm"], rows, { query: `?metric=${metric}` });
  // As many have a force as have the metric; the force stands first, so job 0 would have to be drawn across it.
  const { parallel, series: [lines] } = await drawn(page, 2);
  assert.deepEqual(parallel.map(({ name }) => name.replaceAll("\n", " ")), ["Clearance [mm]", "Impact count", "Peak contact force [N]", "Peak slider acceleration [m/s²]"]);
  assert.deepEqual(lines.map((line) => line.value ?? line), [[0.1, 5, 10, 2], [0.2, 6, 20, "-"], [0.3, 7, "-", "-"], [0.4, 7, 20, 4]]);
  await page.getByText("2 lines end early, where the job has no further values. 1 job with a gap between values is left out.").waitFor();
  assert.deepEqual((await drawn(page, 1)).titles, ["2 computed jobs without a value: the table says why."]);
  assert.deepEqual((await drawn(page, 1)).series[0], [[0, 1], [0.1, 2], [0.2, "-"], [0.3, "-"], [0.4, 4]]);
  // The sign for a missing number stands where the numbers do, below their heading.
  const looks = await page.locator("table").evaluate((table) => [...table.rows].map(({ cells }) => [...cells].at(-1)).map((cell) => [cell.textContent, getComputedStyle(cell).textAlign]));
  assert.deepEqual(looks, ["Peak contact force [N]", "–", "10", "20", "–", "20"].map((text) => [text, "right"]));
  await picture(page, "gaps", { fullPage: true });
  await leave(page);
});

test("a value between two that are missing is seen, also where marks would hide the lines", async () => {
  const hasValue = (k) => k === 0 || k === 5 || k === 250 || (k > 300 && k < 500);
  const rows = Array.from({ length: 500 }, (_, k) => row(k, { x_mm: k, [metric]: hasValue(k) ? 2 : null }));
  const page = await visitRows(["x_mm"], rows, { query: "?x=x_mm" });
  const marked = await page.locator(".chart").nth(1).evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    const data = getInstanceByDom(element).getModel().getSeriesByIndex(0).getData();
    return Array.from({ length: data.count() }, (_, place) => place).filter((place) => data.getItemGraphicEl(place));
  });
  assert.deepEqual(marked, [0, 5, 250]);
  await picture(page, "lonely_values");
  await leave(page);
});

test("a chart without values says why", async () => {
  const rows = [0.3, 0.4].map((duration, k) => row(k, { duration_s: duration, [metric]: null, [force]: null }));
  const page = await visitRows(["duration_s"], rows, { parameters: { run_up_s: 0.4 } });
  for (const place of [0, 1]) assert.deepEqual((await drawn(page, place)).titles, ["No job has a value of this metric.\nThe runs end before their steady part: at or before run_up_s."]);
  await page.getByText(/^2 computed jobs without a value of Peak slider acceleration: .* from run_up_s on, and these have ended by then/).waitFor();
  await page.getByRole("combobox", { name: /^Metric/ }).selectOption(force);
  assert.deepEqual((await drawn(page, 1)).titles, ["No job has a value of this metric.\nValues of contacts need a clearance."]);
  await leave(page);
});

test("the table says why jobs failed", async () => {
  const rows = [row(0, { clearance_mm: 0.1, [metric]: 1 }), { job_id: "job_1", state: "failed", clearance_mm: 0.2, [metric]: null }];
  const page = await visitRows(["clearance_mm"], rows, { failures: [{ job_id: "job_1", error_reason: "step_limit", error_detail: "the run needs more than 10 steps" }] });
  const cell = page.getByRole("cell", { name: "failed: step_limit the run needs more than 10 steps" });
  await cell.waitFor();
  await expectAccessible(page);
  await picture(page, "failures", { fullPage: true });
  await leave(page);
});

test("the table says why jobs failed although the service was away, and anew when they have been retried", async () => {
  const rows = [{ job_id: "job_1", state: "failed", clearance_mm: 0.2, [metric]: null }];
  const failures = [{ job_id: "job_1", error_reason: "step_limit", error_detail: "too many steps" }];
  const page = await visitRows(["clearance_mm"], rows, { failures, isUnreachable: true });
  await page.getByText("The service does not answer. Trying again …").waitFor();
  await page.unroute(reasons);
  await page.getByRole("cell", { name: "failed: step_limit too many steps" }).waitFor();
  await page.route("**/v1/sweeps/swp_given/retry", (route) => route.fulfill({ json: {} }));
  failures[0] = { job_id: "job_1", error_reason: "time_limit", error_detail: "too slow" };
  await page.getByRole("button", { name: "Retry" }).click();
  await page.getByRole("cell", { name: "failed: time_limit too slow" }).waitFor();
  await leave(page, /ERR_FAILED/);
});

test("a retry that was made elsewhere is followed", async () => {
  const rows = [{ job_id: "job_1", state: "failed", clearance_mm: 0.2, [metric]: null }];
  const failures = [{ job_id: "job_1", error_reason: "step_limit", error_detail: "too many steps" }];
  const more = { ended_at: "2026-01-01T00:00:00Z" };
  const page = await visitRows(["clearance_mm"], rows, { failures, more });
  await page.getByRole("cell", { name: "failed: step_limit too many steps" }).waitFor();
  failures[0] = { job_id: "job_1", error_reason: "time_limit", error_detail: "too slow" };
  more.ended_at = "2026-01-01T00:01:00Z";
  await page.getByRole("cell", { name: "failed: time_limit too slow" }).waitFor({ timeout: 20_000 });
  await leave(page);
});

test("the page of a sweep does without the schema of the parameters", async () => {
  const page = await visitRows(["clearance_mm"], [0.1, 0.2].map((clearance, k) => row(k, { clearance_mm: clearance, [metric]: k === 0 ? 1 : null })), { isSchemaGone: true });
  await page.getByText(/^1 computed job without a value of Peak slider acceleration/).waitFor();
  await leave(page, /ERR_FAILED/);
});
