// Why the jobs of a sweep failed: asked for apart, for few do.
import { findResults } from "/core/api.js";

export class Failures {
  #errors = new Map();

  /// {error_reason, error_detail}; nothing as long as it is not known.
  of(id) {
    return this.#errors.get(id);
  }

  /// Finds the reasons if there are some that are not known yet. @returns whether there is news
  async learn(sweep, rows, signal) {
    const failed = new Set(rows.filter(({ state }) => state === "failed").map((row) => row.job_id));
    // A job that runs again may fail for another reason.
    for (const id of this.#errors.keys()) if (!failed.has(id)) this.#errors.delete(id);
    if (this.#errors.size === failed.size) return false;
    const found = await findResults(sweep, { state: "failed", fields: "job_id,error_reason,error_detail" }, signal);
    this.#errors = new Map(found.map((row) => [row.job_id, row]));
    return true;
  }
}
