// SPDX-License-Identifier: Apache-2.0
// Speed of the dashboard with much to show. It is printed, not asserted, for it is the machine's speed too.
//   node speed.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { ask, endVisits, leave, picture, resultsOf, runSweep, visit } from "./visitor.mjs";

after(endVisits);
const tries = 5;

/** The mean and the slowest twentieth of the time between frames [ms] while a plot is moved at each frame. */
function framesOfPanning(page, milliseconds) {
  return page.evaluate(async (length) => {
    const plot = document.querySelectorAll(".uplot .u-over")[1];
    const stamps = [];
    for (const end = performance.now() + length; performance.now() < end;) {
      stamps.push(await new Promise(requestAnimationFrame));
      plot.dispatchEvent(new WheelEvent("wheel", { deltaX: 10, bubbles: true, cancelable: true }));
    }
    const gaps = stamps.slice(1).map((stamp, i) => stamp - stamps[i]).sort((a, b) => a - b);
    return { mean: gaps.reduce((sum, gap) => sum + gap, 0) / gaps.length, slow: gaps[Math.floor(0.95 * gaps.length)] };
  }, milliseconds);
}

test("a sweep of 10,000 jobs opens", { timeout: 600000 }, async (t) => {
  const sweep = await runSweep({ name: "ten thousand", parameters: { duration_s: 0.02, run_up_s: 0.01 }, sweep: {
    crank_velocity_rad_s: { from: 1, to: 20, count: 100 }, rod_stroke_mm: { from: 10, to: 60, count: 50 }, clearance_mm: [0, 0.1] } }, 500);
  const taken = [];
  for (let k = 0; k < tries; k += 1) {
    const page = await visit("");
    await page.getByText("10,000 succeeded").waitFor();
    await page.waitForLoadState("networkidle");
    // From the click to the table, the heat map and the lines on the screen.
    taken.push(await page.evaluate(async (address) => {
      const start = performance.now();
      location.hash = address;
      const drawn = (n) => document.querySelectorAll(".chart")[n]?.querySelector("canvas");
      while (!(document.querySelectorAll("tbody tr[aria-rowindex]").length >= 16 && drawn(0) && drawn(1))) await new Promise(requestAnimationFrame);
      await new Promise(requestAnimationFrame);
      return performance.now() - start;
    }, `#/sweeps/${sweep.id}`));
    if (k === 0) {
      await page.waitForTimeout(2000);
      await picture(page, "ten_thousand");
    }
    await leave(page);
  }
  t.diagnostic(`opened within ${taken.map((time) => time.toFixed(0)).join(", ")} ms`);
});

/** Steps of a scroll through a table: the mean and the slowest twentieth of the time between frames [ms], and the rows that had been drawn at the most. */
function framesOfScrolling(page, milliseconds) {
  return page.getByRole("region", { name: "Results" }).evaluate(async (region, length) => {
    const stamps = [];
    let rows = 0;
    for (const end = performance.now() + length; performance.now() < end;) {
      stamps.push(await new Promise(requestAnimationFrame));
      region.scrollTop += 120;
      rows = Math.max(rows, region.querySelectorAll("tr[aria-rowindex]").length);
    }
    const gaps = stamps.slice(1).map((stamp, i) => stamp - stamps[i]).sort((a, b) => a - b);
    return { mean: gaps.reduce((sum, gap) => sum + gap, 0) / gaps.length, slow: gaps[Math.floor(0.95 * gaps.length)], rows, cells: region.querySelectorAll("thead th").length * 10000 };
  }, milliseconds);
}

test("the table of 10,000 jobs scrolls", { timeout: 600000 }, async (t) => {
  const { items } = await ask("/v1/sweeps");
  const sweep = items.find(({ name }) => name === "ten thousand");
  const page = await visit(`#/sweeps/${sweep.id}`);
  await page.locator("tr[aria-rowindex='2']").waitFor();
  await page.waitForTimeout(2000);
  await page.getByRole("region", { name: "Results" }).scrollIntoViewIfNeeded();
  for (let k = 0; k < tries; k += 1) {
    const { mean, slow, rows, cells } = await framesOfScrolling(page, 2000);
    assert.ok(rows < 100, `${rows} rows drawn at once`);
    t.diagnostic(`${cells.toLocaleString("en")} cells scrolled at ${(1000 / mean).toFixed(1)} frames a second, one frame in twenty slower than at ${(1000 / slow).toFixed(1)}`);
  }
  await picture(page, "scrolled");
  await leave(page);
});

test("a trajectory of 500,000 samples pans", { timeout: 300000 }, async (t) => {
  const sweep = await runSweep({ name: "many samples", parameters: { clearance_mm: 0.25, duration_s: 5, output_rate_hz: 100000 } }, 200);
  const [{ job_id: id }] = await resultsOf(sweep);
  assert.equal((await ask(`/v1/jobs/${id}/trajectory?channels=t_s`)).columns.t_s.length, 500001);
  const page = await visit(`#/jobs/${id}?from=2&to=2.5`);
  await page.locator("canvas.scene[data-instant]").waitFor();
  await page.locator("canvas.orbit[data-samples]").waitFor();
  await page.waitForTimeout(1000);
  const energy = page.locator('[aria-label^="Energy balance"] canvas');
  const before = await energy.evaluate((plot) => plot.toDataURL());
  for (let k = 0; k < tries; k += 1) {
    const { mean, slow } = await framesOfPanning(page, 2000);
    t.diagnostic(`panned at ${(1000 / mean).toFixed(1)} frames a second, one frame in twenty slower than at ${(1000 / slow).toFixed(1)}`);
  }
  await picture(page, "panned");
  await page.waitForFunction(() => Number(new URLSearchParams(location.hash.split("?")[1]).get("from")) > 2.1);
  // A plot that was out of sight follows as soon as it is seen.
  await energy.scrollIntoViewIfNeeded();
  await page.waitForFunction(([plot, image]) => plot.toDataURL() !== image, [await energy.elementHandle(), before]);
  await leave(page);
});
