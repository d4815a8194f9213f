// The journal's path inside the clearance circle, coloured by time or by contact force.
import { findTrajectory } from "/core/api.js";
import { choice, h } from "/core/dom.js";
import { number } from "/core/format.js";
import { saveCanvas } from "/core/download.js";
import { seldom } from "/core/live.js";
import { colour, onColours, paletteColour } from "/core/theme.js";

const points = 6000;
const refineMs = 150;
const hues = 64;  // steps of the palette: one path is drawn for each

/// @param job  with a clearance
export function orbit(job, times, signal) {
  const canvas = h("canvas", { class: "orbit", role: "img", "aria-label": "Journal orbit inside the clearance circle" });
  const caption = h("p", { class: "quiet small", role: "status" });
  let by = "time";
  let data = null;
  const clearance = job.parameters.clearance_mm;

  async function load() {
    const { from, to } = times;
    try {
      data = await findTrajectory(job.id, { channels: ["t_s", "journal_x_mm", "journal_y_mm", "contact_force_n"], from, to, points }, signal);
      draw();
    } catch (error) {
      if (error.name !== "AbortError") caption.textContent = error.message;
    }
  }

  function draw() {
    if (!data) return;
    const values = by === "time" ? data.t_s : data.contact_force_n;
    const [low, high] = extremes(values);
    drawOrbit(canvas, data, clearance, (i) => (high > low ? (values[i] - low) / (high - low) : 0), indexAt(data.t_s, times.instant));
    const unit = by === "time" ? "s" : "N";
    caption.textContent = `Circle: clearance ${number(clearance)} mm. Colour from ${number(low)} ${unit} (dark) to ${number(high)} ${unit} (bright); ${data.t_s.length.toLocaleString("en")} points. The ring marks the instant pointed at.`;
  }

  const refine = seldom(() => signal.aborted || load(), refineMs);
  times.addEventListener("change", refine, { signal });
  times.addEventListener("instant", () => requestAnimationFrame(draw), { signal });
  onColours(draw, signal);
  const sizes = new ResizeObserver(draw);
  sizes.observe(canvas);
  signal.addEventListener("abort", () => sizes.disconnect());
  load();
  const picker = choice("Colour by", [["time", "time"], ["force", "contact force"]], by, (value) => { by = value; draw(); });
  return h("section", { class: "card" }, h("div", { class: "head" }, h("h2", {}, "Journal orbit [mm]"),
    h("span", { class: "actions" }, picker, h("button", { onclick: () => saveCanvas(canvas, "orbit.png") }, "PNG"))), canvas, caption);
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

function drawOrbit(canvas, { journal_x_mm: x, journal_y_mm: y }, clearance, partOf, marked) {
  const size = canvas.clientWidth * devicePixelRatio;
  if (size === 0) return;
  Object.assign(canvas, { width: size, height: size });
  const context = canvas.getContext("2d");
  const scale = (0.4 * size) / clearance;
  const at = (i) => [size / 2 + scale * x[i], size / 2 - scale * y[i]];
  context.fillStyle = colour("card");
  context.fillRect(0, 0, size, size);
  drawFrame(context, size, scale, clearance);
  const paths = Array.from({ length: hues }, () => new Path2D());
  for (let i = 1; i < x.length; i += 1) {
    const path = paths[Math.min(hues - 1, Math.floor(partOf(i) * hues))];
    path.moveTo(...at(i - 1));
    path.lineTo(...at(i));
  }
  context.lineWidth = devicePixelRatio;
  paths.forEach((path, hue) => {
    context.strokeStyle = paletteColour(hue / (hues - 1));
    context.stroke(path);
  });
  if (marked !== null) ring(context, ...at(marked), 5 * devicePixelRatio, "#e6007a");
}

function drawFrame(context, size, scale, clearance) {
  context.lineWidth = 1.5 * devicePixelRatio;
  ring(context, size / 2, size / 2, scale * clearance, colour("quiet"));
  context.fillStyle = colour("text");
  context.font = `${12 * devicePixelRatio}px system-ui`;
  context.textAlign = "center";
  for (const tick of [-clearance, 0, clearance]) {
    context.fillText(number(tick), size / 2 + scale * tick, size - 6 * devicePixelRatio);
    if (tick !== 0) context.fillText(number(tick), 0.05 * size, size / 2 - scale * tick + 4 * devicePixelRatio);
  }
  context.fillText("x", 0.96 * size, size - 6 * devicePixelRatio);
  context.fillText("y", 0.05 * size, 0.06 * size);
}

function ring(context, x, y, radius, stroke) {
  context.strokeStyle = stroke;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.stroke();
}
