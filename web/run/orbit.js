// SPDX-License-Identifier: Apache-2.0
// The journal's path inside the outline of the clearance, coloured by time or by contact force.
import { findTrajectory } from "/core/api.js";
import { choice, contextOf, h } from "/core/dom.js";
import { number, titleOf } from "/core/format.js";
import { saveCanvas } from "/core/download.js";
import { debounce, latest } from "/core/live.js";
import { onColours } from "/core/theme.js";
import { captioned } from "/run/captioned.js";
import { wordsOf } from "/run/described.js";
import { drawRing, drawScale, paintOrbit } from "/run/orbit_drawing.js";

const points = 6000;
const refineMs = 200;
const quantities = ["journal_x_mm", "journal_y_mm", "contact_force_n"];

/// @param joint  with clearance: its name, empty if it is the only one, the prefix of its channels, the outline of
/// its clearance
/**
 * @param {Api.Job} job
 * @param {ReturnType<typeof import("/run/described.js").clearanceJoints>[number]} joint
 * @param {TimeWindow} times
 * @param {AbortSignal} signal
 */
export function orbit(job, { name, prefix, clearance }, times, signal) {
  const title = name ? `Journal orbit of ${name.replaceAll("_", " ")}` : "Journal orbit";
  const outline = clearance.isRound ? "circle" : "rectangle";
  const channels = ["t_s", ...quantities.map((quantity) => prefix + quantity)];
  const columnsOf = async (more, current) => plain(await findTrajectory(job.id, { channels, ...more, points }, current),
    prefix);
  const canvas = h("canvas", { class: "orbit", role: "img", "aria-label": `${title} inside the clearance ${outline}` });
  const bar = h("canvas", { class: "palette", width: 256, height: 1, "aria-hidden": "true" });
  const [low, high] = [h("span"), h("span")];
  const caption = h("p", { class: "quiet small", role: "status" });
  let by = "time";
  let whole = null;
  let shown = null;
  let painted = null;

  const load = latest(async (current) => {
    const all = whole ?? await columnsOf({}, current);
    const part = times.isWhole ? all : await columnsOf({ from: times.from, to: times.to }, current);
    [whole, shown] = [all, part];
    paint();
  }, signal);
  const tryLoad = () => load().catch((error) => { caption.textContent = error.message; });

  function paint() {
    const size = Math.round(canvas.clientWidth * devicePixelRatio);
    if (!shown || size === 0) return;
    const values = by === "time" ? shown.t_s : shown.contact_force_n;
    const [least, largest] = extremes(values);
    painted = paintOrbit(size, shown, shown === whole ? null : whole, clearance,
      (i) => (largest > least ? (values[i] - least) / (largest - least) : 0));
    drawScale(bar);
    const unit = by === "time" ? "s" : "N";
    low.textContent = `${number(least)} ${unit}`;
    high.textContent = `${number(largest)} ${unit}`;
    const shape = clearance.isRound ? "Circle" : "Rectangle";
    caption.textContent = `${shape}: ${wordsOf(clearance)}. ${shown.t_s.length.toLocaleString("en")} `
      + `samples${shown === whole ? "" : "; the rest of the run is pale"}. Ring: current instant.`;
    canvas.dataset.samples = shown.t_s.length;
    draw();
  }

  function draw() {
    if (!painted) return;
    const { picture } = painted;
    Object.assign(canvas, { width: picture.width, height: picture.height });
    const context = contextOf(canvas);
    context.drawImage(picture, 0, 0);
    const index = indexAt(shown.t_s, times.instant);
    context.lineWidth = 2 * devicePixelRatio;
    if (index !== null) drawRing(context, painted.at(index), 5 * devicePixelRatio);
  }

  /// Caption of a saved orbit.
  function words() {
    const [x, y, force] = channels.slice(1).map((channel) => titleOf(channel));
    return [title, `${x} across, ${y} up`, `colour: ${by === "time" ? "time" : force}, ${low.textContent} `
      + `to ${high.textContent}`,
      wordsOf(clearance), job.id].map((text) => ({ name: text }));
  }

  const refine = debounce(() => signal.aborted || tryLoad(), refineMs);
  times.addEventListener("change", refine, { signal });
  times.addEventListener("instant", () => requestAnimationFrame(draw), { signal });
  onColours(paint, signal);
  const sizes = new ResizeObserver(paint);
  sizes.observe(canvas);
  signal.addEventListener("abort", () => sizes.disconnect());
  tryLoad();
  const picker = choice("Colour by", [["time", "time"], ["force", "contact force"]], by,
    (value) => { by = value; paint(); });
  return h("section", { class: "card" }, h("div", { class: "head" }, h("h2", {}, title),
    h("span", { class: "actions" }, picker,
      h("button", { onclick: () => painted && saveCanvas(captioned(canvas, words()), `${title}.png`) }, "PNG"))),
      canvas,
    h("p", { class: "scale small" }, low, bar, high), caption);
}

/// The columns by their names without the joint's.
/** @param {Api.Columns} columns  @param {string} prefix */
function plain(columns, prefix) {
  return Object.fromEntries(Object.entries(columns)
    .map(([name, values]) => [name.startsWith(prefix) ? name.slice(prefix.length) : name, values]));
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
