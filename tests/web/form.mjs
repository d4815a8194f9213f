// SPDX-License-Identifier: Apache-2.0
// Text that people type into a form: empty and faulty fields, decimal commas, units of entry.
//   node form.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { endVisits, expectAccessible, expectNoSideways, leave, picture, visit } from "./visitor.mjs";

after(endVisits);
const shown = async (page) => JSON.parse(await page.locator("aside pre").first().textContent());
const row = (page, path) => page.locator(`[data-path="${path}"]`);
const submit = (page) => page.getByRole("button", { name: "Submit" });

test("an axis with an empty or faulty field says why, and keeps the form from being sent", async () => {
  const page = await visit("#/new");
  const kind = page.getByLabel("Clearance: kind of value", { exact: true });
  assert.ok(await submit(page).isEnabled());
  await kind.selectOption("list");
  await row(page, "clearance_mm").getByText("the list is empty: write values such as 0, 0.1, 0.2, or choose “one value”").waitFor();
  assert.ok(await submit(page).isDisabled());
  await page.getByText("Not ready to submit: see Clearance.", { exact: true }).waitFor();
  await expectAccessible(page);
  await picture(page, "empty_axis");
  await kind.selectOption("range");
  await row(page, "clearance_mm").getByText("“from” and “to” are empty").waitFor();
  await page.getByLabel("Clearance: from", { exact: true }).fill("0,1");
  await row(page, "clearance_mm").getByText("“to” is empty: write a number").waitFor();
  await page.getByLabel("Clearance: to", { exact: true }).fill("0.4");
  await page.getByLabel("Clearance: count", { exact: true }).fill("");
  await row(page, "clearance_mm").getByText("the count of a range is a whole number from 1").waitFor();
  assert.ok(await submit(page).isDisabled());
  await page.getByLabel("Clearance: count", { exact: true }).fill("4");
  assert.ok(await submit(page).isEnabled());
  assert.deepEqual((await shown(page)).sweep, { clearance_mm: { from: 0.1, to: 0.4, count: 4 } });
  await page.getByLabel("Duration", { exact: true }).fill("long");
  await page.getByText("Not ready to submit: see Duration.", { exact: true }).waitFor();
  await page.getByLabel("Duration", { exact: true }).fill("");
  assert.ok(await submit(page).isEnabled());
  await leave(page);
});

test("a decimal comma is understood, or named where it may be another comma", async () => {
  const page = await visit("#/new");
  await page.getByLabel("Clearance", { exact: true }).fill("0,25");
  assert.deepEqual((await shown(page)).parameters, { clearance_mm: 0.25 });
  await page.getByLabel("Clearance", { exact: true }).fill("1,200");
  await row(page, "clearance_mm").getByText("“1,200” may be 1.2 or 1200: write one of these").waitFor();
  await page.getByLabel("Clearance", { exact: true }).fill("0,25");
  await page.getByLabel("Clearance: kind of value", { exact: true }).selectOption("list");
  await row(page, "clearance_mm").getByText("“0,25” may be one number or two: write 0.25, or 0; 25").waitFor();
  await page.getByLabel("Clearance", { exact: true }).fill("2,5e-1 3,5e-1");
  await row(page, "clearance_mm").getByText("“2,5e-1” may be one number or two: write 2.5e-1, or 2; 5e-1").waitFor();
  for (const [text, values] of [["0,25; 0,5", [0.25, 0.5]], ["0, 0.25", [0, 0.25]], ["0.1,0.2", [0.1, 0.2]], ["0,1,2", [0, 1, 2]], ["0.1 0.2", [0.1, 0.2]], ["0.1;0.2;", [0.1, 0.2]], ["1e-1,2", [0.1, 2]], ["2,5e-1; 3,5e-1", [0.25, 0.35]]]) {
    await page.getByLabel("Clearance", { exact: true }).fill(text);
    assert.deepEqual((await shown(page)).sweep, { clearance_mm: values }, text);
  }
  await page.goto(page.url().replace("#/new", "#/searches/new?empty=1"));
  await page.getByLabel("Bound [m/s²]", { exact: true }).fill("1,5");
  assert.equal((await shown(page)).bound, 1.5);
  await leave(page);
});

test("a form is emptied where its address is that of the empty one already", async () => {
  const page = await visit("#/new");
  await page.getByLabel("Clearance", { exact: true }).fill("0.25");
  await page.getByRole("link", { name: "Empty form" }).click();
  await page.waitForFunction(() => document.querySelector("[data-path='clearance_mm'] input")?.value === "");
  await leave(page);
});

