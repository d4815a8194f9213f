// SPDX-License-Identifier: Apache-2.0
// Shows the view that the address names, and gives it up when the address changes.
import { findHealth, isTransient } from "/core/api.js";
import { startDefinitions } from "/core/definition.js";
import { readRoute } from "/core/route.js";
import { h, part } from "/core/dom.js";
import { pause, retryWhileUnreachable } from "/core/live.js";
import { Missing, loadModule, nextWait, tryAgain } from "/core/modules.js";
import { startTheme } from "/core/theme.js";

const pages = {
  "": () => import("/pages/sweeps.js"),
  new: () => import("/pages/new_sweep.js"),
  sweeps: () => import("/pages/sweep.js"),
  analyses: () => import("/pages/analyses.js"),
  searches: () => import("/pages/searches.js"),
  wear: () => import("/pages/wear.js"),
  optimisations: () => import("/pages/optimisations.js"),
  fits: () => import("/pages/fits.js"),
  measurements: () => import("/pages/measurements.js"),
  jobs: () => import("/pages/job.js"),
  help: () => import("/pages/help.js"),
};

/** @type {HTMLElement} */
const main = part("#main");
let leave = () => {};
let shown = 0;
const againMs = 2000;

/// Kinds of pages of one sweep or job. Without its id they are the list of sweeps.
const ofOne = ["sweeps", "analyses", "jobs"];

/// Kinds of pages with a link of their own in the navigation.
const linked = ["new", "searches", "wear", "optimisations", "fits", "measurements", "help"];

function markNavigation(kind) {
  for (const link of /** @type {NodeListOf<HTMLAnchorElement>} */ (document.querySelectorAll("header nav a"))) {
    const target = link.hash.slice(2);
    if (link.hash !== "" && target === (linked.includes(kind) ? kind : "")) {
      link.setAttribute("aria-current", "page");
      link.scrollIntoView({ block: "nearest", inline: "nearest" });  // a phone shows some of the links at once
    } else link.removeAttribute("aria-current");
  }
}

/// The module of a view.
async function load(kind, signal) {
  if (!Object.hasOwn(pages, kind)) throw new Error("There is no such page.");
  return loadModule(pages[kind], signal);
}

/// Resolves once the service answers. @throws an AbortError when the signal is given
async function whenBack(signal) {
  await pause(againMs, signal);
  await retryWhileUnreachable(() => findHealth(signal), () => {}, signal);
}

/// Shows why there is no view. @param more  elements that help
function say(told, ...more) {
  main.replaceChildren(h("h1", {}, "This page cannot be shown"), h("p", { class: "trouble", role: "alert" }, told),
    ...more, h("p", {}, h("a", { href: "#/" }, "Sweeps")));
}

function sayMissing(error, signal) {
  const wait = nextWait();
  if (wait === null) {
    return say(`${error.message} It has been tried several times: a file may be missing where the service is `
      + `installed, or something between it and this browser holds it back.`,
      h("p", { class: "quiet small" }, error.reason), h("p", {}, h("button", { onclick: tryAgain }, "Try again")));
  }
  say(`${error.message} Trying again …`);
  return pause(wait, signal).then(tryAgain, () => {});
}

async function show() {
  const { id, query, ...route } = readRoute();
  const kind = id === "" && ofOne.includes(route.kind) ? "" : route.kind;
  const number = ++shown;
  leave();
  const ended = new AbortController();
  leave = () => ended.abort();
  main.replaceChildren(h("p", { class: "quiet loading", role: "status" }, "Loading …"));
  markNavigation(kind);
  let page = null;
  try {
    page = await load(kind, ended.signal);
    if (number === shown) await page.show(main, { id, query, signal: ended.signal });
  } catch (error) {
    if (number !== shown || error.name === "AbortError") return;
    if (error instanceof Missing) sayMissing(error, ended.signal);
    else if (isTransient(error)) {
      say(`${error.message} Trying again …`);
      whenBack(ended.signal).then(() => (page ? show() : location.reload()), () => {});
    } else say(error.message);
  }
}

part(".skip").addEventListener("click", (event) => {
  event.preventDefault();
  main.focus();
});
// A link to the view that is shown shows it anew: an empty form is empty again.
document.addEventListener("click", ({ target, ctrlKey, metaKey, shiftKey }) => {
  const link = target instanceof Element ? target.closest("a[href^='#']") : null;
  const isElsewhere = ctrlKey || metaKey || shiftKey;  // in another tab or window
  if (link?.getAttribute("href") === location.hash && !isElsewhere) show();
});
startTheme();
startDefinitions();
// Without it nothing is missing but the version itself.
findHealth().then(({ version }) => { part("#version").textContent = version; }).catch(() => {});
addEventListener("hashchange", show);
show();
