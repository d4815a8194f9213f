// SPDX-License-Identifier: Apache-2.0
// Loads uPlot with its style sheet. It draws a hundred thousand points in a few milliseconds, which zooming and
// panning need.
import { addressOf } from "/core/api.js";
import { h } from "/core/dom.js";

let library = null;

export function loadUplot() {
  library ??= Promise.all([import("/lib/uplot.js"), styleSheet(addressOf("/lib/uplot.css"))])
    .then(([module]) => module.default).catch(() => {
    library = null;
    throw new Error("The plots could not be loaded: the program was built without the npm packages of web/, or is "
      + "another one since this page was loaded. Load the page again.");
  });
  return library;
}

function styleSheet(href) {
  return new Promise((resolve, reject) => {
    document.head.prepend(h("link", { rel: "stylesheet", href, onload: resolve, onerror: reject }));
  });
}
