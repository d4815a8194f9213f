// SPDX-License-Identifier: Apache-2.0
// Visits the dashboard with Debian's Chromium, without its windows, as a user would, and notes whatever a user should never meet.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import { chromium } from "playwright-core";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const [, , url, folder] = process.argv;

export { folder, url };

let browser = null;

/** Opens a page at a view such as "#/new". @param options  of Playwright's new context: viewport, colorScheme */
export async function visit(view, options = {}) {
  // As root, as in a container, Chromium does not start in its sandbox; it only ever sees the service under test.
  browser ??= chromium.launch({ executablePath: "/usr/bin/chromium-headless-shell", args: ["--no-sandbox"] });
  const context = await (await browser).newContext({ viewport: { width: 1360, height: 1000 }, acceptDownloads: true, locale: "en-GB", ...options });
  context.setDefaultTimeout(120_000);  // a machine may be busy
  const page = await context.newPage();
  page.faults = [];
  page.on("console", (message) => message.type() === "error" && page.faults.push(message.text()));
  page.on("pageerror", (error) => page.faults.push(error.stack));
  page.on("request", (request) => {
    const { protocol, origin } = new URL(request.url());
    if (protocol.startsWith("http") && origin !== url) page.faults.push(`asks another host: ${request.url()}`);
  });
  await page.goto(`${url}/${view}`);
  return page;
}

/** Leaves a page, on which nothing may have gone wrong. @param expected  faults that the test has provoked, as a pattern */
export async function leave(page, expected = null) {
  await page.context().close();
  assert.deepEqual(page.faults.filter((fault) => !expected?.test(fault)), []);
}

export async function endVisits() {
  await (await browser)?.close();
}

/** Keeps what is seen, for people to look at. */
export function picture(page, name, options = {}) {
  return page.screenshot({ path: join(folder, `${name}.png`), ...options });
}

/** Fails on what axe-core finds to shut people out. */
export async function expectAccessible(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  assert.deepEqual(serious.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 160)).join(" | ")}`), []);
}

/** Fails if the page is wider than its window, so that it would have to be pushed about to be read. */
export async function expectNoSideways(page) {
  // A phone tells a window's width that grows with the content.
  const { width } = page.viewportSize();
  const content = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(content <= width, `${content} pixels wide in a window of ${width}`);
}

/** An answer of the service itself. */
export async function ask(path, body) {
  const answer = await fetch(url + path, body === undefined ? {} : { method: "POST", body: JSON.stringify(body) });
  assert.ok(answer.ok, `${path}: ${answer.status} ${await answer.clone().text()}`);
  return answer.json();
}

/** Submits a sweep and waits for its end. */
export async function runSweep(request, seconds = 300) {
  let sweep = await ask("/v1/sweeps", request);
  for (const end = Date.now() + 1000 * seconds; ["queued", "running"].includes(sweep.state); sweep = await ask(`/v1/sweeps/${sweep.id}`)) {
    assert.ok(Date.now() < end, `the sweep has not ended within ${seconds} s`);
    await new Promise((resolve) => { setTimeout(resolve, 50); });
  }
  assert.equal(sweep.state, "succeeded");
  return sweep;
}

/** The rows of a sweep. */
export const resultsOf = (sweep) => ask(`/v1/sweeps/${sweep.id}/results`);

/** Name and text of a download. */
export async function textOf(page, click) {
  const [download] = await Promise.all([page.waitForEvent("download"), click()]);
  return { name: download.suggestedFilename(), text: readFileSync(await download.path(), "utf8") };
}
