// SPDX-License-Identifier: Apache-2.0
// Panel of a service with a cluster: slots, tasks and nodes; and of any service: problems that need attention.
import { h } from "/core/dom.js";
import { plural } from "/core/format.js";

const shownNodes = 6;

function nodesText(nodes) {
  const shown = nodes.slice(0, shownNodes).join(", ");
  return nodes.length > shownNodes ? `${shown} and ${nodes.length - shownNodes} more` : shown;
}

/** @param {Api.Executor & { tasks: object }} cluster */
function clusterText({ name, slots, tasks, nodes, waiting }) {
  const running = `${plural(tasks.running, "task")} on ${nodes.length === 0 ? "no node" : nodesText(nodes)}`;
  const reasons = waiting.map(({ reason, tasks: count }) => `${count.toLocaleString("en")} for ${reason}`).join(", ");
  return `${name}: ${plural(slots, "slot")}; ${running}; ${tasks.pending.toLocaleString("en")} `
    + `wait${reasons ? ` (${reasons})` : ""}`;
}

/** @type {(executor: Api.Executor) => executor is Api.Executor & { tasks: object }} */
const hasTasks = (executor) => executor.tasks !== null;

export function executorsPanel() {
  const element = h("section", { class: "card", hidden: true, "aria-label": "Where jobs run" });

  /** @param {Api.Executor[]} executors */
  function update(executors) {
    const clusters = executors.filter(hasTasks);
    const problems = new Set(executors.flatMap((executor) => executor.problems));
    element.hidden = clusters.length === 0 && problems.size === 0;
    element.replaceChildren(
      ...clusters.map((cluster) => h("p", { class: "small" }, clusterText(cluster))),
      ...[...problems].map((problem) => h("p", { class: "small trouble" }, problem)));
  }

  return { element, update };
}
