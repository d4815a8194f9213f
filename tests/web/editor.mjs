// SPDX-License-Identifier: Apache-2.0
// The editor of a described linkage: text, picture, parts and faults.   node editor.mjs URL FOLDER
import assert from "node:assert/strict";
import { after, test } from "node:test";

import { endVisits, expectAccessible, expectNoSideways, leave, picture, visit } from "./visitor.mjs";

after(endVisits);
const text = (page) => page.getByLabel("Linkage: JSON object of bodies and joints");
const selected = (page) => text(page).evaluate((area) => area.value.slice(area.selectionStart, area.selectionEnd));
const shown = async (page) => JSON.parse(await page.locator("aside pre").first().textContent());
const change = async (page, from, to) => text(page).fill((await text(page).inputValue()).replace(from, to));
const refused = /422/;

/** Picture on the canvas. */
const pixels = (page) => page.locator(".preview canvas").evaluate((canvas) => canvas.toDataURL());

test("a linkage stands beside its text, and its parts are found in the text", async () => {
  const page = await visit("#/new?linkage=slider_crank");
  await page.locator(".preview[data-bodies='3'] canvas").waitFor();
  await page.getByText("Assembled at t = 0. Degrees of freedom without a drive, those of play and bending among them: 4.").waitFor();
  await page.getByText("revolute, crank → rod, clearance 0.1 mm, closes the loop").waitFor();
  await page.getByText("revolute, slider → rod, clearance 0.2 mm, closes the loop").waitFor();
  await page.getByText("driven by run up").waitFor();
  await page.getByRole("button", { name: "slider pin", exact: true }).click();
  const found = await selected(page);
  assert.ok(found.startsWith('"slider_pin": {') && found.endsWith('"clearance": {}\n  }'), found);
  await page.getByRole("button", { name: "rod", exact: true }).focus();
  await page.keyboard.press("Enter");
  assert.match(await selected(page), /^"rod": \{\s+"mass_kg": 0.21,/);
  const isSeen = await text(page).evaluate((area) => area === document.activeElement && area.scrollTop < 200);
  assert.ok(isSeen, "the selected place is in sight, with the cursor in it");
  // Those of RPSUP do not apply.
  assert.ok(await page.getByLabel("Crank velocity", { exact: true }).isHidden());
  assert.ok(await page.getByLabel("Duration", { exact: true }).isVisible());
  await expectAccessible(page);
  for (const [width, colorScheme] of [[390, "light"], [1280, "dark"], [1920, "light"]]) {
    await page.setViewportSize({ width, height: 1000 });
    await page.emulateMedia({ colorScheme });
    await expectNoSideways(page);
    await picture(page, `editor_${width}`);
  }
  await leave(page);
});

test("faults are listed with their places, and the last position stays while the text is faulty", async () => {
  const page = await visit("#/new?linkage=slider_crank");
  await page.locator(".preview[data-bodies] canvas").waitFor();
  await change(page, '"from": "crank",', '"from": "crnk",');
  const missing = page.getByRole("button", { name: "joint crank pin, from: there is no body crnk" });
  await missing.waitFor();
  await page.getByText("the picture shows the last position that was assembled").waitFor();
  assert.ok(await page.locator(".preview canvas").isVisible());
  await missing.click();
  assert.equal(await selected(page), '"from": "crnk"');
  await expectAccessible(page);
  await picture(page, "editor_fault");
  await change(page, '"from": "crnk"', '"from" "crank"');
  const unclear = page.getByRole("button", { name: /^line \d+, column \d+: “:” is expected after a name$/ });
  await unclear.click();
  assert.equal(await text(page).evaluate((area) => area.value.slice(0, area.selectionStart).split("\n").at(-1).trim()), '"from"');
  assert.ok(await page.getByRole("button", { name: "Submit" }).isDisabled());
  await change(page, '"from" "crank"', '"from": 01');
  await page.getByRole("button", { name: /“,” is expected or “}”$/ }).waitFor();
  await change(page, '"from": 01', '"from": "crank"');
  await page.getByText(/^Assembled at t = 0/).waitFor();
  assert.equal(await page.getByRole("list", { name: "Faults of the linkage" }).count(), 0);
  const before = await pixels(page);
  await change(page, '"to_at_m": [0.12, 0, 0]', '"to_at_m": [0.08, 0, 0]');
  await page.waitForFunction((old) => document.querySelector(".preview canvas").toDataURL() !== old, before);
  await leave(page, refused);
});

test("a linkage typed into an empty form is drawn, and what RPSUP alone has is not sent", async () => {
  const page = await visit("#/new");
  await page.getByLabel("Crank velocity", { exact: true }).fill("12");
  await page.getByText("Custom linkage", { exact: true }).click();
  await text(page).fill('{"bodies": {"bob": {"mass_kg": 1, "centre_of_mass_m": [0.5, 0, 0]}}, '
    + '"joints": {"pivot": {"kind": "revolute", "from": "ground", "to": "bob"}}, '
    + '"accelerometers": {"tip": {"body": "bob", "direction": [1, 0, 0]}}}');
  await page.locator(".preview[data-bodies='1'] canvas").waitFor();
  await page.getByText("Assembled at t = 0. Degrees of freedom without a drive, those of play and bending among them: 1.").waitFor();
  await page.getByText("tip on bob").waitFor();
  assert.deepEqual(Object.keys((await shown(page)).parameters), ["linkage"]);
  // Without a joint with clearance there is no contact.
  assert.ok(await page.locator('[data-path="restitution"]').isHidden());
  await text(page).fill("");
  assert.ok(await page.locator('[data-path="restitution"]').isVisible());
  assert.deepEqual((await shown(page)).parameters, { crank_velocity_rad_s: 12 });
  assert.ok(await page.locator(".preview").isHidden());
  await leave(page);
});

test("linkages are chosen by their pictures", async () => {
  const page = await visit("#/new");
  const gallery = page.getByRole("list", { name: "Linkages to begin with" });
  const chosen = () => gallery.locator("[aria-current]").locator("strong").allTextContents();
  await gallery.getByRole("link", { name: /^Four-bar/ }).waitFor();
  assert.deepEqual(await chosen(), ["RPSUP"]);
  assert.equal(await gallery.getByRole("link").count(), 10);
  await page.waitForFunction(() => [...document.querySelectorAll(".gallery img")].every((image) => image.naturalWidth > 0));
  await expectAccessible(page);
  await picture(page, "gallery");
  await gallery.getByRole("link", { name: /^Four-bar/ }).click();
  await page.getByText(/flexible beam of \d+ elements/).waitFor();
  assert.deepEqual(await chosen(), ["Four-bar"]);
  await page.locator(".preview[data-bodies='3'] canvas").waitFor();
  await page.getByRole("link", { name: "Load the paper's sweep" }).click();
  await page.waitForFunction(() => document.querySelector("[aria-current] strong")?.textContent === "RPSUP");
  await page.setViewportSize({ width: 390, height: 900 });
  await expectNoSideways(page);
  await page.emulateMedia({ colorScheme: "dark" });
  await picture(page, "gallery_390");
  await leave(page);
});