test("an answer to a form that has been left is told, and opens no page", async () => {
  const page = await visit("#/new");
  const refusal = { status: 422, contentType: "application/problem+json", body: '{"detail": "too many jobs"}' };
  for (const [answer, told] of [[{ status: 201, json: { id: "swp_given" } }, "Submitted: swp_given"], [refusal, "too many jobs"]]) {
    const held = [];
    await page.route("**/v1/sweeps", (route) => held.push(route));
    await page.evaluate(() => { location.hash = "#/new"; });
    await submit(page).click();
    while (held.length === 0) await page.waitForTimeout(50);
    await page.evaluate(() => { location.hash = "#/help"; });
    await page.getByRole("heading", { level: 1, name: "Help" }).waitFor();
    await held[0].fulfill(answer);
    await page.getByText(told, { exact: true }).waitFor();
    assert.match(page.url(), /#\/help$/);
    await page.unroute("**/v1/sweeps");
  }
  await leave(page, /422/);
});

test("values with replicates follow the axes", async () => {
  const page = await visit("#/new?template=paper");
  await page.getByText("40 jobs", { exact: true }).waitFor();
  await page.getByLabel("Crank velocity", { exact: true }).fill("5, 8");
  await page.getByRole("alert").getByText("/replicates/only").waitFor();
  const only = page.getByLabel("Values with replicates (JSON; empty: all)");
  await only.fill('{"clearance_mm": 0.25');
  await page.getByRole("alert").getByText("only: must be a JSON object of lists").waitFor();
  await only.fill('{"clearance_mm": [0.25]}');
  // Four replicates more of the rigid and the flexible coupler at both velocities.
  await page.getByText(`${3 * 2 * 2 + 4 * 2 * 2} jobs`, { exact: true }).waitFor();
  assert.deepEqual((await shown(page)).replicates.only, { clearance_mm: [0.25] });
  await leave(page, /422/);
});

test("velocities are entered in rpm and angles in degrees", async () => {
  const page = await visit("#/new");
  const velocity = page.getByLabel("Crank velocity", { exact: true });
  await velocity.fill("30");
  await page.getByLabel("Crank velocity: unit").selectOption("rpm");
  // The number in the field keeps its meaning: 30 rad/s are 900/π rpm.
  assert.ok(Math.abs(Number(await velocity.inputValue()) * Math.PI / 900 - 1) < 1e-10);
  assert.equal((await shown(page)).parameters.crank_velocity_rad_s, 30);
  // With a decimal comma, too.
  await velocity.fill("10,5");
  await page.getByLabel("Crank velocity: unit").selectOption("rad/s");
  await page.getByLabel("Crank velocity: unit").selectOption("rpm");
  assert.ok(Math.abs((await shown(page)).parameters.crank_velocity_rad_s / (10.5 * Math.PI / 30) - 1) < 1e-10);
  await velocity.fill("120");
  assert.ok(Math.abs((await shown(page)).parameters.crank_velocity_rad_s / (4 * Math.PI) - 1) < 1e-11);
  await page.getByLabel("Crank velocity: kind of value").selectOption("list");
  await velocity.fill("60, 120");
  const { sweep } = await shown(page);
  assert.ok(sweep.crank_velocity_rad_s.every((value, k) => Math.abs(value / (2 * Math.PI * (k + 1)) - 1) < 1e-11));
  await page.getByLabel("Crank velocity: kind of value").selectOption("range");
  await page.getByLabel("Crank velocity: from").fill("60");
  await page.getByLabel("Crank velocity: to").fill("180");
  assert.ok(Math.abs((await shown(page)).sweep.crank_velocity_rad_s.to / (6 * Math.PI) - 1) < 1e-11);
  await page.getByText("All other parameters").click();
  await page.getByLabel("Crank start: unit").selectOption("°");
  await page.getByLabel("Crank start", { exact: true }).fill("90");
  assert.ok(Math.abs((await shown(page)).parameters.crank_start_rad / (Math.PI / 2) - 1) < 1e-11);
  await expectAccessible(page);
  await picture(page, "units");
  for (const width of [390, 1920]) {
    await page.setViewportSize({ width, height: 900 });
    await expectNoSideways(page);
    await picture(page, `units_${width}`);
  }
  await leave(page);
});
