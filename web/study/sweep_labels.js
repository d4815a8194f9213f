// SPDX-License-Identifier: Apache-2.0
// Name, notes and tags of a sweep: how they are shown, and the dialog that changes them.
import { Refusal, changeSweep } from "/core/api.js";
import { formDialog } from "/core/dialog.js";
import { freshId, h } from "/core/dom.js";

/// Tags as badges, with a space before each.
/** @param {Api.Labels} labels */
export const tagBadges = ({ tags = [] }) =>
  tags.flatMap((tag) => [" ", h("span", { class: "badge tag" }, tag)]);

/// Words of a list without empty and repeated ones: "worn, bench 2" has two.
/** @param {string} text */
const tagsIn = (text) => [...new Set(text.split(",").map((tag) => tag.trim()).filter(Boolean))];

/// Dialog in which name, notes and tags are changed. Resolves to the sweep; to null if it stays as it is.
/** @param {Pick<Api.Sweep, "id" | "name"> & Api.Labels} sweep  @returns {Promise<Api.Sweep | null>} */
export function editLabels({ id, name, notes = "", tags = [] }) {
  const help = freshId("tags");
  const fields = {
    name: h("input", { type: "text", class: "wide", value: name }),
    notes: h("textarea", { rows: 6, class: "wide", value: notes }),
    tags: h("input", { type: "text", class: "wide", value: tags.join(", "), "aria-describedby": help }),
  };
  const labelled = (text, field) =>
    h("p", {}, h("label", { class: "choice wide" }, h("span", {}, text), field));
  const content = [labelled("Name", fields.name), labelled("Notes", fields.notes),
    labelled("Tags", fields.tags),
    h("p", { class: "quiet small", id: help }, "Tags stand between commas.")];
  return formDialog("Name, notes and tags", content, "Save", async () => {
    for (const field of Object.values(fields)) field.removeAttribute("aria-invalid");
    try {
      return await changeSweep(id, { name: fields.name.value.trim(), notes: fields.notes.value,
        tags: tagsIn(fields.tags.value) });
    } catch (error) {
      const faults = error instanceof Refusal ? error.faults : [];
      for (const { pointer } of faults) fields[pointer.split("/")[1]]?.setAttribute("aria-invalid", "true");
      throw error;
    }
  });
}
