// SPDX-License-Identifier: Apache-2.0
// Base of the forms of studies: values whose help is that of the request's schema.
import { parameterSchema, requestSchemas } from "/core/api.js";
import { h } from "/core/dom.js";
import { nameOf, unitOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { allowed, fieldsOf } from "/form/fields.js";
import { faultOfNumber, readNumber } from "/form/numbers.js";
import { buildRequest, readRequest } from "/form/request.js";
import { RequestForm } from "/form/request_form.js";

/// Shows the form of a kind of studies. @param begin  finds the request that stands in it at first
/**
 * @param {HTMLElement} main
 * @param {typeof StudyForm} Form
 * @param {(query: URLSearchParams, signal: AbortSignal) => any} begin
 * @param {URLSearchParams} query
 * @param {AbortSignal} signal
 */
export async function showStudyForm(main, Form, begin, query, signal) {
  document.title = `RPSUP: ${Form.title.toLowerCase()}`;
  const from = query.get("from");
  const [parameters, schemas, request, more] = await Promise.all([parameterSchema(), requestSchemas(signal),
    from ? Form.api.find(from, signal).then((study) => study.request) : query.has("empty") ? {}
      : begin(query, signal),
    Form.load(signal)]);
  const form = new Form(fieldsOf(parameters), schemas, Form.adjusted(request, query), more);
  form.signal = signal;
  main.replaceChildren(h("h1", {}, Form.title),
    h("p", { class: "actions" }, h("a", { class: "button", href: routeTo(Form.route, "new") }, "Load example"),
      h("a", { class: "button", href: routeTo(Form.route, "new", { empty: "1" }) }, "Empty form")),
    form.columns(...form.parts()));
  form.update();
}

/// Its kinds have `static api`, `route`, `title`, `schema` (its request's name in the interface's description).
export class StudyForm extends RequestForm {
  /** @type {AnyStudies} */
  static api;
  static route = "";
  static title = "";
  static schema = "";

  /// Request with what an address changes in it.
  /** @param {any} request  @param {URLSearchParams} _query */
  static adjusted(request, _query) { return request; }

  /// Finds what a form needs beside its request.
  /** @param {AbortSignal} _signal  @returns {Promise<any>} */
  static async load(_signal) { return null; }

  /// @param _more  that load has found
  /**
   * @param {any[]} fields
   * @param {Record<string, any>} schemas
   * @param {any} request
   * @param {any} [_more]
   */
  constructor(fields, schemas, request, _more) {
    super(fields, { ...readRequest(fields, request), values: {} });
    const kind = /** @type {typeof StudyForm} */ (this.constructor);
    this.schema = schemas[kind.schema].properties;
    this.path = kind.api.path;
    this.route = kind.route;
    this.ask = kind.api.submit;
    for (const [key, value] of Object.entries(request)) this.state.values[key] = typeof value === "number"
      || typeof value === "string" ? String(value) : "";
  }

  /// Elements of the form.
  /** @returns {any[]} */
  parts() { return []; }

  /// A number of the request. @param unit, name  where its key does not say them
  number(key, unit = unitOf(key), name = nameOf(key)) {
    this.state.values[key] ??= "";
    return this.told(key, `${name}${unit ? ` [${unit}]` : ""}`, this.state.values, key, helpOf(this.schema[key], unit));
  }

  /// The part of the request that studies have in common with sweeps.
  buildCommon() {
    return buildRequest(this.fields, this.state);
  }

  /// Puts the numbers that have been given into a request.
  addNumbers(keys, request, problems) {
    for (const key of keys) addNumber(this.state.values[key], key, key, request, problems);
  }
}

/// Puts a number into an object, unless its text is empty. @param path  by which a fault of it is told
export function addNumber(text, key, path, object, problems) {
  if (!text?.trim()) return;
  const detail = faultOfNumber(text);
  if (detail) problems.push({ path, detail });
  else object[key] = readNumber(text);
}

/// A number in words: what it is, what is allowed, and what it is if it is left out.
export function helpOf(schema, unit = "") {
  const limits = allowed({ schema, kind: schema.type, unit });
  const fallback = schema.default === undefined ? "" : `; default ${schema.default}${unit ? ` ${unit}` : ""}`;
  const text = schema.description ?? "";
  return [text.charAt(0).toUpperCase() + text.slice(1), `${limits}${fallback}`].filter(Boolean).join(". ");
}
