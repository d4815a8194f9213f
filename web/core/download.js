import { h } from "/core/dom.js";

/// Hands a file to the user that this page has made.
export function save(content, name, type) {
  const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  h("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

export function saveCanvas(canvas, name) {
  canvas.toBlob((blob) => save(blob, name, "image/png"), "image/png");
}
