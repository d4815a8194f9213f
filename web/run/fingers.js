// SPDX-License-Identifier: Apache-2.0
// Fingers on a plot: each holds the instant on which it was put down. One moves the stretch of time, two zoom it as
// well.

const leastApart = 10;  // pixels between two fingers: nearer ones would zoom without end, crossed ones turn time round

/** @typedef {{ x: number, t: number }} Finger */

/// @param over  the plot's area  @param times  the window that it shows
/** @param {HTMLElement} over  @param {TimeWindow} times */
export function watchFingers(over, times) {
  /** @type {Map<number, Finger>} */
  const fingers = new Map();  // where each is, in pixels, and the instant that it holds
  const placeOf = (event) => event.clientX - over.getBoundingClientRect().left;
  const hold = () => {
    for (const finger of fingers.values()) finger.t = times.from + (finger.x / over.clientWidth) * times.length;
  };
  const lift = (event) => fingers.delete(event.pointerId) && hold();
  over.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "touch") return;
    fingers.set(event.pointerId, { x: placeOf(event), t: NaN });
    hold();
  });
  over.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    finger.x = placeOf(event);
    const wanted = windowUnder([...fingers.values()], over.clientWidth, times.length);
    if (wanted) times.set(...wanted);
  });
  over.addEventListener("pointerup", lift);
  over.addEventListener("pointercancel", lift);
}

/// The window that has each finger at its instant; null if the fingers are too near each other, or have crossed.
/// @param width  of the plot, in pixels  @param length  of the window that is shown now
/**
 * @param {Finger[]} fingers
 * @param {number} width
 * @param {number} length
 * @returns {[number, number] | null}
 */
function windowUnder([first, second], width, length) {
  if (second && Math.abs(second.x - first.x) < leastApart) return null;
  const perPixel = second ? (second.t - first.t) / (second.x - first.x) : length / width;
  if (!(perPixel > 0 && Number.isFinite(perPixel))) return null;
  return [first.t - first.x * perPixel, first.t + (width - first.x) * perPixel];
}
