// SPDX-License-Identifier: Apache-2.0
// The table of a sweep: ten thousand rows, of which those that are seen are drawn; filters, order, columns.   node table.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { drawn as chartOf, force, metric, row, visitRows } from "./given.mjs";
import { endVisits, expectAccessible, leave, picture, visit } from "./visitor.mjs";

after(endVisits);
const many = Array.from({ length: 10000 }, (_, k) => row(String(k).padStart(5, "0"), { clearance_mm: Math.floor(k / 2) / 100, coupler: k % 2 ? "flexible" : "rigid",
  [metric]: (k * 7919) % 10000, [force]: k + 1, ...Object.fromEntries(Array.from({ length: 8 }, (__, i) => [`count_${i}`, k + i])) }));
const region = (page) => page.getByRole("region", { name: "Results" });

/** Places of the rows that are drawn, from 0. */
const places = (page) => page.locator("tr[aria-rowindex]").evaluateAll((rows) => rows.map((each) => Number(each.getAttribute("aria-rowindex")) - 2));

/** Texts of the cells below a heading, of the rows that are drawn. */
const column = (page, heading) => region(page).evaluate((element, text) => {
  const place = [...element.querySelectorAll("thead tr:first-child th")].findIndex((cell) => cell.textContent.startsWith(text));
  return [...element.querySelectorAll("tr[aria-rowindex]")].map((each) => each.cells[place].textContent);
}, heading);

test("of ten thousand rows those that are seen are drawn, below a heading that stays", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], many);
  const drawn = await places(page);
  assert.ok(drawn.length < 100 && drawn[0] === 0, `${drawn.length} rows from ${drawn[0]} on`);
  assert.equal(await page.locator("table.rows").getAttribute("aria-rowcount"), "10001");
  await region(page).scrollIntoViewIfNeeded();
  const head = await page.locator("thead").boundingBox();
  const widths = () => page.locator("thead tr:first-child th").evaluateAll((cells) => cells.map((cell) => cell.offsetWidth));
  const before = await widths();
  await region(page).evaluate((element) => { element.scrollTop = 5000 * 36; });
  await page.locator("tr[aria-rowindex='5002']").waitFor();
  assert.equal((await page.locator("thead").boundingBox()).y, head.y);
  assert.deepEqual(await widths(), before, "no column moves");
  // Right below the heading is the row of the place that was scrolled to.
  const top = await page.locator("tr[aria-rowindex='5002']").boundingBox();
  assert.ok(Math.abs(top.y - head.y - head.height) < 2, `row 5,000 at ${top.y}, the heading down to ${head.y + head.height}`);
  await region(page).evaluate((element) => { element.scrollTop = element.scrollHeight; });
  await page.locator("tr[aria-rowindex='10001']").waitFor();
  assert.ok((await places(page)).length < 100);
  await expectAccessible(page);
  await picture(page, "table_end");
  await leave(page);
});

test("of many rows the columns that are seen are drawn, each below its heading", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], many, { width: 700 });
  const last = "Count 7";
  const cells = () => region(page).locator("tr[aria-rowindex='3'] td:not([aria-hidden])").count();
  assert.ok(await cells() < 13, `${await cells()} cells in a row`);
  assert.equal(await page.locator("table.rows").getAttribute("aria-colcount"), "15");
  await region(page).evaluate((element) => { element.scrollLeft = element.scrollWidth; });
  const cell = page.locator("tr[aria-rowindex='3'] td[aria-colindex='15']");
  await cell.waitFor();
  assert.equal(await cell.textContent(), "8");
  const [place, heading] = await Promise.all([cell.boundingBox(), page.locator("thead th", { hasText: last }).boundingBox()]);
  assert.ok(Math.abs(place.x - heading.x) < 1, `the cell at ${place.x}, its heading at ${heading.x}`);
  await leave(page);
});

test("after a jump the rows around what is seen follow", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], many);
  await region(page).evaluate((element) => { element.scrollTop = 7000 * 36; });
  await page.locator("tr[aria-rowindex='7002']").waitFor();
  await page.locator("tr[aria-rowindex='6996']").waitFor();
  await leave(page);
});

test("many jobs: the name stands before the rows, and a chart is drawn once it is near", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], many);
  const scatter = page.locator(".chart").nth(3);
  assert.equal(await scatter.locator("canvas").count(), 0);
  await scatter.scrollIntoViewIfNeeded();
  await scatter.locator("canvas").first().waitFor();
  // So many points are small and clear, in a shape for each class of their colours.
  const looks = await scatter.evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    return getInstanceByDom(element).getModel().getSeries().map(({ option }) => [option.large, option.symbolSize, option.itemStyle.opacity, option.data.length]);
  });
  assert.equal(looks.length, 16);
  assert.ok(looks.every(([large, size, opacity]) => large && size <= 3 && opacity < 0.5), `${looks}`);
  assert.equal(looks.reduce((sum, [,,, count]) => sum + count, 0), 10000);
  // A selection in the table draws it anew when it is seen again.
  const rings = () => chartOf(page, 3).then(({ series }) => series.at(-1).length);
  await region(page).evaluate((element) => { element.scrollIntoView(); });
  await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
  await page.getByRole("checkbox", { name: "Select job_00001" }).check();
  await scatter.scrollIntoViewIfNeeded();
  while (await rings() !== 1) await page.waitForTimeout(50);
  await page.route("**/v1/sweeps/swp_given/results**", () => {});
  await page.reload();
  await page.getByRole("heading", { name: "given" }).waitFor();
  await page.getByText("Loading 10,000 jobs …").waitFor();
  await leave(page);
});

