// SPDX-License-Identifier: Apache-2.0
// Editor of a described linkage: its JSON text beside the linkage in 3-D, its parts, and its faults.
// A click on a part or a fault selects its place in the text.
import { Refusal, findAssembly } from "/core/api.js";
import { freshId, h, swatch } from "/core/dom.js";
import { plural } from "/core/format.js";
import { debounce, latest } from "/core/live.js";
import { lineOf, placeOf, placesIn } from "/form/json_places.js";
import { inLinkage, partsOf, wordsOfPointer } from "/form/linkage_words.js";
import { bodyColours } from "/scene/described.js";
import { Preview } from "/scene/preview.js";

const settleMs = 400;
const linesAbove = 3;  // of a place that is scrolled into sight
const freedomsLeft = "Degrees of freedom without a drive, those of play and bending among them";

export class LinkageEditor {
  fault = h("p", { class: "trouble small", hidden: true });
  state = h("p", { class: "small", role: "status" });
  faults = h("ul", { class: "parts trouble small", "aria-label": "Faults of the linkage" });
  parts = h("div", { class: "small" });
  asked = "";  // parameters of the last question
  /** @type {any} */
  parameters = {};
  /** @type {Map<string, string>} */
  colours = new Map();

  /// @param text     that stands in it at first  @param changed  is called with the text after each change
  /// @param goTo     shows the field of the form that a fault outside the linkage means
  /**
   * @param {string} text
   * @param {(text: string) => void} changed
   * @param {(pointer: string) => void} goTo
   * @param {AbortSignal} signal
   */
  constructor(text, changed, goTo, signal) {
    this.goTo = goTo;
    const id = freshId("linkage");
    this.area = h("textarea", { rows: 3, class: "wide code", value: text, id, wrap: "off",
      spellcheck: "false", oninput: () => changed(this.area.value) });
    this.preview = new Preview(signal);
    this.seen = h("div", {}, this.preview.element, this.state, this.faults);
    this.element = h("div", { class: "editor" },
      h("div", {}, h("label", { class: "choice wide", for: id }, "Linkage: JSON object of bodies and joints"),
        this.area, this.fault), this.seen, this.parts);
    this.ask = latest((current) => this.#assemble(current), signal);
    this.askSoon = debounce(() => signal.aborted || this.ask(), settleMs);
  }

  /// Takes what the form holds. @param parameters  of a job
  /** @param {any} parameters */
  update(parameters) {
    this.parameters = parameters;
    const text = this.area.value;
    const isEmpty = text.trim() === "";
    this.area.rows = isEmpty ? 3 : 20;
    this.element.classList.toggle("open", !isEmpty);
    this.seen.hidden = isEmpty;
    this.parts.hidden = isEmpty;
    if (isEmpty) return;
    const { fault } = placesIn(text);
    if (fault) {
      const { line, column } = lineOf(text, fault.at);
      this.asked = "";
      this.#tell([{ words: `line ${line}, column ${column}`, detail: fault.detail,
        go: () => this.#select(fault.at, Math.min(fault.at + 1, text.length)) }]);
      return;
    }
    this.#drawParts(JSON.parse(text));
    const asked = JSON.stringify(parameters);
    if (asked === this.asked || typeof parameters?.linkage !== "object") return;
    this.asked = asked;
    this.askSoon();
  }

  /** @param {string} text */
  complain(text) {
    this.fault.textContent = text;
    this.fault.hidden = text === "";
    this.area.setAttribute("aria-invalid", text === "" ? "false" : "true");
  }

  /// Draws the linkage as the service assembles it, or says what keeps it from being assembled.
  /** @param {AbortSignal} current */
  async #assemble(current) {
    const { linkage } = this.parameters;
    try {
      const { poses, undriven_freedoms: freedoms } = await findAssembly(this.parameters, current);
      this.#tell([]);
      this.state.textContent = `Assembled at t = 0.${freedoms === null ? "" : ` ${freedomsLeft}: ${freedoms}.`}`;
      this.colours = new Map(bodyColours(linkage));
      this.#drawParts(linkage);
      await this.preview.show(linkage, poses);
    } catch (error) {
      if (error.name === "AbortError") throw error;
      const faults = error instanceof Refusal && error.faults.length > 0 ? error.faults
        : [{ pointer: "", detail: error.message }];
      this.#tell(faults.map(({ pointer, detail }) => ({ words: pointer ? wordsOfPointer(pointer) : "", detail,
        go: () => this.#goTo(pointer) })));
    }
  }

  /// Lists faults. The picture stays meanwhile.
  /** @param {{ words: string, detail: string, go: () => void }[]} faults */
  #tell(faults) {
    this.faults.replaceChildren(...faults.map(({ words, detail, go }) =>
      h("li", {}, h("button", { type: "button", class: "link", onclick: go },
        words ? `${words}: ${detail}` : detail))));
    this.faults.hidden = faults.length === 0;
    if (faults.length === 0) return;
    const isOld = this.preview.element.hasChildNodes();
    this.state.textContent = plural(faults.length, "fault")
      + `${isOld ? "; the picture shows the last position that was assembled" : ""}.`;
  }

  /** @param {any} linkage */
  #drawParts(linkage) {
    const isObject = typeof linkage === "object" && linkage !== null;
    const lists = isObject ? partsOf(linkage, this.parameters?.clearance_mm) : [];
    const text = JSON.stringify([lists, [...this.colours]]);
    if (text === this.drawn) return;  // a button that stays keeps the focus
    this.drawn = text;
    this.parts.replaceChildren(...lists.map(({ title, parts }) => h("section", {}, h("h3", {}, title),
      h("ul", { class: "parts" }, parts.map(({ name, words, pointer }) => h("li", {},
        title === "Bodies" && this.colours.has(name) ? [swatch(this.colours.get(name) ?? ""), " "] : "",
        h("button", { type: "button", class: "link", title: "Select in the text",
          onclick: () => this.#goTo(`/linkage${pointer}`) }, name), ` ${words}`))))));
  }

  /// Selects the place that a pointer of the service means.
  /** @param {string} pointer */
  #goTo(pointer) {
    const within = inLinkage(pointer);
    const place = within === null ? null : placeOf(placesIn(this.area.value), within);
    if (place) this.#select(place.keyStart, place.end);
    else if (pointer) this.goTo(pointer);
    else this.area.focus();
  }

  /** @param {number} start  @param {number} end */
  #select(start, end) {
    const { area } = this;
    area.focus({ preventScroll: true });
    area.setSelectionRange(start, end);
    const { line } = lineOf(area.value, start);
    area.scrollTop = (line - 1 - linesAbove) * parseFloat(getComputedStyle(area).lineHeight);
    area.scrollIntoView({ block: "nearest" });
  }
}
