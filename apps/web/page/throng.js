// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// The page: loads the viewer, opens what the address names or what is dropped, and shows a sentence for
// each fault. docs/web.md lists the address's parameters.
import { dropped_files, fetch_bytes, store } from './files.js';
import { Input } from './input.js';

const $ = (id) => document.getElementById(id);
const canvas = $('canvas');
const parameters = new URLSearchParams(location.search);
const kSettings = 'throng.settings';

// Notices -----------------------------------------------------------------------------------------

let stopped = false;

function show_progress(sentence, share) {
  if (stopped) return;
  const notice = $('notice');
  notice.hidden = false;
  notice.className = '';
  $('sentence').textContent = sentence;
  $('dismiss').hidden = true;
  $('progress').hidden = false;
  if (share === undefined) $('progress').removeAttribute('value');
  else $('progress').value = share;
}

function hide_notice() {
  if (!stopped) $('notice').hidden = true;
}

// Shows a fault; with `end`, the page stops.
function complain(sentence, end = false) {
  if (stopped) return;
  stopped = end;
  $('notice').hidden = false;
  $('notice').className = 'fault';
  $('sentence').textContent = sentence;
  $('progress').hidden = true;
  $('dismiss').hidden = end;
}

const words = (fault) => (fault instanceof Error ? fault.message : String(fault));

// What a browser needs ----------------------------------------------------------------------------

function what_is_missing() {
  if (typeof WebAssembly !== 'object') return 'This page needs WebAssembly, which this browser does not have; a current Chrome, Edge, Firefox or Safari does.';
  // A function that makes a vector of zeros.
  const vectors = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);
  if (!WebAssembly.validate(vectors)) return 'This page needs WebAssembly with vector instructions; update this browser (Chrome 91, Firefox 89, Safari 16.4 have them).';
  if (!document.createElement('canvas').getContext('webgl2')) {
    return 'This page draws with WebGL 2, which this browser does not offer now. Switch on "use graphics acceleration" in its settings, or open the page in a current Chrome, Edge, Firefox or Safari.';
  }
  return '';
}

// The viewer --------------------------------------------------------------------------------------

let viewer = null;  // Emscripten's module.
let input = null;
let opened = 0;
let known_world = '';  // For a recording that is dropped without its world.
let last_fault = '';

const text_call = (name, ...given) => viewer.ccall(name, 'string', given.map((one) => typeof one), given);

function start_sentence() {
  return viewer.ccall('throng_error', 'string', [], []);
}

// The avatars' atlas in blocks that this card reads: S3TC on desktops, ETC2 on phones. The viewer unpacks other blocks.
function figure_file() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const s3tc = gl?.getExtension('WEBGL_compressed_texture_s3tc'), etc2 = gl?.getExtension('WEBGL_compressed_texture_etc');
  return etc2 && !s3tc ? 'people_etc2.atlas' : 'people.atlas';
}

async function begin() {
  const missing = what_is_missing();
  if (missing) {
    complain(missing, true);
    return;
  }
  show_progress('Loading the viewer', 0);
  const shared = (from, to, what) => (done, total) => show_progress(what, total > 0 ? from + (to - from) * done / total : undefined);
  const wasmBinary = await fetch_bytes('throng_web.wasm', shared(0, 0.6, 'Loading the viewer'));
  const figure = await fetch_bytes(figure_file(), shared(0.6, 0.9, 'Loading the people'));
  const font = await fetch_bytes('panel.ttf', () => {}).catch(() => null);  // Without it the built-in font is used.
  show_progress('Starting', 0.95);
  viewer = await window.make_throng({
    wasmBinary,
    print: (line) => console.log(line),
    printErr: (line) => console.warn(line),
    onAbort: (what) => complain(`The viewer has stopped (${what}). Reload the page; if it happens again, open a smaller world.`, true),
  });
  viewer.FS.mkdirTree('/throng');
  viewer.FS.writeFile('/throng/people.atlas', figure);
  if (font) viewer.FS.writeFile('/throng/panel.ttf', font);
  fit();
  const begun = viewer.ccall('throng_start', 'boolean', ['string', 'string', 'number'], ['#canvas', kept_settings(), ratio()]);
  if (!begun) throw new Error(start_sentence());
  input = new Input(canvas, {
    move: (x, y) => viewer._throng_move(x, y),
    button: (which, down, x, y) => viewer._throng_button(which, down, x, y),
    wheel: (notches) => viewer._throng_wheel(notches),
    leave: () => viewer._throng_leave(),
    key: (code, down) => viewer.ccall('throng_key', null, ['string', 'boolean'], [code, down]),
    text: (unicode) => viewer._throng_text(unicode),
    gamepad: (...sticks) => viewer._throng_gamepad(...sticks),
  });
  hide_notice();
  $('buttons').hidden = parameters.get('buttons') === '0';
  for (const name of parameters.getAll('overlay')) viewer.ccall('throng_show_overlay', null, ['string'], [name]);
  const camera = (parameters.get('camera') ?? '').split(',').map(Number);
  if (camera.length === 6 && camera.every(Number.isFinite)) viewer._throng_look(...camera);
  requestAnimationFrame(frame);
  await open_address();
}

function kept_settings() {
  let settings = {};
  try {
    settings = JSON.parse(localStorage.getItem(kSettings) ?? '{}') ?? {};
  } catch { /* A page without storage has no settings. */ }
  if (Object.keys(settings).length === 0 && canvas.clientWidth < 700) settings.panel = false;
  settings.hints = false;  // The page has buttons for them.
  if (parameters.has('panel')) settings.panel = parameters.get('panel') !== '0';
  return JSON.stringify(settings);
}

