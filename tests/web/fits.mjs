// SPDX-License-Identifier: Apache-2.0
// From a measurement to a fit, and from a sweep to an optimisation.   node fits.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { ask, endVisits, expectAccessible, expectNoSideways, leave, picture, runSweep, url,
  visit } from "./visitor.mjs";

after(endVisits);
const minutes = 60000;
const clearance = 0.21;
const rig = { duration_s: 0.6, run_up_s: 0.2, crank_velocity_rad_s: 12 };
const phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
let measurement = "";

/** Simulates the rig: its signal as CSV with a sensor's noise, in a column that no channel is called. */
async function measure() {
  const [{ job_id: id }] = await ask(`/v1/sweeps/${(await runSweep({ name: "rig", parameters: rig,
    sweep: { clearance_mm: [clearance] } })).id}/results`);
  const { columns } = await ask(`/v1/jobs/${id}/trajectory?channels=t_s,slider_acceleration_m_s2`);
  const noisy = columns.slider_acceleration_m_s2.map((value, index) =>
    value + 0.05 * Math.sin(index * index));
  return ["time,acc", ...columns.t_s.map((time, index) => `${time},${noisy[index]}`)].join("\n");
}

test("a measurement is looked at before it is sent, and faults stand at their channels", async () => {
  const csv = await measure();
  const page = await visit("#/measurements");
  await page.getByText("No measurements yet.").waitFor();
  await page.getByRole("link", { name: "New measurement" }).click();
  await page.getByLabel("Files").setInputFiles({ name: "rig.csv", mimeType: "text/csv",
    buffer: Buffer.from(csv) });
  await page.getByText("1 run, 1 channel, 601 samples in this run").waitFor();
  await page.locator(".chart canvas").waitFor();
  await page.getByRole("button", { name: "Upload" }).click();
  const column = page.getByRole("group", { name: "Column acc" });
  await column.getByText("must end in a unit").waitFor();
  await column.getByLabel("Channel of the column acc").fill("slider_acceleration_m_s2");
  await column.getByText("[m/s²]").waitFor();
  await column.getByText("must end in a unit").waitFor({ state: "hidden" });
  await expectAccessible(page);
  await picture(page, "measurement_new", { fullPage: true });
  await page.getByRole("button", { name: "Upload" }).click();
  await page.waitForURL(/#\/measurements\/mea_/);
  await page.getByRole("heading", { name: "rig.csv" }).waitFor();
  await page.locator(".uplot").waitFor();
  measurement = page.url().match(/mea_\w+/)[0];
  const kept = await ask(`/v1/measurements/${measurement}`);
  assert.deepEqual(kept.channels.map(({ name, column: from }) => [name, from]),
    [["slider_acceleration_m_s2", "acc"]]);
  await expectAccessible(page);
  await picture(page, "measurement", { fullPage: true });
  // The same as NPZ, twice: two runs.
  const npz = await (await fetch(`${url}/v1/measurements/${measurement}/data?format=npz`)).arrayBuffer();
  const file = (name) => ({ name, mimeType: "application/octet-stream", buffer: Buffer.from(npz) });
  await page.goto(`${url}/#/measurements/new`);
  await page.getByLabel("Files").setInputFiles([file("a.npz"), file("b.npz")]);
  await page.getByText("2 runs, 1 channel, 601 samples in this run").waitFor();
  await page.getByText("Known parameters of the runs").click();
  await page.getByLabel("b.npz: JSON object").fill("{\"crank_velocity_rad_s\": 1e6}");
  await page.getByRole("button", { name: "Upload" }).click();
  await page.getByText(/^must be a number in/).waitFor();
  await leave(page, /422/);
});

test("cells in quotes are read as the service reads them", async () => {
  const page = await visit("#/measurements/new");
  const csv = '"time [s]","acc, ""x""" , plain\r\n"0","1.5",-1\n0.1,"",""\n';
  const columns = await page.evaluate(async (text) => {
    const { readFiles } = await import("/measure/read_files.js");
    const { runs } = await readFiles([new File([text], "quoted.csv")]);
    return Object.entries(runs[0].columns).map(([name, values]) => [name, values.map(String)]);
  }, csv);
  assert.deepEqual(columns, [["time [s]", ["0", "0.1"]], ['acc, "x"', ["1.5", "NaN"]], ["plain", ["-1", "NaN"]]]);
  await leave(page);
});

test("the numbers of a sensor are read as people type them, or named where they are none", async () => {
  const page = await visit("#/measurements/new");
  const read = await page.evaluate(async () => {
    const { faultsOf, sensorOf } = await import("/measure/measurement_request.js");
    const usual = { column: "acc", source: "acc", name: "x_m", isUsed: true, sign: "1", gain: "1", offset: "0", delay_s: "0", low_pass_hz: "" };
    return [{ gain: "" }, { sign: "−1", gain: "0,5" }, { delay_s: "late" }, { gain: "1,200" }].map((typed) => {
      const entry = { ...usual, ...typed };
      const { sign, gain } = sensorOf(entry);
      return [sign, String(gain), faultsOf({ channels: [entry], time: "t" }).map(([, fault]) => fault).join()];
    });
  });
  assert.deepEqual(read, [[1, "1", ""], [-1, "0.5", ""], [1, "1", "Delay: must be a number"],
    [1, "NaN", "Gain: “1,200” may be 1.2 or 1200: write one of these"]]);
  await leave(page);
});

test("the files that were chosen last are uploaded, and the run that is drawn stays chosen", async () => {
  const page = await visit("#/measurements/new");
  const csv = (name, times) => ({ name, mimeType: "text/csv",
    buffer: Buffer.from(["time_s,t_2_s,acc", ...times.map((time) => `${time},${2 * time},1`)].join("\n")) });
  await page.evaluate(() => {
    const { text } = Blob.prototype;
    Blob.prototype.text = async function () {
      if (this.name === "large.csv") await new Promise((resolve) => { window.letGo = resolve; });
      return text.call(this);
    };
  });
  const files = page.getByLabel("Files");
  await files.setInputFiles(csv("large.csv", [0, 1, 2, 3]));
  await page.waitForFunction(() => window.letGo);
  await files.setInputFiles([csv("a.csv", [0, 1]), csv("b.csv", [0, 1, 2])]);
  await page.getByText("2 runs, 2 channels, 2 samples in this run").waitFor();
  await page.evaluate(() => window.letGo());
  await page.waitForTimeout(500);
  await page.getByRole("combobox", { name: /^Run/ }).selectOption("1");
  await page.getByText("2 runs, 2 channels, 3 samples in this run").waitFor();
  await page.getByRole("combobox", { name: /^Time/ }).selectOption("t_2_s");
  assert.equal(await page.getByRole("combobox", { name: /^Run/ }).inputValue(), "1");
  assert.equal(await page.getByLabel("Name", { exact: true }).inputValue(), "a.csv");
  await leave(page);
});

test("a fit finds the clearance of a measurement", { timeout: 5 * minutes }, async () => {
  const page = await visit(`#/measurements/${measurement}`);
  await page.getByRole("link", { name: "Fit", exact: true }).click();
  const variable = page.getByRole("group", { name: "Variable 1" });
  await variable.getByLabel("From").fill("0.5");
  await variable.getByLabel("To").fill("0.1");
  await page.getByLabel("Fitted windows [s]").fill("0.2 to 0.5");
  await page.getByLabel("Windows held back [s]").fill("0.5 to 0.6");
  await page.getByLabel("Population").fill("5");
  await page.getByLabel("Budget").fill("40");
  await page.locator("[data-path=crank_velocity_rad_s]").getByRole("textbox").fill("12");
  await page.locator("[data-path=run_up_s]").getByRole("textbox").fill("0.2");
  await page.getByRole("button", { name: "Submit" }).click();
  await variable.getByText("must be above from").waitFor();
  await expectAccessible(page);
  await picture(page, "fit_form", { fullPage: true });
  await variable.getByLabel("From").fill("0.1");
  await variable.getByLabel("To").fill("0.4");
  // The end is told only with the answer, however late that comes.
  await page.route(/\/v1\/fits\/fit_\w+$/, async (route) => {
    await new Promise((resolve) => { setTimeout(resolve, 500); });
    await route.continue();
  });
  await page.getByRole("button", { name: "Submit" }).click();
  await page.waitForURL(/#\/fits\/fit_/);
  await page.getByText(/^(running: .*; [1-9]\d* points?$|succeeded)/).waitFor();
  await page.getByText(/^succeeded: 100 %/).waitFor({ timeout: 4 * minutes });
  const row = page.getByRole("row").filter({ has: page.locator(".interval") });
  assert.match(await row.getByRole("cell").nth(4).textContent(), /\d to \d/);
  const id = page.url().match(/fit_\w+/)[0];
  const fit = await ask(`/v1/fits/${id}`);
  const found = Number(await row.getByRole("cell").nth(1).textContent());
  assert.ok(Math.abs(found / fit.parameters[0].value - 1) < 1e-4,
    `${found} instead of ${fit.parameters[0].value}`);
  assert.ok(Math.abs(found / clearance - 1) < 0.05, `a clearance of ${found} mm instead of ${clearance}`);
  await page.getByText(/^Slider acceleration: what is held back is predicted with an error of/).waitFor();
  await page.locator(".chart canvas").nth(2).waitFor();
  await page.getByRole("combobox", { name: "Parameter" }).selectOption("clearance_mm");
  await expectAccessible(page);
  await picture(page, "fit", { fullPage: true });
  await page.getByRole("link", { name: "Best job" }).click();
  await page.getByText("measured: rig.csv").waitFor();
  await page.getByRole("combobox", { name: "Overlay measurement" }).selectOption(measurement);
  await page.getByLabel("Shift [s]").fill("later");
  await page.getByRole("button", { name: "Lay over" }).click();
  await page.getByText("Shift: must be a number", { exact: true }).waitFor();
  await page.getByLabel("Shift [s]").fill("0,01");
  await page.getByRole("button", { name: "Lay over" }).click();
  await page.waitForURL((address) => decodeURIComponent(address.href).includes(":slider_acceleration_m_s2:0.01"));
  await page.getByText("measured: rig.csv").nth(1).waitFor();
  await page.getByRole("link", { name: "without them" }).click();
  await page.getByText("measured: rig.csv").first().waitFor({ state: "detached" });
  const list = await visit("#/fits", phone);
  await list.getByText(/^Clearance 0\.2/).waitFor();
  await expectNoSideways(list);
  await list.goto(`${url}/#/fits/${id}`);
  await list.locator(".interval").waitFor();
  await expectNoSideways(list);
  await picture(list, "phone_fit", { fullPage: true });
  await leave(list);
  await leave(page, /422/);
});

test("a measurement is kept as long as a fit uses it", async () => {
  const page = await visit("#/measurements");
  const answer = (action) => page.getByRole("dialog").getByRole("button", { name: action }).click();
  await page.getByRole("button", { name: "Delete rig.csv" }).click();
  await answer("Delete");
  await page.getByRole("alert").getByText("the measurement is used by the fit").waitFor();
  await page.getByRole("link", { name: "Open the fit" }).click();
  await page.getByRole("button", { name: "Delete" }).click();
  await answer("Delete");
  await page.getByText("No fits yet.").waitFor();
  await page.getByRole("link", { name: "Measurements" }).click();
  await page.getByRole("button", { name: "Delete rig.csv" }).click();
  await answer("Delete");
  await page.getByText("No measurements yet.").waitFor();
  await leave(page, /409/);
});

test("an optimisation begins with a sweep, and its front is selected in all parts", { timeout: 5 * minutes },
  async () => {
  const sweep = await runSweep({ name: "small", parameters: rig, sweep: { clearance_mm: [0.1, 0.4] } });
  const page = await visit(`#/sweeps/${sweep.id}?metric=peak_contact_force_n`);
  await page.getByRole("link", { name: "Optimise" }).click();
  const variable = page.getByRole("group", { name: "Variable 1" });
  assert.equal(await variable.getByLabel("Parameter").inputValue(), "clearance_mm");
  assert.equal(await variable.getByLabel("To").inputValue(), "0.4");
  const objective = (number) => page.getByRole("group", { name: `Objective ${number}` });
  assert.equal(await objective(1).getByLabel("Metric").inputValue(), "peak_contact_force_n");
  await page.getByRole("button", { name: "Add objective" }).click();
  await objective(2).getByLabel("Metric").fill("no_such_metric");
  await page.getByLabel("Budget").fill("16");
  await page.getByLabel("Population").fill("8");
  await page.getByRole("button", { name: "Submit" }).click();
  await objective(2).getByText("\"no_such_metric\": unknown key").waitFor();
  await expectAccessible(page);
  await picture(page, "optimisation_form", { fullPage: true });
  await objective(2).getByLabel("Metric").fill("peak_slider_acceleration_m_s2");
  await page.getByRole("button", { name: "Submit" }).click();
  await page.waitForURL(/#\/optimisations\/opt_/);
  await page.getByText(/^succeeded: 16 of at most 16 candidates; 16 feasible$/).waitFor({ timeout: 4 * minutes });
  const study = await ask(`/v1/optimisations/${page.url().match(/opt_\w+/)[0]}`);
  const count = study.front.length;
  await page.getByText(new RegExp(`^${count} candidates? on the Pareto front\\.$`)).waitFor();
  await page.locator(".chart canvas").nth(2).waitFor();
  await page.getByRole("button", { name: "Select the front" }).click();
  await page.getByText(new RegExp(`^${count} candidates? selected$`)).waitFor();
  assert.equal(await page.locator("tr.selected").count(), 2 * count);
  await expectAccessible(page);
  await picture(page, "optimisation", { fullPage: true });
  await page.getByRole("button", { name: "Clear selection" }).click();
  assert.equal(await page.locator("tr.selected").count(), 0);
  const list = await visit("");
  await list.getByRole("link", { name: "optimisation", exact: true }).click();
  await list.getByText(/on the Pareto front\.$/).waitFor();
  await leave(list);
  const small = await visit(page.url().slice(page.url().indexOf("#")), phone);
  await small.locator(".chart canvas").nth(2).waitFor();
  await expectNoSideways(small);
  await leave(small);
  await leave(page, /422/);
});
