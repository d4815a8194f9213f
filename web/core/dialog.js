// SPDX-License-Identifier: Apache-2.0
// Dialogs: a question, and a small form.
import { freshId, h } from "/core/dom.js";

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

/// A form in a dialog, which stays open, with the reason, while what it does is refused.
/// Resolves to the outcome; to null if the dialog is closed without one.
/**
 * @template Outcome
 * @param {string} title
 * @param {HTMLElement[]} content
 * @param {string} action
 * @param {() => Promise<Outcome>} act
 * @returns {Promise<Outcome | null>}
 */
export function formDialog(title, content, action, act) {
  return new Promise((resolve) => {
    /** @type {Outcome | null} */
    let outcome = null;
    const heading = freshId("dialog");
    const trouble = h("p", { class: "trouble small", role: "alert" });
    const send = h("button", { class: "main" }, action);
    const form = h("form", { novalidate: true, onsubmit: async (event) => {
      event.preventDefault();
      send.disabled = true;
      trouble.textContent = "";
      try {
        outcome = await act();
        dialog.close();
      } catch (error) {
        trouble.textContent = error.message;
      }
      send.disabled = false;
    } }, ...content, trouble, h("p", { class: "actions" }, send,
      h("button", { type: "button", onclick: () => dialog.close() }, "Cancel")));
    const dialog = h("dialog", { class: "form", "aria-labelledby": heading, onclose: () => {
      dialog.remove();
      resolve(outcome);
    } }, h("h2", { id: heading }, title), form);
    document.body.append(dialog);
    dialog.showModal();
  });
}
