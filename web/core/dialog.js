// SPDX-License-Identifier: Apache-2.0
import { h } from "/core/dom.js";

/// Asks before something that cannot be undone. Resolves to whether it is wanted.
export function confirmed(question, action) {
  return new Promise((resolve) => {
    const dialog = h("dialog", { "aria-label": question, onclose: () => {
      dialog.remove();
      resolve(dialog.returnValue === "yes");
    } },
      h("p", {}, question),
      h("p", { class: "actions" },
        h("button", { class: "danger", onclick: () => dialog.close("yes") }, action),
        h("button", { autofocus: true, onclick: () => dialog.close("") }, "Keep it")));
    document.body.append(dialog);
    dialog.showModal();
  });
}