test("a selection leaves the table where it is, and the focus in its box", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], many);
  const top = () => region(page).evaluate(({ scrollTop }) => scrollTop);
  await region(page).evaluate((element) => { element.scrollTop = 5000 * 36; });
  const box = page.getByRole("checkbox", { name: "Select job_05005" });
  await box.focus();
  const before = await top();
  await page.keyboard.press("Space");
  await page.getByText("1 job selected").waitFor();
  assert.deepEqual([before > 4000 * 36, await top()], [true, before]);
  assert.ok(await box.evaluate((element) => element === document.activeElement && element.checked));
  await leave(page);
});

test("rows are sorted and filtered, and a faulty filter says how one is written", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], many);
  await page.getByRole("button", { name: /^Peak slider acceleration \[/ }).click();
  await page.getByRole("button", { name: /^Peak slider acceleration \[.*▲/ }).click();
  assert.deepEqual((await column(page, "Peak slider acceleration")).slice(0, 3), ["9999", "9998", "9997"]);
  await page.getByRole("button", { name: "Filter" }).click();
  const filter = (name) => page.getByRole("textbox", { name: `Filter ${name}` });
  await filter("Clearance").fill("0,1 .. 0.2");
  await page.getByText("22 of 10,000 jobs", { exact: true }).waitFor();
  await filter("Coupler").fill("flex");
  await page.getByText("11 of 10,000 jobs", { exact: true }).waitFor();
  assert.equal(await filter("Coupler").evaluate((element) => element === document.activeElement), true, "the field keeps the focus");
  assert.deepEqual([...new Set(await column(page, "Coupler"))], ["flexible"]);
  await filter("Peak contact force").fill("> 30");
  await page.getByText("6 of 10,000 jobs", { exact: true }).waitFor();
  await filter("Peak contact force").fill("more");
  await page.getByText("“more” is no filter of numbers: write 5, > 5, ≤ 5 or 5 .. 10").waitFor();
  await page.getByText("11 of 10,000 jobs", { exact: true }).waitFor();
  await filter("Peak contact force").fill("> 1,000");
  await page.getByText("“1,000” may be 1 or 1000: write one of these").waitFor();
  await expectAccessible(page);
  await picture(page, "table_filtered");
  await page.getByRole("button", { name: "Filter" }).click();
  await page.getByText("10,000 jobs", { exact: true }).last().waitFor();
  await leave(page);
});

test("filters take what people write", async () => {
  const page = await visit("#/wear");
  const passed = await page.evaluate(async () => {
    const { filterOf } = await import("/study/row_filter.js");
    const rows = [-1, 0.25, 5, 10].map((x) => ({ x }));
    return ["5", "=5", "> 0,25", "≥0.25", "<=0.25", "−1 .. 5", "0.25 to 10", " ", "> 2,5e-1"].map((text) => {
      const passes = filterOf("x", text, true);
      return passes ? rows.filter(passes).map(({ x }) => x) : null;
    });
  });
  assert.deepEqual(passed, [[5], [5], [5, 10], [0.25, 5, 10], [-1, 0.25], [-1, 0.25, 5], [0.25, 5, 10], null, [5, 10]]);
  await leave(page);
});

test("the columns are chosen", async () => {
  const page = await visitRows(["clearance_mm", "coupler"], many);
  await page.getByText("Columns: 13 of 13").click();
  await page.getByRole("checkbox", { name: "Count 3", exact: true }).uncheck();
  await page.getByText("Columns: 12 of 13").waitFor();
  assert.equal(await page.getByRole("button", { name: "Count 3" }).count(), 0);
  // The filter of a column counts as long as it is seen.
  await page.getByRole("button", { name: "Filter" }).click();
  await page.getByRole("textbox", { name: "Filter Coupler" }).fill("flex");
  await page.getByText("5,000 of 10,000 jobs", { exact: true }).waitFor();
  await page.getByRole("checkbox", { name: "Coupler", exact: true }).uncheck();
  await page.getByText("5,000 of 10,000 jobs", { exact: true }).waitFor({ state: "hidden" });
  await page.getByRole("checkbox", { name: "Coupler", exact: true }).check();
  await page.getByText("5,000 of 10,000 jobs", { exact: true }).waitFor();
  await page.getByRole("button", { name: "Filter" }).click();
  await page.getByRole("button", { name: "None", exact: true }).click();
  await page.getByText("Columns: 1 of 13").waitFor();
  await page.getByRole("checkbox", { name: "Peak contact force [N]", exact: true }).check();
  assert.deepEqual((await column(page, "Peak contact force")).slice(0, 2), ["1", "2"]);
  await expectAccessible(page);
  await picture(page, "columns_chosen");
  await page.getByRole("button", { name: "All", exact: true }).click();
  await page.getByText("Columns: 13 of 13").waitFor();
  await leave(page);
});
