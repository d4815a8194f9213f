// SPDX-License-Identifier: Apache-2.0
// Loads the modules of views, and libraries. A module that failed is kept as such by some browsers: only a
// new page asks for it again, and how often that was tried outlives it.
import { findHealth } from "/core/api.js";

const waitsMs = [2000, 5000, 15000, 45000];
const key = "attempts";
const attempts = () => Number(sessionStorage.getItem(key) ?? 0);

/// A module is not to be had although the service answers. @param reason  as the browser tells it
export class Missing extends Error {
  constructor(reason) {
    super("A part of this page could not be loaded, although the service answers.");
    this.name = "Missing";
    this.reason = reason;
  }
}

/// @throws Missing, or Unreachable if the service does not answer either
export async function loadModule(ask, signal) {
  try {
    const module = await ask();
    sessionStorage.removeItem(key);
    return module;
  } catch (error) {
    if (!(error instanceof TypeError)) throw error;  // as which browsers tell it
    await findHealth(signal);
    throw new Missing(error.message);
  }
}

/// A function that loads a library once. A program that was built without npm has none.
/// @param drawn  name of what the library draws
/**
 * @param {string} drawn
 * @param {() => Promise<any>} load
 * @returns {() => Promise<any>}
 */
export function libraryLoader(drawn, load) {
  /** @type {Promise<any> | null} */
  let library = null;
  return () => {
    library ??= load().catch(() => {
      library = null;
      throw new Error(`The ${drawn} could not be loaded: the program was built without the npm packages of `
        + "web/, or is another one since this page was loaded. Load the page again.");
    });
    return library;
  };
}

/// Milliseconds until a missing module is to be asked for again, longer each time; null when that was tried often
/// enough.
export const nextWait = () => waitsMs[attempts()] ?? null;

/// Asks again with a new page.
export function tryAgain() {
  sessionStorage.setItem(key, String(attempts() + 1));
  location.reload();
}
