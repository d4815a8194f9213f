// SPDX-License-Identifier: Apache-2.0
// Tooltip with the definition of a metric or channel: for the mouse, the keyboard and fingers. Escape closes it.
import { h } from "/core/dom.js";
import { definitionOf } from "/core/quantities.js";

const hoverMs = 350;  // until the mouse is taken to rest on an element
const leaveMs = 200;  // in which the mouse may go over to the tooltip
const margin = 8;  // pixels to the window's edges
const focusable = "a[href], button, input, select, textarea, [tabindex]";

/** @typedef {import("/core/quantities.js").Kind} Kind */

const text = h("p", { role: "tooltip", id: "definition", hidden: true });
/** @type {HTMLElement | null} */
let anchor = null;
/** @type {Element | null} */
let described = null;
/** @type {number | undefined} */
let timer;

/** @param {EventTarget | null} target  @returns {HTMLElement | null} */
const anchorOf = (target) => (target instanceof Element ? target.closest("[data-quantity]") : null);

function close() {
  described?.removeAttribute("aria-describedby");
  [anchor, described] = [null, null];
  text.hidden = true;
}

function hide() {
  clearTimeout(timer);
  close();
}

/// Below the element, or above it where there is no room.
function place() {
  if (!anchor) return;
  const box = anchor.getBoundingClientRect();
  if (!anchor.isConnected || box.bottom < 0 || box.top > innerHeight) {
    close();  // another element may be about to be explained
    return;
  }
  const { offsetWidth: width, offsetHeight: height } = text;
  const below = box.bottom + 4;
  const top = below + height + margin <= innerHeight ? below : Math.max(margin, box.top - height - 4);
  const left = Math.max(margin, Math.min(box.left, document.documentElement.clientWidth - width - margin));
  Object.assign(text.style, { top: `${top}px`, left: `${left}px` });
}

/** @param {HTMLElement} element */
async function show(element) {
  hide();
  anchor = element;
  const { kind, quantity = "" } = element.dataset;
  const found = await definitionOf(/** @type {Kind} */ (kind), quantity).catch(() => "");
  if (anchor !== element || element.dataset.quantity !== quantity || found === "") return;
  text.textContent = found;
  text.hidden = false;
  described = element.matches(focusable) ? element : element.querySelector(focusable);
  described?.setAttribute("aria-describedby", text.id);
  place();
}

/// Shows it after some milliseconds, or hides it where there is no element.
/** @param {HTMLElement | null} element  @param {number} milliseconds */
function soon(element, milliseconds) {
  clearTimeout(timer);
  if (element !== anchor) timer = setTimeout(() => (element ? show(element) : hide()), milliseconds);
}

/// A click may have put another element in the place of the one that was touched.
/** @param {PointerEvent} event */
function touched({ target, clientX, clientY }) {
  const element = target instanceof Element && target.isConnected ? target
    : document.elementFromPoint(clientX, clientY);
  const touchedAnchor = anchorOf(element);
  if (touchedAnchor && touchedAnchor !== anchor) show(touchedAnchor);
  else if (!text.contains(element)) hide();
}

export function startDefinitions() {
  document.body.append(text);
  document.addEventListener("pointerover", ({ target, pointerType }) => {
    if (pointerType !== "mouse") return;
    const element = anchorOf(target);
    if (element) soon(element, hoverMs);
    else if (text.contains(/** @type {Node} */ (target))) clearTimeout(timer);
    // An element with the keyboard's focus stays explained.
    else if (!anchor?.matches(":focus-visible, :has(:focus-visible)")) soon(null, leaveMs);
  });
  document.addEventListener("click", (event) => {
    if (/** @type {PointerEvent} */ (event).pointerType === "touch") touched(/** @type {PointerEvent} */ (event));
  });
  document.addEventListener("pointerdown", ({ target, pointerType }) => {
    if (pointerType === "mouse" && !text.contains(/** @type {Node} */ (target))) hide();
  });
  document.addEventListener("focusin", ({ target }) => {
    const element = anchorOf(target);
    if (element && /** @type {Element} */ (target).matches(":focus-visible")) show(element);
    else if (!element) hide();
  });
  document.addEventListener("focusout", ({ target }) => { if (anchor && anchorOf(target) === anchor) hide(); });
  document.addEventListener("change", ({ target }) => {
    const element = anchorOf(target);
    if (element && element === anchor) show(element);
  });
  document.addEventListener("keydown", ({ key }) => { if (key === "Escape") hide(); });
  document.addEventListener("scroll", place, { capture: true, passive: true });
  addEventListener("resize", place);
  addEventListener("hashchange", hide);
}
