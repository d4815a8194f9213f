// SPDX-License-Identifier: Apache-2.0
// The address of a view: #/KIND/ID?key=value. Every view can be linked to.

/** @returns {{ kind: string, id: string, query: URLSearchParams }} */
export function readRoute() {
  const [path, search = ""] = location.hash.replace(/^#\/?/, "").split("?");
  const [kind = "", id = ""] = path.split("/").map(decodeURIComponent);
  return { kind, id, query: new URLSearchParams(search) };
}

/// The address of a view. Keys without a value are left out.
/** @param {string} kind  @param {string} id  @param {Record<string, any>} query */
export function routeTo(kind, id = "", query = {}) {
  const search = new URLSearchParams(Object.entries(query)
    .filter(([, value]) => value !== "" && value !== null && value !== undefined));
  const path = id ? `${kind}/${encodeURIComponent(id)}` : kind;
  return `#/${path}${search.size > 0 ? `?${search}` : ""}`;
}

/// Writes what is shown into the address, without leaving the view.
export function rememberQuery(query) {
  const { kind, id } = readRoute();
  history.replaceState(null, "", routeTo(kind, id, query));
}
