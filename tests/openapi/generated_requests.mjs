// SPDX-License-Identifier: Apache-2.0
// Sends generated requests to a service and checks each answer against its own OpenAPI document: no answer beside the document, no 5xx, and what
// is taken is what the document allows.
//   node generated_requests.mjs URL COUNT [SEED]

import fc from "fast-check";
import { Client } from "./client.mjs";
import { Contract, parsed } from "./contract.mjs";
import { requests } from "./requests.mjs";

const [url, count, seed = "1"] = process.argv.slice(2);
const client = new Client(url);
const document = JSON.parse((await client.send({ method: "GET", target: "/v1/openapi.json" })).body);
const contract = new Contract(document);
const statuses = new Map();

const short = { duration_s: 0.02, run_up_s: 0.01, output_rate_hz: 1000 };

/** A body of which the service makes jobs of a fiftieth of a second of motion, so that it keeps up. */
function tame(path, body) {
  if (path === "/v1/jobs") return { ...body, ...short };
  if (path === "/v1/wear-studies") return { ...body, parameters: { ...body.parameters, ...short }, max_cycles: 3 };
  if (!["/v1/sweeps", "/v1/searches", "/v1/optimisations"].includes(path)) return body;
  // A parameter has one place only.
  const elsewhere = JSON.stringify([body.sweep, body.design, body.cases, body.over]);
  const fixed = Object.entries(short).filter(([key]) => !elsewhere.includes(`"${key}"`));
  const few = path === "/v1/optimisations" ? { starts: 1, population: 8, budget: 16 } : {};
  return { ...body, ...few, parameters: { ...body.parameters, ...Object.fromEntries(fixed) } };
}

/** Faults in the acceptance or refusal of a body, beside the form of the answer. */
function bodyFaults(request, exchange) {
  const schemaAt = contract.document.paths[request.path]?.[request.method.toLowerCase()] && contract.bodySchemaOf(request.path, request.method.toLowerCase());
  if (!schemaAt || request.body === undefined) return [];
  const { value, fault } = parsed(request.body.replace(/^\ufeff/, ""));
  if (exchange.status < 300) return fault ? [`took ${fault}`] : contract.faultsOf(value, ...schemaAt).map((text) => `took a body that the document refuses: ${text}`);
  if (exchange.status !== 422 || fault || contract.faultsOf(value, ...schemaAt).length > 0) return [];
  return JSON.parse(exchange.body).errors.filter(({ pointer, detail }) => detail.startsWith("unknown key") && !pointer.includes("?"))
    .map(({ pointer }) => `does not know ${pointer}, which the document allows`);
}

async function check(request) {
  const exchange = await client.send(client.complete(request));
  statuses.set(exchange.status, (statuses.get(exchange.status) ?? 0) + 1);
  const faults = contract.check(exchange);
  if (exchange.status >= 500) faults.push(`answers ${exchange.status}`);
  if (exchange.method !== "HEAD") faults.push(...bodyFaults(request, exchange));
  if (faults.length > 0) throw new Error(`${exchange.method} ${exchange.target} -> ${exchange.status}\n${faults.join("\n")}\n${exchange.body.slice(0, 500)}`);
  await client.keepFew(request, exchange);
}

const began = performance.now();
try {
  await fc.assert(fc.asyncProperty(requests(contract, tame), check), { numRuns: Number(count), seed: Number(seed), endOnFailure: false });
} catch (error) {
  console.log(error.message, error.cause?.message ?? "");
  process.exitCode = 1;
}
const ready = await client.send({ method: "GET", target: "/readyz" });
if (ready.status !== 200) {
  console.log(`the service is not ready any more: ${ready.status}`);
  process.exitCode = 1;
}
// Requests that are all refused would prove little.
if (!(statuses.get(201) > 0 && statuses.get(200) > 0 && statuses.get(422) > 0)) {
  console.log("too few kinds of answers were met");
  process.exitCode = 1;
}
const met = [...statuses].sort(([a], [b]) => a - b).map(([status, times]) => `${times} of ${status}`).join(", ");
console.log(`${count} requests in ${((performance.now() - began) / 1000).toFixed(1)} s, seed ${seed}: ${met}`);
