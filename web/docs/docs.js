// SPDX-License-Identifier: Apache-2.0
// Shows the OpenAPI document of this service, with a form for each request. Nothing is asked of another site.
// The theme that was chosen on the other pages.
const theme = localStorage.getItem("theme");
if (theme === "light" || theme === "dark") document.documentElement.dataset.theme = theme;

window.SwaggerUIBundle({
  url: "v1/openapi.json",  // of the page at /docs
  domNode: document.querySelector("#interface"),
  validatorUrl: null,
  tryItOutEnabled: true,
  deepLinking: true,
});
