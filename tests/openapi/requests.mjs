// SPDX-License-Identifier: Apache-2.0
// Requests that an OpenAPI document allows, and others.

import fc from "fast-check";
import { broken, fromSchema } from "./from_schema.mjs";

const methods = ["GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "TRACE"];

/** Text of JSON, and text that is nearly that. */
function textOf(values) {
  const text = values.map((value) => JSON.stringify(value));
  return fc.oneof(
    { weight: 12, arbitrary: text },
    { weight: 1, arbitrary: fc.tuple(text, fc.nat(400)).map(([whole, end]) => whole.slice(0, end)) },
    { weight: 1, arbitrary: fc.tuple(text, fc.nat(400), fc.constantFrom("NaN", "\u0000", "}", ",", "\\", "1e999", "-", "\ud83d", "//")).map(
      ([whole, at, more]) => whole.slice(0, at) + more + whole.slice(at)) },
    { weight: 1, arbitrary: fc.constantFrom("", " ", "[".repeat(5000), '{"a":'.repeat(2000), '{"name":1,"name":2}', `{"name":"${"a".repeat(5000)}"}`, "\ufeff{}", "null", "name=first") },
  );
}

/** An id is a number: it stands for one of those that the service has given, as long as there are any. */
function idOf(tag) {
  return fc.oneof(
    { weight: 5, arbitrary: fc.nat(1000).map((number) => ({ tag, number })) },
    { weight: 1, arbitrary: fc.constantFrom("none", "a".repeat(64), "a".repeat(65), "..", "%2e%2e", "%00", "a%2Fb", "%", "é", "swp_0", "job_0", "a b") },
  );
}

function queryOf(operation, contract) {
  const known = (operation.parameters ?? []).map((parameter) => contract.resolve(parameter)).filter((parameter) => parameter.in === "query");
  const columns = Object.keys(contract.document.components.schemas.ResultRow.properties);
  const filter = fc.tuple(fc.constantFrom(...columns), fc.constantFrom("", "_gt", "_lt", "_ge", "_le"), fc.constantFrom("0", "0.25", "-1e3", "rigid", "succeeded", "", "nan"))
    .map(([column, suffix, value]) => [column + suffix, value]);
  const one = known.map((parameter) => parameter.schema.type === "object" ? filter : fc.oneof(
    { weight: 3, arbitrary: fromSchema(parameter.schema, (schema) => contract.resolve(schema)).map(String) },
    { weight: 1, arbitrary: fc.string({ unit: "binary", maxLength: 10 }) },
    { weight: 1, arbitrary: fc.constantFrom("", "-1", "0", "1e400", "nan", "inf", "18446744073709551616", ",", "t_s,,t_s", "csv", "0x10", " 1") },
  ).map((value) => [parameter.name, value]));
  const other = fc.tuple(fc.string({ maxLength: 6 }), fc.string({ maxLength: 6 }));
  return fc.array(fc.oneof(...one.map((arbitrary) => ({ weight: 3, arbitrary })), { weight: 1, arbitrary: other }), { maxLength: known.length > 0 ? 3 : 1 });
}

const headers = fc.record({
  accept: fc.constantFrom("*/*", "text/csv", "application/x-ndjson", "application/x-npz", "text/event-stream", "application/json", "text/html", "", "text/csv;q=0", "application/xml"),
  "accept-encoding": fc.constantFrom("identity", "br", "gzip, br"),
  "content-type": fc.constantFrom("application/json", "application/x-www-form-urlencoded", "text/plain", "multipart/form-data; boundary=x", "multipart/form-data"),
  "content-encoding": fc.constantFrom("identity", "gzip", "br", "zstd"),
  range: fc.constantFrom("bytes=0-1", "bytes=-1", "bytes=0-0,2-3", "bytes=a-b"),
  "idempotency-key": fc.constantFrom("a", "b", ""),
  "if-none-match": fc.constantFrom("*", "\"a\"", "W/\"a\""),
  prefer: fc.constantFrom("wait=0", "wait=-1", "wait=a", "respond-async"),
  expect: fc.constantFrom("100-continue", "a"),
  "last-event-id": fc.constantFrom("1", "-1", "a"),
}, { requiredKeys: [] });

/** Where a request seems to come from. */
const origins = fc.record({
  origin: fc.constantFrom("http://127.0.0.1", "http://evil.example", "null"),
  "sec-fetch-site": fc.constantFrom("same-origin", "cross-site", "none"),
  "sec-fetch-mode": fc.constantFrom("navigate", "cors"),
  host: fc.constantFrom("localhost", "evil.example", "127.0.0.1:1"),
}, { requiredKeys: [] });

/** Few seem to come from elsewhere: those are refused before they are looked at. */
const fewHeaders = fc.oneof({ weight: 8, arbitrary: fc.constant({}) }, { weight: 8, arbitrary: headers }, { weight: 1, arbitrary: origins });

function bodyOf({ path, method }, contract, tame) {
  const at = contract.bodySchemaOf(path, method);
  if (!at) return fc.oneof({ weight: 4, arbitrary: fc.constant(undefined) }, { weight: 1, arbitrary: fc.json() });
  const values = fromSchema(at.reduce((schema, key) => schema[key], contract.document), (schema) => contract.resolve(schema)).map((value) => tame(path, value));
  return fc.oneof({ weight: 1, arbitrary: textOf(values) }, { weight: 1, arbitrary: textOf(broken(values)) });
}

function requestOf(entry, contract, tame) {
  return fc.record({
    method: fc.oneof({ weight: 9, arbitrary: fc.constant(entry.method.toUpperCase()) }, { weight: 1, arbitrary: fc.constantFrom(...methods) }),
    path: fc.constant(entry.path),
    id: idOf(entry.operation.tags[0]),
    query: fc.oneof({ weight: 1, arbitrary: fc.constant([]) }, { weight: 1, arbitrary: queryOf(entry.operation, contract) }),
    headers: fewHeaders,
    body: bodyOf(entry, contract, tame),
  });
}

const astray = fc.record({
  method: fc.constantFrom(...methods),
  path: fc.webPath().map((path) => path || "/"),
  id: fc.constant("none"),
  query: fc.webQueryParameters().map((text) => [[text, ""]]),
  headers: fewHeaders,
  body: fc.oneof(fc.constant(undefined), fc.string()),
});

/**
 * Requests of every operation of the document, and some that go astray: {method, path, id, query, headers, body}.
 * @param tame  makes a body that costs the service little of a path and a valid body
 */
export function requests(contract, tame) {
  // A copy of the whole store costs the service more than any other answer.
  const weightOf = ({ path, method }) => (contract.bodySchemaOf(path, method) ? 12 : path === "/v1/store" ? 1 : path.startsWith("/v1/") ? 4 : 2);
  return fc.oneof(
    ...contract.operations().map((entry) => ({ weight: weightOf(entry), arbitrary: requestOf(entry, contract, tame) })),
    { weight: 2, arbitrary: astray },
  );
}
