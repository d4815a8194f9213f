// SPDX-License-Identifier: Apache-2.0
// Builds elements. Every text goes in as text, never as markup.

/// An element; attributes that are false or null are left out, functions listen to the event of their name ("onclick").
/**
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Record<string, any>} attributes
 * @param {...any} children
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function h(tag, attributes = {}, ...children) {
  /** @type {any} */
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else if (name === "value") element.value = value;
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/// An element that is in the page from the start, or of a part of it that has one.
/**
 * @param {string} selector
 * @param {ParentNode} within
 * @returns {any}
 */
export function part(selector, within = document) {
  const element = within.querySelector(selector);
  if (element === null) throw new Error(`The page has no ${selector}.`);
  return element;
}

/// Drawing context of a canvas.
/** @param {HTMLCanvasElement} canvas */
export function contextOf(canvas) {
  const context = canvas.getContext("2d");
  if (context === null) throw new Error("This browser has no memory left for a picture of that size.");
  return context;
}

/// Shows or hides an element. Its place is kept, so that its neighbours do not move under the pointer.
/** @param {HTMLElement} element  @param {boolean} isSeen */
export function setSeen(element, isSeen) {
  element.classList.toggle("unseen", !isSeen);
}

/// A labelled select. @param options  strings, or [value, text]
/**
 * @param {string} label
 * @param {(string | string[])[]} options
 * @param {string} value
 * @param {(chosen: string) => unknown} onchange
 */
export function choice(label, options, value, onchange) {
  const select = h("select", { onchange: () => onchange(select.value) },
    options.map((option) => {
      const [key, text] = Array.isArray(option) ? option : [option, option];
      return h("option", { value: key }, text);
    }));
  select.value = value;
  return h("label", { class: "choice" }, h("span", {}, label), select);
}

/// Fills an element anew. Its part that had the focus, by its "data-key", has it again.
/** @param {HTMLElement} element  @param {() => void} fill */
export function keepFocus(element, fill) {
  const { activeElement: active } = document;
  const key = element.contains(active) ? active?.getAttribute("data-key") : null;
  fill();
  if (typeof key !== "string") return;
  /** @type {HTMLElement | null} */
  const again = element.querySelector(`[data-key="${CSS.escape(key)}"]`);
  if (again !== document.activeElement) again?.focus({ preventScroll: true });
}

/// Table in a card with a name. @param head  text and class of each heading
/** @param {string} title  @param {string} help  @param {string[][]} head  @param {HTMLElement[]} rows */
export function tableCard(title, help, head, rows) {
  return h("section", { class: "card" }, h("h2", {}, title), h("p", { class: "quiet small" }, help),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": title }, h("table", {},
      h("thead", {}, h("tr", {}, head.map(([text, look]) => h("th", { scope: "col", class: look }, text)))),
      h("tbody", {}, rows))));
}

/// A small square of a colour, for legends.
/** @param {string} colour */
export function swatch(colour) {
  const element = h("span", { class: "swatch", "aria-hidden": "true" });
  element.style.backgroundColor = colour;
  return element;
}

/// Resolves once the element has a width, which it has not before it stands in the page.
/** @param {HTMLElement} element  @param {AbortSignal} signal */
export async function laidOut(element, signal) {
  while (element.clientWidth === 0 && !signal.aborted) await new Promise(requestAnimationFrame);
}

/// True of an element in sight, or less than a window's height away from that.
/** @param {Element} element */
export function isNear(element) {
  const { top, bottom } = element.getBoundingClientRect();
  return element.isConnected && bottom > -innerHeight && top < 2 * innerHeight;
}

/// Resolves once what stands in the page now is on the screen. A hidden page, which has no frames, is not waited for.
/** @returns {Promise<void>} */
export function painted() {
  return new Promise((resolve) => {
    if (document.hidden) setTimeout(resolve);
    else requestAnimationFrame(() => setTimeout(resolve));
  });
}

let nextId = 0;

/// An id that no other element has.
export function freshId(stem) {
  nextId += 1;
  return `${stem}-${nextId}`;
}

/** @type {number | undefined} */
let noticeTimer;

/// Tells something to everyone, screen readers included.
/** @param {string} text  @param {"" | "trouble"} kind */
export function notify(text, kind = "") {
  const notice = part("#notice");
  notice.className = kind;
  notice.textContent = text;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => { notice.textContent = ""; }, 8000);
}

/// Tells a trouble, if there is one.
/** @param {string} text */
export const tellTrouble = (text) => text && notify(text, "trouble");
