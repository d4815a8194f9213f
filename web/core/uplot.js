// SPDX-License-Identifier: Apache-2.0
// Loads uPlot with its style sheet. It draws a hundred thousand points in a few milliseconds, which zooming and
// panning need.
import { addressOf } from "/core/api.js";
import { h } from "/core/dom.js";
import { libraryLoader } from "/core/modules.js";

export const loadUplot = libraryLoader("plots", async () => {
  const [module] = await Promise.all([import("/lib/uplot.js"), styleSheet(addressOf("/lib/uplot.css"))]);
  return module.default;
});

function styleSheet(href) {
  return new Promise((resolve, reject) => {
    document.head.prepend(h("link", { rel: "stylesheet", href, onload: resolve, onerror: reject }));
  });
}
