// SPDX-License-Identifier: Apache-2.0
// A client of the service that sends what it is told, however strange.

import http from "node:http";

const keptSweeps = 30;
const keptJobs = 60;

/** Half a surrogate pair has no encoding; Buffer replaces it. */
function encoded(text) {
  return encodeURIComponent(Buffer.from(text).toString());
}

export class Client {
  constructor(url) {
    this.url = new URL(url);
    this.ids = { sweeps: [], searches: [], "wear-studies": [], optimisations: [], fits: [], jobs: [] };
  }

  /** The request as it is sent: {method, target, headers, body}, of a generated one. */
  complete({ method, path, id, query, headers, body }) {
    const known = this.ids[id.tag] ?? [];
    const text = typeof id === "string" ? id : known.length > 0 ? known[id.number % known.length] : "none";
    const target = path.replace("{id}", text.replaceAll(/[^\x21-\x7e]/g, encoded));
    const search = query.map(([key, value]) => `${encoded(key)}=${encoded(value)}`).join("&");
    return { method, target: search ? `${target}?${search}` : target, headers, body };
  }

  /** The answer: {method, target, status, headers, body}. Fails if there is none within 20 s. */
  send({ method, target, headers = {}, body }) {
    return new Promise((resolve, reject) => {
      const request = http.request(
        { host: this.url.hostname, port: this.url.port, method, path: target, headers, agent: false, timeout: 20_000, insecureHTTPParser: false },
        (response) => {
          const chunks = [];
          const finish = () => resolve({ method, target, status: response.statusCode, headers: response.headers, body: Buffer.concat(chunks).toString() });
          const streams = response.headers["content-type"] === "text/event-stream";
          response.on("data", (chunk) => {
            chunks.push(chunk);
            if (!streams) return;
            finish();  // it would go on until the sweep ends
            request.destroy();
          });
          response.on("error", reject);
          response.on("end", finish);
        });
      request.on("timeout", () => request.destroy(new Error(`no answer to ${method} ${target}`)));
      request.on("error", (error) => reject(new Error(`${method} ${target}: ${error.message}`)));
      request.end(body);
    });
  }

  /** Remembers what was made, and ends what is too much: the test is not about computing. */
  async keepFew(request, exchange) {
    if (exchange.status !== 201) return;
    const made = JSON.parse(exchange.body);
    const kind = exchange.headers.location.split("/")[2];
    this.ids[kind].push(made.id);
    if (this.ids[kind].length <= (kind === "jobs" ? keptJobs : keptSweeps)) return;
    const old = `/v1/${kind}/${this.ids[kind].shift()}`;
    await this.send({ method: "POST", target: `${old}/cancel` });
    if (kind !== "jobs") await this.send({ method: "DELETE", target: old });
  }
}
