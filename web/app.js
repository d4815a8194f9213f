// Shows the view that the address names, and gives it up when the address changes.
import { Away, findHealth, isAway } from "/core/api.js";
import { readRoute } from "/core/route.js";
import { h } from "/core/dom.js";
import { pause, persist } from "/core/live.js";
import { startTheme } from "/core/theme.js";

const pages = {
  "": () => import("/pages/sweeps.js"),
  new: () => import("/pages/new_sweep.js"),
  sweeps: () => import("/pages/sweep.js"),
  analyses: () => import("/pages/analyses.js"),
  searches: () => import("/pages/searches.js"),
  wear: () => import("/pages/wear.js"),
  jobs: () => import("/pages/job.js"),
};

const main = document.querySelector("#main");
let leave = () => {};
let shown = 0;
const againMs = 2000;

function markNavigation(kind) {
  for (const link of document.querySelectorAll("header nav a")) {
    const target = link.getAttribute("href").slice(2);
    if (target === (["new", "searches", "wear"].includes(kind) ? kind : "")) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
}

/// The module of a view. @throws Away if it could not be fetched, which browsers tell as a TypeError
async function load(kind) {
  if (!Object.hasOwn(pages, kind)) throw new Error("There is no such view.");
  return pages[kind]().catch((error) => { throw error instanceof TypeError ? new Away() : error; });
}

/// Resolves once the service answers. @throws an AbortError when the signal is given
async function whenBack(signal) {
  await pause(againMs, signal);
  await persist(() => findHealth(signal), () => {}, signal);
}

async function show() {
  const { kind, id, query } = readRoute();
  const number = ++shown;
  leave();
  const ended = new AbortController();
  leave = () => ended.abort();
  main.replaceChildren();
  markNavigation(kind);
  let page = null;
  try {
    page = await load(kind);
    if (number === shown) await page.show(main, { id, query, signal: ended.signal });
  } catch (error) {
    if (number !== shown || error.name === "AbortError") return;
    const away = isAway(error);
    const told = away ? `${error.message} Trying again …` : error.message;
    main.replaceChildren(h("h1", {}, "This view cannot be shown"), h("p", { class: "trouble", role: "alert" }, told), h("p", {}, h("a", { href: "#/" }, "To the sweeps")));
    // A module that failed is kept as such by some browsers: only a new page asks for it again.
    if (away) whenBack(ended.signal).then(() => (page ? show() : location.reload()), () => {});
  }
}

document.querySelector(".skip").addEventListener("click", (event) => {
  event.preventDefault();
  main.focus();
});
startTheme();
addEventListener("hashchange", show);
show();
