// SPDX-License-Identifier: Apache-2.0
// Linkages that a form can begin with, each with its picture. script/linkage_pictures draws the pictures.
import { addressOf } from "/core/api.js";
import { h } from "/core/dom.js";
import { routeTo } from "/core/route.js";

/// Names of the files in web/linkages/, titles and sentences. The first one is the built-in linkage.
const linkages = [
  ["", "RPSUP", "The paper's linkage, by its own parameters."],
  ["rpsup", "RPSUP as data", "The same linkage, described by its bodies and joints."],
  ["rsup", "RSUP", "A spatial slider-crank of four joints."],
  ["slider_crank", "Planar slider-crank", "Clearance at both ends of the rod."],
  ["four_bar", "Four-bar", "Its coupler is a flexible beam."],
  ["motor_press", "Press", "A motor with flywheel works against a load."],
  ["loose_guide", "Loose guide", "A slider has play in its guide."],
  ["loose_socket", "Loose socket", "A pendulum hangs on a ball with play in its socket."],
  ["double_pendulum", "Double pendulum", "Two bars, fitted to a measured motion."],
  ["bricard", "Bricard's linkage", "Six hinges that move though they should not."],
];

/// Names of the described ones.
export const exampleNames = linkages.map(([name]) => name).filter(Boolean);

/// Cards to choose among. @param chosen  the name of the one in the form; null: none of them
/** @param {string | null} chosen */
export function linkageGallery(chosen) {
  /** @param {string[]} linkage */
  const card = ([name, title, text]) => h("a", { href: routeTo("new", "", name ? { linkage: name } : {}),
    "aria-current": name === chosen ? "true" : null },
    h("img", { src: addressOf(`/figures/linkages/${name || "rpsup"}.svg`), alt: "", width: 160,
      height: 110 }),
    h("strong", {}, title), h("span", { class: "small" }, text));
  return h("ul", { class: "gallery", "aria-label": "Linkages to begin with" },
    linkages.map((linkage) => h("li", {}, card(linkage))));
}
