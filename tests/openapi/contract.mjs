// SPDX-License-Identifier: Apache-2.0
// Answers that an OpenAPI document allows a service.

import Ajv2020 from "ajv/dist/2020.js";

const documentId = "openapi.json";
// May meet any request, also one that no operation is for.
const refusals = [400, 403, 404, 405, 408, 413, 414, 415, 431, 501];
// Of HTTP, of its caches and of browsers, not of the interface.
const headersOfHttp = /^(connection|date|transfer-encoding|content-(type|length|encoding|security-policy)|cache-control|vary|www-authenticate|cross-origin-resource-policy|referrer-policy|x-content-type-options|access-control-.*)$/;

function pointerOf(...keys) {
  return `${documentId}#/${keys.map((key) => encodeURIComponent(key.replaceAll("~", "~0").replaceAll("/", "~1"))).join("/")}`;
}

function patternOf(path) {
  return new RegExp(`^${path.replaceAll(/[.]/g, "\\.").replaceAll("{id}", "[A-Za-z0-9_-]{1,64}")}$`);
}

/** A browser asks this before what it is going to ask: it is of HTTP, not of the interface. */
function isPreflight({ method, status, headers }) {
  return method === "OPTIONS" && status === 204 && "access-control-allow-methods" in headers;
}

/** Parts of the page are not of the interface: only the page names them. */
function isPartOfPage({ target }) {
  return /[.](js|css|svg|html)$|^\/linkages\//.test(target.split("?")[0]);
}

function decoded(target) {
  const path = target.split("?")[0];
  try {
    return decodeURIComponent(path);
  } catch {
    return path;
  }
}

/** Base path of the service that has one, in the tests of HTTP. */
const basePath = /^\/a\/rpsup(?=\/|$)/;

/** Whether a redirect leads to the same path with one slash more or with fewer at its end. */
function leadsToTheRightSlash({ method, target, headers, body }) {
  const path = target.split("?")[0];
  const meant = new URL(headers.location ?? "", `http://localhost${path}`).pathname;
  return method === "GET" && body === "" && meant !== path && meant.replace(/\/+$/, "") === path.replace(/\/+$/, "");
}

export class Contract {
  constructor(document) {
    this.document = document;
    // Inlining the schemas that others name, and optimising their code, takes ten times as long as checking so few values.
    this.ajv = new Ajv2020({ strict: false, allErrors: true, validateFormats: false, code: { optimize: false }, inlineRefs: false });
    this.ajv.addSchema(document, documentId);
    this.paths = Object.keys(document.paths).map((path) => ({ path, pattern: patternOf(path) }));
    this.validators = new Map();
  }

  /** Every operation: {path, method, operation}. */
  operations() {
    return Object.entries(this.document.paths).flatMap(([path, item]) =>
      Object.entries(item).map(([method, operation]) => ({ path, method, operation })));
  }

  /** The object that a reference stands for; anything else as it is. */
  resolve(value) {
    if (!value?.$ref) return value;
    return value.$ref.slice(2).split("/").reduce((at, key) => at[decodeURIComponent(key).replaceAll("~1", "/").replaceAll("~0", "~")], this.document);
  }

  /** Faults of a value, as texts. */
  faultsOf(value, ...schemaAt) {
    const pointer = pointerOf(...schemaAt);
    if (!this.validators.has(pointer)) this.validators.set(pointer, this.ajv.compile({ $ref: pointer }));
    const validate = this.validators.get(pointer);
    if (validate(value)) return [];
    return validate.errors.map((error) => `${error.instancePath || "the value"} ${error.message} ${JSON.stringify(error.params)}`);
  }

  /** Where the schema of the JSON that an operation takes stands; undefined if it takes none. */
  bodySchemaOf(path, method) {
    const body = this.document.paths[path][method].requestBody;
    return body && ["paths", path, method, "requestBody", "content", "application/json", "schema"];
  }

