// SPDX-License-Identifier: Apache-2.0
// Places of the values of a JSON text, and of its first fault.

/**
 * Stretch of a text: the value, and the value with its key before it.
 * @typedef {{ start: number, end: number, keyStart: number }} Place
 * @typedef {{ places: Map<string, Place>, fault: { at: number, detail: string } | null }} Places
 */

const literal = /-?(?:0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?|true|false|null/y;
const string = /"(?:[^"\\\p{Cc}]|\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4}))*"/uy;

/// A key as a part of a JSON pointer.
/** @type {(key: string | number) => string} */
const escaped = (key) => String(key).replaceAll("~", "~0").replaceAll("/", "~1");

/// Places of all values by their JSON pointers, the whole text's being "". Of a faulty text: those before the
/// fault.
/** @param {string} text  @returns {Places} */
export function placesIn(text) {
  /** @type {Map<string, Place>} */
  const places = new Map();
  let at = 0;

  /** @param {string} detail  @returns {never} */
  function refuse(detail) {
    throw Object.assign(new SyntaxError(detail), { at });
  }

  function skip() {
    while (at < text.length && " \t\r\n".includes(text[at])) at += 1;
  }

  /// Text that the pattern matches here; "" if there is none.
  /** @param {RegExp} pattern */
  function taken(pattern) {
    pattern.lastIndex = at;
    const [found] = pattern.exec(text) ?? [""];
    at += found.length;
    return found;
  }

  /** @param {string} sign */
  function expect(sign, where = "") {
    skip();
    if (at >= text.length) refuse(`the text ends before “${sign}”`);
    if (text[at] !== sign) refuse(`“${sign}” is expected${where}`);
    at += 1;
  }

  /// Members up to the closing sign, with commas between them.
  /** @param {string} closing  @param {(index: number) => void} take */
  function list(closing, take) {
    at += 1;
    skip();
    if (text[at] === closing) {
      at += 1;
      return;
    }
    for (let index = 0; ; index += 1) {
      take(index);
      skip();
      if (text[at] === closing) break;
      expect(",", ` or “${closing}”`);
    }
    at += 1;
  }

  /** @param {string} pointer */
  function member(pointer) {
    skip();
    const keyStart = at;
    const key = taken(string);
    if (key === "") refuse("a name in double quotes is expected");
    expect(":", " after a name");
    value(`${pointer}/${escaped(JSON.parse(key))}`, keyStart);
  }

  /** @param {string} pointer */
  function value(pointer, keyStart = -1) {
    skip();
    const place = { start: at, end: text.length, keyStart: keyStart < 0 ? at : keyStart };
    places.set(pointer, place);
    if (text[at] === "{") list("}", () => member(pointer));
    else if (text[at] === "[") list("]", (index) => value(`${pointer}/${index}`));
    else if (taken(string) === "" && taken(literal) === "") refuse("a value is expected");
    place.end = at;
  }

  try {
    value("");
    skip();
    if (at < text.length) refuse("nothing may follow the end of the object");
    return { places, fault: null };
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    return { places, fault: { at, detail: error.message } };
  }
}

/// Place that a pointer means; where there is none, that of the nearest value around it.
/** @param {Places} found  @param {string} pointer  @returns {Place | null} */
export function placeOf({ places }, pointer) {
  for (let around = pointer; ; around = around.slice(0, around.lastIndexOf("/"))) {
    const place = places.get(around);
    if (place) return place;
    if (!around.includes("/")) return null;
  }
}

/// Line and column of an offset, both from 1.
/** @param {string} text  @param {number} at */
export function lineOf(text, at) {
  const before = text.slice(0, at).split("\n");
  return { line: before.length, column: (before.at(-1) ?? "").length + 1 };
}
