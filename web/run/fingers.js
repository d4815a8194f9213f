// Fingers on a plot: each holds the instant on which it was put down. One moves the stretch of time, two zoom it as well.

/// @param over  the plot's area  @param times  the window that it shows
export function watchFingers(over, times) {
  const fingers = new Map();  // where each is, in pixels, and the instant that it holds
  const placeOf = (event) => event.clientX - over.getBoundingClientRect().left;
  const hold = () => {
    for (const finger of fingers.values()) finger.t = times.from + (finger.x / over.clientWidth) * times.length;
  };
  const lift = (event) => fingers.delete(event.pointerId) && hold();
  over.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "touch") return;
    fingers.set(event.pointerId, { x: placeOf(event) });
    hold();
  });
  over.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    finger.x = placeOf(event);
    times.set(...windowUnder([...fingers.values()], over.clientWidth, times.length));
  });
  over.addEventListener("pointerup", lift);
  over.addEventListener("pointercancel", lift);
}

/// The window that has each finger at its instant. @param width  of the plot, in pixels  @param length  of the window that is shown now
function windowUnder([first, second], width, length) {
  const perPixel = second ? (second.t - first.t) / (second.x - first.x) : length / width;
  return [first.t - first.x * perPixel, first.t + (width - first.x) * perPixel];
}
