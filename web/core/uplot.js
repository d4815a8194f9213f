// SPDX-License-Identifier: Apache-2.0
// Loads uPlot with its style sheet. It draws a hundred thousand points in a few milliseconds, which zooming and panning need.
import { h } from "/core/dom.js";

let library = null;

export function loadUplot() {
  library ??= Promise.all([import("/lib/uplot.js"), styleSheet("/lib/uplot.css")]).then(([module]) => module.default).catch(() => {
    library = null;
    throw new Error("This program was built without its plots: the npm packages of web/ could not be fetched then.");
  });
  return library;
}

function styleSheet(href) {
  return new Promise((resolve, reject) => {
    document.head.prepend(h("link", { rel: "stylesheet", href, onload: resolve, onerror: reject }));
  });
}
