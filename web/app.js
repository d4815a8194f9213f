// Shows the sweeps of this service in a table and keeps it up to date. Every text goes in as text, never as markup.

const busyPollMs = 1000;
const idlePollMs = 5000;
const jobStates = ["queued", "running", "succeeded", "failed", "cancelled"];

const status = document.querySelector("#status");
const table = document.querySelector("#sweeps");
const rows = document.querySelector("#sweeps tbody");
const empty = document.querySelector("#empty");

document.querySelector("#example").textContent =
  `curl -d '{"name": "first", "sweep": {"clearance_mm": [0, 0.25, 0.5]}}' ${location.origin}/v1/sweeps`;

function cell(className, ...content) {
  const element = document.createElement("td");
  element.className = className;
  element.append(...content);
  return element;
}

function link(text, href) {
  const element = document.createElement("a");
  element.textContent = text;
  element.href = href;
  return element;
}

function progressOf(sweep) {
  const bar = document.createElement("progress");
  bar.value = sweep.progress;
  const percent = `${Math.floor(100 * sweep.progress)} %`;
  bar.setAttribute("aria-label", `Progress ${percent}`);
  return [bar, ` ${percent}`];
}

function countsOf(sweep) {
  return jobStates
    .filter((state) => sweep.counts[state] > 0)
    .map((state) => `${sweep.counts[state]} ${state}`)
    .join(", ");
}

function rowOf(sweep) {
  const results = `/v1/sweeps/${encodeURIComponent(sweep.id)}/results`;
  const row = document.createElement("tr");
  row.append(
    cell("name", link(sweep.name || sweep.id, `/v1/sweeps/${encodeURIComponent(sweep.id)}`)),
    cell(sweep.state, sweep.state),
    cell("progress", ...progressOf(sweep)),
    cell("jobs", countsOf(sweep)),
    cell("created", sweep.created_at),
    cell("results", link("CSV", `${results}?format=csv`), link("JSON", `${results}?format=json`)),
  );
  return row;
}

function show(page) {
  const sweeps = page.items;
  rows.replaceChildren(...sweeps.map(rowOf));
  table.hidden = sweeps.length === 0;
  empty.hidden = sweeps.length > 0;
  const busy = sweeps.filter((sweep) => sweep.state === "queued" || sweep.state === "running").length;
  const shown = page.next_cursor ? `The newest ${sweeps.length} sweeps` : `${sweeps.length} ${sweeps.length === 1 ? "sweep" : "sweeps"}`;
  status.textContent = `${shown}, ${busy} under way`;
  status.className = "";
  return busy > 0;
}

async function refresh() {
  let busy = false;
  try {
    const answer = await fetch("/v1/sweeps?limit=100");
    if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
    busy = show(await answer.json());
  } catch (error) {
    status.textContent = `The service does not answer (${error.message}). Trying again …`;
    status.className = "trouble";
  }
  setTimeout(refresh, busy ? busyPollMs : idlePollMs);
}

refresh();
