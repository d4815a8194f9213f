// SPDX-License-Identifier: Apache-2.0
// Upload of a measurement: files, channels with their units, a preview, and the faults that the service
// finds.
import { Refusal, requestSchemas } from "/core/api.js";
import { loadCharts } from "/core/charts.js";
import { choice, freshId, h, notify } from "/core/dom.js";
import { plural } from "/core/format.js";
import { debounce } from "/core/live.js";
import { routeTo } from "/core/route.js";
import { channelField } from "/measure/channel_field.js";
import { faultsOf, sendDraft, sensorOf, usedChannels } from "/measure/measurement_request.js";
import { previewChart } from "/measure/preview.js";
import { readFiles } from "/measure/read_files.js";

const drawMs = 200;

/** @param {HTMLElement} main  @param {AbortSignal} signal */
export function showUpload(main, signal) {
  document.title = "RPSUP: new measurement";
  loadCharts().catch(() => {});
  const form = new UploadForm(signal);
  main.replaceChildren(h("h1", {}, "New measurement"), ...form.parts());
}

class UploadForm {
  /** @type {import("/measure/read_files.js").Draft | null} */
  draft = null;
  /** @type {File[]} */
  files = [];  // that were chosen last
  shownRun = 0;
  isSending = false;
  fields = h("div");
  preview = h("div", { class: "chart double", hidden: true });
  runPicker = h("span");
  trouble = h("div", { class: "trouble", role: "alert" });
  summary = h("p", { role: "status" });
  send = h("button", { class: "main", onclick: () => this.submit() }, "Upload");
  names = h("datalist", { id: freshId("channels") });
  /** @type {Promise<Chart | null> | undefined} */
  chart;
  /// Places of the faults of channels, by their index in the draft.
  /** @type {HTMLElement[]} */
  faults = [];
  /** @type {HTMLElement[]} */
  runFaults = [];

  /** @param {AbortSignal} signal */
  constructor(signal) {
    this.signal = signal;
    this.send.disabled = true;
    this.drawSoon = debounce(() => signal.aborted || this.drawPreview(), drawMs);
    requestSchemas(signal).then(({ Trajectory }) => this.names.append(
      ...Object.keys(Trajectory.properties.columns.properties).filter((name) => !/^(pose_|t_s$)/.test(name))
        .map((name) => h("option", { value: name })))).catch(() => {});
  }

  parts() {
    const files = h("input", { type: "file", multiple: true, accept: ".csv,.txt,.npz,.json",
      onchange: () => this.read([...files.files ?? []]) });
    return [h("p", {}, "CSV or NPZ with one run a file, or JSON with all runs. CSV has column names in its "
      + "first line, "
      + "commas between the cells and decimal points."),
    h("section", { class: "card" }, h("label", { class: "choice" }, h("span", {}, "Files"), files),
      this.fields),
    h("section", { class: "card" }, h("div", { class: "head" }, h("h2", {}, "Preview"), this.runPicker),
      this.summary, this.preview), this.trouble, h("p", { class: "actions" }, this.send), this.names];
  }

  /** @param {File[]} files */
  async read(files) {
    if (files.length === 0) return;
    this.files = files;
    this.trouble.replaceChildren();
    try {
      const draft = await readFiles(files);
      if (files !== this.files) return;  // meanwhile others have been chosen
      this.draft = draft;
      this.shownRun = 0;
      this.drawFields();
    } catch (error) {
      if (files !== this.files) return;
      this.draft = null;
      this.fields.replaceChildren();
      this.trouble.textContent = error.message;
    }
    this.changed();
  }

  drawFields() {
    const draft = /** @type {NonNullable<typeof this.draft>} */ (this.draft);
    const name = h("input", { type: "text", size: 40, value: draft.name,
      oninput: () => { draft.name = name.value; } });
    const time = choice("Time", draft.columns, draft.time, (column) => {
      draft.time = column;
      this.drawFields();
      this.changed();
    });
    this.faults = draft.channels.map(() => h("p", { class: "trouble small", hidden: true }));
    const channels = draft.channels.map((entry, index) => (entry.column === draft.time ? null
      : channelField(entry, this.faults[index], this.names.id, () => this.changed())));
    this.fields.replaceChildren(h("p", { class: "actions" },
      h("label", { class: "choice" }, h("span", {}, "Name"), name),
      draft.kind === "json" ? "" : time), h("h2", {}, "Channels"),
    h("p", { class: "quiet small" }, "A channel has the name of a job's channel; the end of the name is "
      + "its unit."),
    ...channels.filter((element) => element !== null), this.runFields());
    const runs = draft.runs.map((run, index) => [String(index), run.name]);
    this.runPicker.replaceChildren(draft.runs.length > 1 ? choice("Run", runs, String(this.shownRun),
      (run) => { this.shownRun = Number(run); this.drawPreview(); }) : "");
  }

