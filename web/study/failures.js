// SPDX-License-Identifier: Apache-2.0
// Reasons why jobs of a sweep failed. They are asked for apart, for few jobs fail.
import { findResults } from "/core/api.js";
import { retryWhileUnreachable } from "/core/live.js";

export class Failures {
  /** @type {Map<string, Api.Row>} */
  #errors = new Map();
  #isDoubted = false;

  /// {error_reason, error_detail}; nothing as long as it is not known.
  /** @param {string} id */
  of(id) {
    return this.#errors.get(id);
  }

  /// Marks the known reasons as outdated: jobs that run again may fail for others.
  doubt() {
    this.#isDoubted = true;
  }

  /// Finds the reasons if there are some that are not known or doubted, and asks on while the service is away.
  /// @returns whether there is news
  /**
   * @param {string} sweep
   * @param {Api.Row[]} rows
   * @param {(text: string) => void} tell
   * @param {AbortSignal} signal
   */
  async learn(sweep, rows, tell, signal) {
    const failed = new Set(rows.filter(({ state }) => state === "failed").map((row) => row.job_id));
    for (const id of this.#errors.keys()) if (!failed.has(id)) this.#errors.delete(id);
    const isKnown = failed.size === 0 || (!this.#isDoubted && [...failed].every((id) => this.#errors.has(id)));
    this.#isDoubted = false;
    if (isKnown) return false;
    const query = { state: "failed", fields: "job_id,error_reason,error_detail" };
    const found = await retryWhileUnreachable(() => findResults(sweep, query, signal), tell, signal);
    this.#errors = new Map(found.map((row) => [row.job_id, row]));
    return true;
  }
}
