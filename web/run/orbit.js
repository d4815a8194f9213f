// The journal's path inside the clearance circle, coloured by time or by contact force.
import { findTrajectory } from "/core/api.js";
import { choice, h } from "/core/dom.js";
import { number } from "/core/format.js";
import { saveCanvas } from "/core/download.js";
import { settled } from "/core/live.js";
import { onColours } from "/core/theme.js";
import { drawRing, drawScale, paintOrbit } from "/run/orbit_drawing.js";

const points = 6000;
const refineMs = 200;
const channels = ["t_s", "journal_x_mm", "journal_y_mm", "contact_force_n"];

/// @param job  with a clearance
export function orbit(job, times, signal) {
  const canvas = h("canvas", { class: "orbit", role: "img", "aria-label": "Journal orbit inside the clearance circle" });
  const bar = h("canvas", { class: "palette", width: 256, height: 1, "aria-hidden": "true" });
  const [low, high] = [h("span"), h("span")];
  const caption = h("p", { class: "quiet small", role: "status" });
  const clearance = job.parameters.clearance_mm;
  let by = "time";
  let whole = null;
  let shown = null;
  let painted = null;

  async function load() {
    try {
      whole ??= await findTrajectory(job.id, { channels, points }, signal);
      shown = times.isWhole ? whole : await findTrajectory(job.id, { channels, from: times.from, to: times.to, points }, signal);
      paint();
    } catch (error) {
      if (error.name !== "AbortError") caption.textContent = error.message;
    }
  }

  function paint() {
    const size = Math.round(canvas.clientWidth * devicePixelRatio);
    if (!shown || size === 0) return;
    const values = by === "time" ? shown.t_s : shown.contact_force_n;
    const [least, largest] = extremes(values);
    painted = paintOrbit(size, shown, shown === whole ? null : whole, clearance, (i) => (largest > least ? (values[i] - least) / (largest - least) : 0));
    drawScale(bar);
    const unit = by === "time" ? "s" : "N";
    low.textContent = `${number(least)} ${unit}`;
    high.textContent = `${number(largest)} ${unit}`;
    caption.textContent = `Circle: clearance ${number(clearance)} mm. ${shown.t_s.length.toLocaleString("en")} samples${shown === whole ? "" : "; the rest of the run is pale"}. The ring marks the instant.`;
    canvas.dataset.samples = shown.t_s.length;
    draw();
  }

  function draw() {
    if (!painted) return;
    const { picture } = painted;
    Object.assign(canvas, { width: picture.width, height: picture.height });
    const context = canvas.getContext("2d");
    context.drawImage(picture, 0, 0);
    const index = indexAt(shown.t_s, times.instant);
    context.lineWidth = 2 * devicePixelRatio;
    if (index !== null) drawRing(context, painted.at(index), 5 * devicePixelRatio);
  }

  const refine = settled(() => signal.aborted || load(), refineMs);
  times.addEventListener("change", refine, { signal });
  times.addEventListener("instant", () => requestAnimationFrame(draw), { signal });
  onColours(paint, signal);
  const sizes = new ResizeObserver(paint);
  sizes.observe(canvas);
  signal.addEventListener("abort", () => sizes.disconnect());
  load();
  const picker = choice("Colour by", [["time", "time"], ["force", "contact force"]], by, (value) => { by = value; paint(); });
  return h("section", { class: "card" }, h("div", { class: "head" }, h("h2", {}, "Journal orbit"),
    h("span", { class: "actions" }, picker, h("button", { onclick: () => saveCanvas(canvas, "orbit.png") }, "PNG"))), canvas,
    h("p", { class: "scale small" }, low, bar, high), caption);
}

function extremes(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return [low, high];
}

function indexAt(times, instant) {
  const index = times.findIndex((t) => t >= instant);
  return instant < times[0] || index < 0 ? null : index;
}
