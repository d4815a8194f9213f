// SPDX-License-Identifier: Apache-2.0
// Places of parts: panels and their titles, frames, round circles, ends of axes, the header, wide windows.
//   node layout.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { drawn, metric, row, visitRows } from "./given.mjs";
import { ask, endVisits, expectAccessible, expectNoSideways, leave, picture, resultsOf, runSweep, url, visit } from "./visitor.mjs";

after(endVisits);
const axes = ["crank_velocity_rad_s", "coupler", "clearance_mm"];
const rows = Array.from({ length: 10 }, (_, k) => 4 + k).flatMap((velocity) => ["rigid", "flexible"].flatMap((coupler) =>
  Array.from({ length: 12 }, (_, k) => row(`${velocity}_${coupler}_${k}`, { crank_velocity_rad_s: velocity, coupler, clearance_mm: k / 7, [metric]: velocity + k }))));

/** Boxes of the panels of the heat map and of their titles, in pixels of the chart. */
function panels(page) {
  return page.locator(".chart").first().evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    const chart = getInstanceByDom(element);
    const grids = chart.getModel().queryComponents({ mainType: "grid" }).map(({ coordinateSystem }) => ({ ...coordinateSystem.getRect() }));
    const titles = chart.getModel().queryComponents({ mainType: "title" }).map((title) => {
      const { group } = chart.getViewOfComponentModel(title);
      const { x, y, width, height } = group.getBoundingRect();
      return { text: title.option.text, x: group.x + x, y: group.y + y, width, height };
    });
    return { grids, titles: titles.slice(1), scale: titles[0], height: element.clientHeight };
  });
}

const overlap = (a, b) => a.x < b.x + b.width - 1 && b.x < a.x + a.width - 1 && a.y < b.y + b.height - 1 && b.y < a.y + a.height - 1;

test("twelve panels of a heat map have room, and no title lies over another or over a panel", async () => {
  for (const width of [390, 1280, 1920]) {
    const page = await visitRows(axes, rows, { query: "?x=crank_velocity_rad_s&y=coupler&panel=clearance_mm", width });
    await page.waitForTimeout(300);
    const { grids, titles, scale } = await panels(page);
    assert.equal(grids.length, 12);
    assert.ok(grids.every(({ height }) => height > 80), `${grids.map(({ height }) => height)}`);
    const boxes = [...titles, scale];
    for (const title of boxes) {
      assert.equal(boxes.filter((other) => overlap(title, other)).length, 1, `${title.text} at ${width}`);
      assert.ok(!grids.some((grid) => overlap(title, grid)), `${title.text} over a panel at ${width}`);
    }
    await expectNoSideways(page);
    await picture(page, `panels_${width}`, { fullPage: true });
    await leave(page);
  }
});

test("the frame of a selected cell lies above its neighbours", async () => {
  const page = await visitRows(axes, rows, { query: "?x=crank_velocity_rad_s&y=clearance_mm&panel=coupler&jobs=job_6_rigid_3" });
  const [cells] = (await drawn(page, 0)).series;
  assert.deepEqual(cells.map((cell) => Boolean(cell.itemStyle)).lastIndexOf(true), cells.length - 1);
  assert.equal(cells.filter((cell) => cell.itemStyle).length, 1);
  // A click on the cell still means its own job, although it is drawn in another place.
  await page.locator(".chart").first().evaluate(async (element) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    const chart = getInstanceByDom(element);
    const [x, y] = chart.convertToPixel({ seriesIndex: 0 }, [2, 3]);
    for (const type of ["mousedown", "mouseup", "click"]) chart.getZr().handler.dispatch(type, { zrX: x, zrY: y, offsetX: x, offsetY: y });
  });
  await page.getByText("1 job selected").waitFor({ state: "hidden" });
  await leave(page);
});

test("names of parallel axes stand whole, in lines that take no more than the gap", async () => {
  for (const width of [390, 1280]) {
    const page = await visitRows(axes, rows, { width });
    const { gap, names, widths } = await page.locator(".chart").nth(2).evaluate(async (element) => {
      const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
      const found = getInstanceByDom(element).getModel().queryComponents({ mainType: "parallelAxis" });
      const context = document.createElement("canvas").getContext("2d");
      context.font = "11px system-ui, sans-serif";
      const lines = found.map(({ option }) => option.name.split("\n"));
      return { gap: (element.clientWidth - 150) / (found.length - 1), names: lines.map((each) => each.join(" ")),
        widths: lines.flat().map((line) => context.measureText(line).width) };
    });
    assert.ok(names.includes("Crank velocity [rad/s]") && names.includes("Peak slider acceleration [m/s²]"), `${names}`);
    // ECharts cuts off what is wider.
    assert.ok(widths.every((each) => each <= gap), `${widths} of ${gap}`);
    await leave(page);
  }
});

