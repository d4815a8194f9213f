// SPDX-License-Identifier: Apache-2.0
// Shows the OpenAPI document of this service, with a form for each request. Nothing is asked of another site.
const root = document.documentElement;
const place = document.querySelector("#interface");
// The theme that was chosen on the other pages.
const theme = localStorage.getItem("theme");
if (theme === "light" || theme === "dark") root.dataset.theme = theme;

const systemDark = matchMedia("(prefers-color-scheme: dark)");
const drawTheme = () => {
  const drawn = root.dataset.theme ?? (systemDark.matches ? "dark" : "light");
  root.classList.toggle("dark-mode", drawn === "dark");
};
systemDark.addEventListener("change", drawTheme);
drawTheme();

/// Parts of Swagger UI in other words: no choice among the one server, and no link inside a button.
const parts = () => ({ wrapComponents: {
  ServersContainer: () => () => null,
  DeepLink: (_, { React }) => ({ text }) => React.createElement("span", { className: "nostyle" }, text),
} });

/** @type {(element: Element, name: string, text: string) => void} */
function give(element, name, text) {
  if (element.getAttribute(name) !== text) element.setAttribute(name, text);
}

/// Name of a field: that of its parameter, or what Swagger UI writes above it.
/** @param {Element} field */
function nameOfField(field) {
  const parameter = field.closest("tr[data-param-name]");
  if (parameter) return parameter.getAttribute("data-param-name") ?? "";
  return field.tagName === "TEXTAREA" ? "Request body" : field.getAttribute("name") ?? "Media type";
}

/// Roles and names that Swagger UI leaves out, for all that it has drawn by now.
function mend() {
  if (!place) return;
  for (const [part, name] of [[".information-container", "About"], [".scheme-container", "Authorization"]]) {
    for (const element of place.querySelectorAll(part)) {
      give(element, "role", "region");
      give(element, "aria-label", name);
    }
  }
  for (const [headings, level] of [["h3.opblock-tag, .models > h4", "2"], [".opblock h4", "3"],
    [".opblock h5", "4"]]) {
    for (const heading of place.querySelectorAll(headings)) give(heading, "aria-level", level);
  }
  for (const operation of place.querySelectorAll(".opblock.is-open")) {
    const said = operation.querySelector(".opblock-summary-path")?.textContent ?? "";
    const method = operation.querySelector(".opblock-summary-method")?.textContent ?? "";
    for (const table of operation.querySelectorAll(".responses-table")) {
      const live = table.matches(".live-responses-table") ? ", live" : "";
      give(table, "aria-label", `Responses of ${method} ${said}${live}`);
    }
    const fields = /** @type {NodeListOf<HTMLInputElement>} */ (
      operation.querySelectorAll("select, textarea, input"));
    for (const field of fields) {
      if (!field.labels?.length && !field.ariaLabel) give(field, "aria-label", nameOfField(field));
    }
    for (const text of operation.querySelectorAll("pre")) give(text, "tabindex", "0");
  }
}

if (place) new MutationObserver(mend).observe(place, { childList: true, subtree: true });

window.SwaggerUIBundle({
  url: "v1/openapi.json",  // of the page at /docs
  domNode: place,
  validatorUrl: null,
  tryItOutEnabled: true,
  deepLinking: true,
  syntaxHighlight: { activated: false },  // its colours are too faint, and a long example takes seconds
  plugins: [parts],
});
