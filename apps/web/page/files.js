// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// Files from the network or a drop, for the viewer's file system.

// Fetches with progress: on_progress(done, total), total 0 if the server does not state it.
export async function fetch_bytes(url, on_progress) {
  let response;
  try {
    response = await fetch(url);
  } catch {
    throw new Error(`${url} cannot be reached; if it lies on another server, that one must allow it (CORS)`);
  }
  if (!response.ok) throw new Error(`${url}: the server answers ${response.status}; check the address`);
  // The length of a compressed answer is not that of its content.
  const total = response.headers.get('content-encoding') ? 0 : Number(response.headers.get('content-length')) || 0;
  const pieces = [];
  let done = 0;
  const reader = response.body.getReader();
  for (;;) {
    const piece = await reader.read();
    if (piece.done) break;
    pieces.push(piece.value);
    done += piece.value.length;
    on_progress(done, total);
  }
  const bytes = new Uint8Array(done);
  let at = 0;
  for (const piece of pieces) {
    bytes.set(piece, at);
    at += piece.length;
  }
  return bytes;
}

// Files of a tar archive (ustar, without links): [{ name, bytes }].
export function untar(bytes, name) {
  const text = (from, size) => {
    const field = bytes.subarray(from, from + size);
    const end = field.indexOf(0);
    return new TextDecoder().decode(end < 0 ? field : field.subarray(0, end));
  };
  const files = [];
  for (let at = 0; at + 512 <= bytes.length && bytes[at] !== 0;) {
    if (!text(at + 257, 5).startsWith('ustar')) throw new Error(`${name}: is no tar archive; pack the world's folder with tar`);
    const size = parseInt(text(at + 124, 12), 8);
    if (!(size >= 0) || at + 512 + size > bytes.length) throw new Error(`${name}: ends in the middle of a file; fetch it again`);
    const kind = text(at + 156, 1);
    if (kind === '0' || kind === '') files.push({ name: text(at, 100), bytes: bytes.subarray(at + 512, at + 512 + size) });
    at += 512 + Math.ceil(size / 512) * 512;
  }
  return files;
}

// All files of a drop, folders included: [{ name, bytes }].
export async function dropped_files(transfer) {
  const files = [];
  const take = async (entry, path) => {
    if (entry.isFile) {
      const file = await new Promise((done, failed) => entry.file(done, failed));
      files.push({ name: path + file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
      return;
    }
    const reader = entry.createReader();
    for (;;) {
      const some = await new Promise((done, failed) => reader.readEntries(done, failed));
      if (some.length === 0) return;
      for (const inner of some) await take(inner, path + entry.name + '/');
    }
  };
  // Entries are invalid once the event's function waits: get all of them first.
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  for (const entry of entries) await take(entry, '');
  return files;
}

// Writes files into a folder of the viewer's file system and returns the paths by kind: replay, world, scenario, model.
export function store(FS, folder, files) {
  const found = {};
  for (const { name, bytes } of files) {
    if (name.endsWith('.tar')) {
      Object.assign(found, store(FS, folder, untar(bytes, name)));
      continue;
    }
    const parts = name.split('/').filter((part) => part !== '' && part !== '.' && part !== '..');
    if (parts.length === 0) continue;
    FS.mkdirTree([folder, ...parts.slice(0, -1)].join('/'));
    const path = [folder, ...parts].join('/');
    FS.writeFile(path, bytes);
    if (parts.at(-1) === 'manifest.thm') found.world = path.slice(0, path.lastIndexOf('/'));
    else if (name.endsWith('.replay')) found.replay = path;
    else if (name.endsWith('.toml')) found.scenario = path;
    else if (/\.(obj|ply|bsp|wkt|bpt|zonel|glb|gltf|fbx|stl|dae|ifc|3ds|json|gml|geojson)$/i.test(name)) found.model = path;
    else found.other = found.other ?? path;
  }
  return found;
}