function keep_settings() {
  if (!viewer || stopped) return;
  try {
    localStorage.setItem(kSettings, text_call('throng_settings'));
  } catch { /* See above. */ }
}

// Opening -----------------------------------------------------------------------------------------

function open(what) {
  const wanted = { atlas: '/throng/people.atlas', ...what };
  for (const name of ['avatars', 'cell', 'seed']) {
    const value = Number(parameters.get(name));
    if (parameters.has(name) && Number.isFinite(value) && value >= 0) wanted[name] = value;
  }
  if (!viewer.ccall('throng_open', 'boolean', ['string'], [JSON.stringify(wanted)])) throw new Error(start_sentence());
}

function folder_for_files() {
  opened += 1;
  return `/open/${opened}`;
}

// Shows one of some files, by their kinds.
function open_files(files, name) {
  const found = store(viewer.FS, folder_for_files(), files);
  if (found.world) known_world = found.world;
  if (found.scenario) open({ path: found.scenario });
  else if (found.replay) open({ path: found.replay, world: known_world });
  else if (found.world) open({ path: found.world, ...(found.model ? { source: found.model } : {}) });
  else if (found.model) open({ path: found.model });
  else throw new Error(`${name}: neither a recording, nor a scenario, nor a baked world (its folder, or a tar of it), nor a model`);
}

async function open_address() {
  const address = parameters.get('open') ?? 'builtin:garage';
  const source = parameters.get('source');
  if (address.startsWith('builtin:')) {
    open({ path: address });
    return;
  }
  const files = [];
  const get = async (url) => {
    const name = decodeURIComponent(new URL(url, location.href).pathname.split('/').pop());
    const bytes = await fetch_bytes(url, (done, total) => show_progress(`Loading ${name}`, total > 0 ? done / total : undefined));
    files.push({ name, bytes });
  };
  await get(address);
  if (parameters.has('world')) await get(parameters.get('world'));
  if (source && !source.startsWith('builtin:')) await get(source);
  hide_notice();
  if (source?.startsWith('builtin:')) {
    const found = store(viewer.FS, folder_for_files(), files);
    known_world = found.world ?? '';
    open({ path: found.replay ?? found.world, world: known_world, source });
  } else {
    open_files(files, address);
  }
}

// A fault while opening leaves the viewer as it was.
async function try_to(open_it) {
  try {
    await open_it();
  } catch (fault) {
    complain(words(fault));
  }
}

// Frames ------------------------------------------------------------------------------------------

const ratio = () => Math.min(window.devicePixelRatio || 1, 2);

function fit() {
  const width = Math.max(16, Math.round(canvas.clientWidth * ratio()));
  const height = Math.max(16, Math.round(canvas.clientHeight * ratio()));
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
}

function status() {
  return JSON.parse(text_call('throng_status'));
}

let frames = 0;
let now_status = null;

function frame(milliseconds) {
  if (stopped) return;
  try {
    fit();
    input.flush();
    viewer._throng_frame(milliseconds / 1000, canvas.width, canvas.height);
    const fault = start_sentence();
    if (fault) throw new Error(fault);
    frames += 1;
    now_status = status();
    input.grab(now_status.grab_mouse);
    if (now_status.save_picture) keep_picture();
    if (now_status.error !== last_fault) {
      last_fault = now_status.error;
      if (last_fault) complain(last_fault.replaceAll(/\/open\/\d+\//g, ''));
    }
    document.title = now_status.name ? `throng: ${now_status.name}` : 'throng';
  } catch (fault) {
    complain(`The viewer has stopped (${words(fault)}). Reload the page.`, true);
    return;
  }
  requestAnimationFrame(frame);
}

// In the task that has drawn: the canvas is empty later.
function keep_picture() {
  canvas.toBlob((blob) => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = 'throng.png';
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

// The page's own parts ----------------------------------------------------------------------------

$('dismiss').addEventListener('click', hide_notice);
$('open-button').addEventListener('click', () => $('files').click());
$('files').addEventListener('change', () => try_to(async () => {
  const files = [];
  for (const file of $('files').files) files.push({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
  $('files').value = '';
  if (files.length > 0) open_files(files, files[0].name);
}));
for (const [id, code] of [['panel-button', 'Tab'], ['keys-button', 'F1'], ['all-button', 'Home'], ['picture-button', 'F12']]) {
  $(id).addEventListener('click', () => {
    input?.tap(code);
    canvas.focus({ preventScroll: true });
  });
}
$('screen-button').addEventListener('click', () => {
  if (document.fullscreenElement) document.exitFullscreen();
  else Promise.resolve(document.documentElement.requestFullscreen?.()).catch(() => {});
  canvas.focus({ preventScroll: true });
});
window.addEventListener('dragover', (event) => event.preventDefault());
window.addEventListener('drop', (event) => {
  event.preventDefault();
  if (!viewer || stopped || !event.dataTransfer) return;
  const files = dropped_files(event.dataTransfer);
  try_to(async () => {
    const all = await files;
    if (all.length > 0) open_files(all, all[0].name);
  });
});
canvas.addEventListener('webglcontextlost', (event) => {
  event.preventDefault();
  complain('The graphics card has taken its memory back. Reload the page.', true);
});
window.addEventListener('pagehide', keep_settings);
document.addEventListener('visibilitychange', () => {
  if (document.visibilityState === 'hidden') keep_settings();
});

// For pages that embed this one from the same server, and for tests.
window.throng = {
  status: () => now_status,
  frames: () => frames,
  open: (files) => try_to(async () => open_files(files, files[0].name)),
  module: () => viewer,
};

begin().catch((fault) => complain(words(fault), viewer === null));
