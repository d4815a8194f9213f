// SPDX-License-Identifier: Apache-2.0
// Checks that the document names the keys of every query string that the service knows, and no other.
//   node query_keys.mjs URL

import { Client } from "./client.mjs";
import { Contract } from "./contract.mjs";

const client = new Client(process.argv[2]);
const contract = new Contract(JSON.parse((await client.send({ method: "GET", target: "/v1/openapi.json" })).body));
const faults = [];
let checked = 0;

for (const { path, method, operation } of contract.operations()) {
  if (!operation.responses[422]) continue;
  const parameters = (operation.parameters ?? []).map((parameter) => contract.resolve(parameter)).filter((parameter) => parameter.in === "query");
  if (parameters.some(({ schema }) => schema.type === "object")) continue;  // takes any key
  const documented = parameters.map(({ name }) => name);
  const answer = await client.send({ method: method.toUpperCase(), target: `${path.replace("{id}", "none")}?no_such_key=1` });
  const allowed = answer.body.match(/unknown query parameter; allowed: ([^"]*)"/)?.[1] ?? `(answer ${answer.status})`;
  const expected = documented.length > 0 ? [...documented].sort().join(", ") : "none";
  if (allowed.split(", ").sort().join(", ") !== expected) faults.push(`${method} ${path}: the service allows ${allowed}, the document ${expected}`);
  ++checked;
}

for (const fault of faults) console.log(fault);
console.log(`the query strings of ${checked} operations checked, ${faults.length} faults`);
process.exitCode = faults.length > 0 || checked === 0 ? 1 : 0;
