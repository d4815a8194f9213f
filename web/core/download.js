// SPDX-License-Identifier: Apache-2.0
import { h, notify } from "/core/dom.js";

/// Hands a file to the user that this page has made.
/** @param {Blob | string} content  @param {string} name  @param {string} type */
export function save(content, name, type) {
  const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  h("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** @param {HTMLCanvasElement} canvas  @param {string} name */
export function saveCanvas(canvas, name) {
  canvas.toBlob((blob) => {
    if (blob) save(blob, name, "image/png");
    else notify("This browser has no memory left for a picture of that size.", "trouble");
  }, "image/png");
}
