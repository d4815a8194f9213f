// SPDX-License-Identifier: Apache-2.0
// Checks answers that were written down against the OpenAPI document of the service that gave them.
//   node check_exchanges.mjs OPENAPI.json EXCHANGES.ndjson

import { readFileSync } from "node:fs";
import { Validator } from "@seriousme/openapi-schema-validator";
import { Contract } from "./contract.mjs";

const [documentFile, exchangesFile] = process.argv.slice(2);
const document = JSON.parse(readFileSync(documentFile, "utf8"));
const faults = [];

const validity = await new Validator().validate(structuredClone(document));
if (!validity.valid) faults.push(`the document is no OpenAPI 3.1: ${JSON.stringify(validity.errors, null, 1)}`);

const contract = new Contract(document);
const exchanges = readFileSync(exchangesFile, "utf8").split("\n").filter(Boolean).map((line) => JSON.parse(line));
for (const exchange of exchanges) {
  for (const fault of contract.check(exchange)) {
    faults.push(`${exchange.method} ${exchange.target.slice(0, 200)} -> ${exchange.status}: ${fault}\n  ${exchange.body.slice(0, 300)}`);
  }
}

// A suite that never succeeds in an operation says nothing of its answer.
for (const { path, method, operation } of contract.operations()) {
  const success = Object.keys(operation.responses)[0];
  const met = exchanges.some((exchange) => {
    const operationPath = contract.paths.find(({ pattern }) => pattern.test(exchange.target))?.path;
    return operationPath === path && exchange.method.toLowerCase() === method && String(exchange.status) === success;
  });
  if (!met) faults.push(`no test has met the answer ${success} of ${method} ${path}`);
}

for (const fault of faults.slice(0, 20)) console.log(fault);
console.log(`${exchanges.length} answers checked, ${faults.length} faults`);
process.exitCode = faults.length > 0 || exchanges.length === 0 ? 1 : 0;