test("a job's title is short, its section round, and its spectrum ends with the data", async () => {
  const sweep = await runSweep({ name: "odd velocity", parameters: { duration_s: 0.5, run_up_s: 0.1, clearance_mm: 0.25, crank_velocity_rad_s: 108 / 11 } });
  const [{ job_id: id }] = await resultsOf(sweep);
  const page = await visit(`#/jobs/${id}`);
  await page.getByRole("heading", { name: "rigid coupler, clearance 0.25 mm, 9.81818 rad/s", exact: true }).waitFor();
  await page.getByText("Spectrum and Poincaré section").click();
  await page.locator("details .chart canvas").nth(1).waitFor();
  const [spectrum, section] = await page.locator("details .chart").evaluateAll(async (elements) => {
    const { getInstanceByDom } = await (await import("/core/charts.js")).loadCharts();
    return elements.slice(0, 2).map((element) => {
      const chart = getInstanceByDom(element);
      const [[x0, y0], [x1, y1]] = [[0, 0], [0.1, 0.1]].map((point) => chart.convertToPixel({ gridIndex: 0 }, point));
      return { end: chart.getModel().getComponent("xAxis").axis.scale.getExtent()[1], last: chart.getModel().getSeriesByIndex(0).option.data.at(-1)[0], along: x1 - x0, upwards: y0 - y1 };
    });
  });
  assert.equal(spectrum.end, spectrum.last);
  assert.ok(Math.abs(section.along / section.upwards - 1) < 0.02, `${section.along} by ${section.upwards}`);
  await expectAccessible(page);
  await picture(page, "section", { fullPage: true });
  await leave(page);
});

test("the header leads to help and to the interface, which leads back, in the dark, too", async () => {
  const page = await visit("#/wear", { colorScheme: "dark", viewport: { width: 390, height: 844 } });
  await page.getByRole("link", { name: "Help", exact: true }).click();
  await page.getByRole("heading", { name: "How to begin" }).waitFor();
  const { version } = await ask("/healthz");
  assert.match(version, /^\d+\.\d+\.\d+/);
  await page.getByText(`RPSUP ${version}`, { exact: true }).waitFor();
  await page.locator("header").getByText(version, { exact: true }).waitFor();
  assert.equal(await page.getByRole("link", { name: "Help", exact: true }).getAttribute("aria-current"), "page");
  assert.equal(await page.locator("header [aria-current]").count(), 1);
  await expectNoSideways(page);
  await expectAccessible(page);
  await picture(page, "help");
  await page.getByRole("link", { name: "API", exact: true }).click();
  await page.getByRole("heading", { name: /^RPSUP parameter studies/ }).waitFor();
  const ground = () => page.evaluate(() => getComputedStyle(document.querySelector(".swagger-ui")).backgroundColor);
  assert.equal(await ground(), "rgb(16, 20, 24)");
  await expectAccessible(page);
  await picture(page, "docs_dark");
  await page.getByRole("link", { name: "Back to RPSUP" }).click();
  await page.getByRole("heading", { name: "Sweeps" }).waitFor();
  // A theme that was chosen counts more than that of the system.
  await page.getByLabel("Theme").selectOption("light");
  await page.goto(`${url}/docs`);
  await page.getByRole("heading", { name: /^RPSUP parameter studies/ }).waitFor();
  assert.equal(await ground(), "rgb(246, 247, 249)");
  await page.locator("#operations-service-getHealth .opblock-summary-control").click();
  await page.getByRole("button", { name: "Execute" }).waitFor();
  await expectAccessible(page);
  await leave(page);
});

test("a wide window is used", async () => {
  const page = await visitRows(axes, rows, { width: 1920 });
  assert.ok((await page.locator("main").boundingBox()).width > 1850);
  await expectNoSideways(page);
  await picture(page, "wide");
  await leave(page);
});
