// SPDX-License-Identifier: Apache-2.0
// Reads the arrays of a file that numpy.savez or savez_compressed has written.

const endSignature = 0x06054b50;
const entrySignature = 0x02014b50;
const deflated = 8;
const text = new TextDecoder("latin1");

/// Arrays of one dimension by their names. @throws an Error that says what the file is not
/** @param {ArrayBuffer} file  @returns {Promise<Record<string, number[]>>} */
export async function readNpz(file) {
  const entries = entriesOf(new DataView(file));
  const arrays = await Promise.all(entries.map(async (entry) =>
    [entry.name.replace(/\.npy$/, ""), numbersOf(await contentOf(file, entry), entry.name)]));
  return Object.fromEntries(arrays);
}

/// Entries of the central directory, which knows the sizes.
/** @param {DataView} view */
function entriesOf(view) {
  let at = view.byteLength - 22;
  while (at >= 0 && view.getUint32(at, true) !== endSignature) at -= 1;
  if (at < 0) throw new Error("This is no NPZ file.");
  const count = view.getUint16(at + 10, true);
  const entries = [];
  let place = view.getUint32(at + 16, true);
  for (let index = 0; index < count; index += 1) {
    if (view.getUint32(place, true) !== entrySignature) throw new Error("This NPZ file is damaged.");
    const nameLength = view.getUint16(place + 28, true);
    const name = text.decode(new Uint8Array(view.buffer, place + 46, nameLength));
    const header = view.getUint32(place + 42, true);
    entries.push({ name, method: view.getUint16(place + 10, true), size: view.getUint32(place + 20, true),
      from: header + 30 + view.getUint16(header + 26, true) + view.getUint16(header + 28, true) });
    place += 46 + nameLength + view.getUint16(place + 30, true) + view.getUint16(place + 32, true);
  }
  return entries;
}

/** @param {ArrayBuffer} file  @param {ReturnType<typeof entriesOf>[number]} entry */
async function contentOf(file, { method, size, from }) {
  const packed = file.slice(from, from + size);
  if (method !== deflated) return packed;
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Response(stream).arrayBuffer();
}

/// Numbers of an NPY array.
/** @param {ArrayBuffer} array  @param {string} name */
function numbersOf(array, name) {
  const view = new DataView(array);
  const isLong = view.getUint8(6) > 1;
  const length = isLong ? view.getUint32(8, true) : view.getUint16(8, true);
  const from = (isLong ? 12 : 10) + length;
  const header = text.decode(new Uint8Array(array, from - length, length));
  const type = /'descr': *'([^']+)'/.exec(header)?.[1];
  const data = array.slice(from);
  if (type === "<f8") return Array.from(new Float64Array(data));
  if (type === "<f4") return Array.from(new Float32Array(data));
  throw new Error(`The array ${name} has the type ${type}; float64 and float32 can be read.`);
}