  /// Known parameters of each run, as JSON.
  runFields() {
    const runs = this.draft?.runs ?? [];
    this.runFaults = runs.map(() => h("p", { class: "trouble small", hidden: true }));
    return h("details", { open: runs.some(({ parameters }) => parameters !== "") },
      h("summary", {}, "Known parameters of the runs"), runs.map((run, index) => {
        const area = h("textarea", { rows: 2, class: "wide", value: run.parameters,
          placeholder: "{\"crank_velocity_rad_s\": 10}",
          oninput: () => { run.parameters = area.value; this.changed(); } });
        return h("div", {}, h("label", { class: "choice" },
          h("span", {}, `${run.name}: JSON object of parameters of a job`), area), this.runFaults[index]);
      }));
  }

  changed() {
    const { draft } = this;
    const faults = draft ? faultsOf(draft) : [];
    this.complain(this.faults, faults);
    this.complain(this.runFaults, []);
    if (draft) this.trouble.replaceChildren();
    const used = draft ? usedChannels(draft) : [];
    this.send.disabled = this.isSending || used.length === 0 || faults.length > 0;
    this.drawSoon();
  }

  /** @param {HTMLElement[]} places  @param {[number, string][]} faults */
  complain(places, faults) {
    places.forEach((place, index) => {
      place.textContent = faults.filter(([at]) => at === index).map(([, text]) => text).join("; ");
      place.hidden = place.textContent === "";
    });
  }

  drawPreview() {
    const { draft } = this;
    this.preview.hidden = draft === null;
    const run = draft?.runs[this.shownRun];
    const count = draft && run ? run.columns[draft.time]?.length ?? 0 : 0;
    this.summary.textContent = draft
      ? `${plural(draft.runs.length, "run")}, ${plural(usedChannels(draft).length,
      "channel")}, ${plural(count, "sample")} in this run` : "Choose a file to see its signals.";
    if (!draft) return;
    this.chart ??= previewChart(this.preview, () => this.signals(), this.signal)
      .catch((error) => {
        this.preview.replaceChildren(h("p", { class: "trouble" }, error.message));
        return null;
      });
    this.chart.then((chart) => chart?.draw());
  }

  /// Signals of the run that is shown, corrected as the form says.
  signals() {
    const { draft } = this;
    if (!draft) return null;
    const { columns } = draft.runs[this.shownRun];
    return { time: columns[draft.time],
      signals: usedChannels(draft).map((entry) => {
        const { sign, gain, offset } = sensorOf(entry);
        return { name: entry.name.trim(), values: columns[entry.column].map((x) => sign * gain * x + offset) };
      }) };
  }

  async submit() {
    const { draft } = this;
    if (!draft || this.isSending) return;
    this.isSending = true;
    this.changed();
    try {
      const { id } = await sendDraft(draft);
      if (this.signal.aborted) notify(`Submitted: ${id}`);
      else location.hash = routeTo("measurements", id);
    } catch (error) {
      if (this.signal.aborted) notify(error.message, "trouble");
      else this.refuse(error);
    }
    this.isSending = false;
    this.send.disabled = false;
  }

  /// Shows faults at the channels and runs that they are about, and all of them above the button.
  /** @param {Error} error */
  refuse(error) {
    const { draft } = this;
    if (!draft) return;
    const faults = error instanceof Refusal && error.faults.length > 0 ? error.faults
      : [{ pointer: "", detail: error instanceof SyntaxError ? `Parameters are no JSON: ${error.message}`
        : error.message }];
    const used = usedChannels(draft);
    /** @type {(pattern: RegExp, find: (index: number) => number) => [number, string][]} */
    const at = (pattern, find) => faults.flatMap(({ pointer, detail }) => {
      const index = pattern.exec(pointer)?.[1];
      return index === undefined ? [] : [/** @type {[number, string]} */ ([find(Number(index)), detail])];
    });
    this.complain(this.faults, at(/^\/channels\/(\d+)/, (index) => draft.channels.indexOf(used[index])));
    this.complain(this.runFaults, at(/^\/runs\/(\d+)\/parameters/, (index) => index));
    this.trouble.replaceChildren(h("ul", {}, faults.map(({ pointer, detail }) =>
      h("li", {}, `${pointer ? `${pointer}: ` : ""}${detail}`))));
  }
}
