// Parallel coordinates: a line for each job over the axes and some metrics. Brushing an axis selects jobs.
import { makeChart } from "/core/charts.js";
import { exact, number, titleOf } from "/core/format.js";
import { colour, palette } from "/core/theme.js";
import { none, valueOf, valuesOf } from "/study/data.js";
import { extremesOf, widened } from "/study/span.js";

const someMetrics = ["peak_contact_force_n", "impact_count", "rms_slider_acceleration_m_s2"];

export function parallelChart(element, study, signal) {
  let shown = [];
  let brushing = false;
  const made = makeChart(element, () => {
    const plan = planOf(study);
    shown = plan.shown;
    return plan.option;
  }, "Parallel coordinates of all jobs; the table below has the same numbers", signal);
  made.then(({ chart }) => chart.on("axisareaselected", () => {
    const [series] = chart.getModel().getSeries();
    const active = series.getRawIndicesByActiveState("active");
    brushing = true;
    study.selection.set(active.length === shown.length ? [] : active.map((index) => shown[index].job_id));
    brushing = false;
  })).catch(() => {});
  // While an axis is brushed its own lines are not drawn anew: that would end the brushing.
  return made.then((chart) => ({ ...chart, draw: () => { if (!brushing) chart.draw(); } }));
}

// Beyond the extremes there is room, from where a brush can begin.
const room = ({ min, max }) => 0.05 * (max - min || Math.abs(max) || 1);
const ends = (extremes) => widened(extremes) ?? extremes;
const roomy = { scale: true, min: (extremes) => ends(extremes).min - room(ends(extremes)), max: (extremes) => ends(extremes).max + room(ends(extremes)) };

function planOf({ rows, axes, metrics, view, selection }) {
  const columns = [...axes, ...new Set([...someMetrics.filter((metric) => metrics.includes(metric)), view.metric])];
  const shown = rows.filter((row) => row.state === "succeeded");
  const dimensions = columns.map((column, dim) => {
    const values = valuesOf(shown, column);
    const numeric = values.every((value) => typeof value === "number" || value === none);
    return { dim, name: titleOf(column), nameTextStyle: { color: colour("text") }, axisLabel: { color: colour("text"), formatter: (value) => (numeric ? number(value, 3) : exact(value)), ...(numeric ? { showMinLabel: false, showMaxLabel: false } : {}) },
      axisLine: { lineStyle: { color: colour("quiet") } }, ...(numeric ? roomy : { type: "category", data: values.map(String) }) };
  });
  if (shown.length === 0) return { shown, option: null };
  const peaks = shown.map((row) => row[view.metric]).filter((value) => typeof value === "number");
  const chosenFew = selection.size > 0;
  return { shown, option: {
    parallel: { left: 60, right: 90, top: 50, bottom: 55, parallelAxisDefault: { nameLocation: "start", nameGap: 18, nameTextStyle: { fontSize: 11, width: 110, overflow: "break" }, areaSelectStyle: { color: colour("accent"), opacity: 0.35 } } },
    parallelAxis: dimensions.map((dimension, index) => ({ ...dimension, nameLocation: index % 2 === 0 ? "end" : "start" })),
    visualMap: { show: false, ...ends(extremesOf(peaks)), dimension: columns.indexOf(view.metric), inRange: { color: palette() } },
    series: [{ type: "parallel", smooth: false, progressive: 400, progressiveThreshold: 1000, lineStyle: { width: 1.5, opacity: 0.75 }, inactiveOpacity: 0.06,
      data: shown.map((row) => {
        const value = columns.map((column) => cellOf(row, column));
        return chosenFew ? { value, lineStyle: selection.has(row.job_id) ? { width: 3, opacity: 1 } : { opacity: 0.1 } } : value;
      }) }],
  } };
}

function cellOf(row, column) {
  const value = valueOf(row, column);
  return typeof value === "number" ? value : value === none ? "-" : String(value);
}