  /**
   * Faults of an answer, as texts; none if the document allows the answer.
   * @param recorded {method, target, status, headers (lower case), body (text)}
   */
  check(recorded) {
    const target = recorded.target.replace(/^https?:\/\/[^/?#]*/i, "") || "/";
    if (recorded.status === 308 && leadsToTheRightSlash({ ...recorded, target })) return [];
    const exchange = { ...recorded, target: target.replace(basePath, "") || "/" };
    const method = exchange.method.toLowerCase() === "head" ? "get" : exchange.method.toLowerCase();
    const path = this.paths.find(({ pattern }) => pattern.test(decoded(exchange.target)))?.path;
    const operation = path && this.document.paths[path][method];
    if (isPreflight(exchange)) return exchange.body ? ["a body where there should be none"] : [];
    if (!path && isPartOfPage(exchange)) return [200, 304].includes(exchange.status) ? [] : this.#checkProblem(exchange);
    return operation ? this.#checkAnswer(exchange, path, method) : this.#checkRefusal(exchange, path);
  }

  #checkRefusal(exchange, path) {
    if (!refusals.includes(exchange.status)) return [`${exchange.status} where there is no operation`];
    const faults = this.#checkProblem(exchange);
    if (exchange.status === 405 && !exchange.headers.allow) faults.push("405 without Allow");
    if (exchange.status === 405 && !path) faults.push("405 for a path that is in no operation");
    return faults;
  }

  #checkProblem(exchange) {
    if (exchange.headers["content-type"] !== "application/problem+json") return [`an error of type ${exchange.headers["content-type"]}`];
    if (exchange.method === "HEAD") return [];
    const { value, fault } = parsed(exchange.body);
    if (fault) return [fault];
    const faults = this.faultsOf(value, "components", "schemas", "Problem");
    if (value.status !== exchange.status) faults.push(`a problem that says ${value.status}`);
    return faults;
  }

  #checkAnswer(exchange, path, method) {
    const status = String(exchange.status);
    const given = this.document.paths[path][method].responses[status];
    if (!given) return [`${status} is none of the responses of ${method} ${path}`];
    const faults = this.#checkHeaders(exchange, this.resolve(given).headers ?? {});
    return [...faults, ...(exchange.status >= 400 ? this.#checkProblem(exchange) : this.#checkContent(exchange, path, method, given))];
  }

  /** @param described  the headers that the document has for this answer */
  #checkHeaders(exchange, described) {
    const names = Object.keys(described).map((name) => name.toLowerCase());
    const missing = Object.entries(described)
      .filter(([name, header]) => this.resolve(header).required && !(name.toLowerCase() in exchange.headers))
      .map(([name]) => `there is no header ${name}`);
    const unknown = Object.keys(exchange.headers)
      .filter((name) => !headersOfHttp.test(name) && !names.includes(name))
      .map((name) => `the header ${name} is not in the document`);
    const malformed = Object.entries(described)
      .filter(([name]) => name.toLowerCase() in exchange.headers)
      .flatMap(([name, header]) => this.#faultsOfHeader(exchange.headers[name.toLowerCase()], this.resolve(header).schema).map((fault) => `header ${name}: ${fault}`));
    return [...missing, ...unknown, ...malformed];
  }

  #faultsOfHeader(text, schema) {
    if (schema.type === "integer") return /^[0-9]+$/.test(text) ? [] : [`${text} is no integer`];
    return !schema.pattern || new RegExp(schema.pattern).test(text) ? [] : [`${text} does not match ${schema.pattern}`];
  }

  #checkContent(exchange, path, method, response) {
    if (!response.content) return exchange.body ? ["a body where there should be none"] : [];
    const type = exchange.headers["content-type"]?.split(";")[0];
    if (!response.content[type]) return [`the content type ${type}`];
    if (exchange.method === "HEAD" || type !== "application/json") return [];
    const { value, fault } = parsed(exchange.body);
    return fault ? [fault] : this.faultsOf(value, "paths", path, method, "responses", String(exchange.status), "content", type, "schema");
  }
}

export function parsed(text) {
  try {
    return { value: JSON.parse(text) };
  } catch (error) {
    return { fault: `a body that is no JSON: ${error.message}` };
  }
}
