// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// node page_test.mjs SITE FOLDER: uses the page as a visitor does. FOLDER holds walk.replay, garage.throng and
// garage.throng.tar (scripts/tests/test_web makes them); pictures of what went wrong go to $PICTURES.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { launch, new_page, serve } from './browser.mjs';
import { changed_pixels } from './pixels.mjs';

const [site, folder] = process.argv.slice(2);
const server = await serve(site, folder);
const browser = await launch();
// The garage's upper deck from near: dozens of avatars large enough to count.
const kNear = 'camera=52,14,46,30,8.5,20';

const kHall = `seconds = 60
[plane]
floor = [[0, 0], [20, 0], [20, 12], [0, 12]]
[[area]]
name = "west"
box = [0.5, 0.5, 4, 11.5]
[[area]]
name = "door"
box = [18, 5, 20, 7]
[[journey]]
name = "out"
stages = [{ leave = "door" }]
[[source]]
name = "they"
area = "west"
journey = "out"
count = 20
`;

const status = (page) => page.evaluate(() => window.throng.status());

async function wait_for(page, what, is_so, ...given) {
  try {
    await page.waitForFunction(is_so, given, { timeout: 120000, polling: 100 });
  } catch {
    const now = await page.evaluate(() => [window.throng?.status?.(), document.getElementById('sentence').textContent]);
    throw new Error(`did not come: ${what}; the page says ${JSON.stringify(now)}; ${page.complaints.join(' | ')}`);
  }
}

const walking = (page, min_avatars = 1) => wait_for(page, 'avatars that walk', ([n]) => {
  const s = window.throng.status();
  return s && !s.loading && s.avatars >= n && s.time > 0.3;
}, min_avatars);

async function frames(page, count) {
  const until = (await page.evaluate(() => window.throng.frames())) + count;
  await wait_for(page, `${count} frames`, ([n]) => window.throng.frames() >= n, until);
}

async function tap_key(page, key) {
  await page.keyboard.press(key);
  await frames(page, 3);
}

const tests = {
  async 'bakes the garage in place and shows people, without a complaint'(page) {
    await page.goto(`${server.url}?open=builtin:garage&avatars=300&panel=0&buttons=0&${kNear}`);
    await walking(page, 250);
    await tap_key(page, 'Space');
    assert.equal((await status(page)).playing, false);
    const with_people = await page.screenshot();
    const drawn = (await status(page)).drawn;
    assert.ok(drawn > 20, `${drawn} drawn`);
    await page.goto(`${server.url}?open=builtin:garage&avatars=0&panel=0&buttons=0&${kNear}`);
    await wait_for(page, 'the empty garage', () => window.throng.status()?.loading === false && window.throng.frames() > 4);
    const without = await page.screenshot();
    const people = await changed_pixels(page, with_people, without);
    assert.ok(people > 800 && people < 100000, `${people} pixels show people`);
    assert.deepEqual(page.complaints, []);
    return `${drawn} people drawn, ${people} pixels`;
  },

  async 'is the same picture every time'(page) {
    const pictures = [];
    for (let n = 0; n < 2; ++n) {
      await page.goto(`${server.url}?open=builtin:garage&avatars=0&panel=0&buttons=0`);
      await wait_for(page, 'the garage', () => window.throng.status()?.loading === false && window.throng.frames() > 4);
      pictures.push(await page.screenshot());
    }
    assert.equal(await changed_pixels(page, ...pictures), 0);
  },

  async 'reacts to the panel, to keys and to drags'(page) {
    await page.goto(`${server.url}?open=builtin:garage&avatars=100&panel=1`);
    await walking(page, 80);
    await page.mouse.move(45, 93);
    await frames(page, 2);
    await page.mouse.down();
    await page.mouse.up();
    await frames(page, 4);
    assert.equal((await status(page)).playing, false, 'the button Pause of the panel');
    const shown = await page.screenshot();
    await tap_key(page, 'Tab');
    const hidden = await page.screenshot();
    const panel = await changed_pixels(page, shown, hidden);
    assert.ok(panel > 40000, `${panel} pixels of the panel`);
    const before = (await status(page)).camera;
    await page.mouse.move(450, 200);
    await page.mouse.down();
    await page.mouse.move(550, 200, { steps: 4 });
    await page.mouse.up();
    await frames(page, 6);
    const turned = (await status(page)).camera;
    assert.ok(Math.hypot(turned[0] - before[0], turned[2] - before[2]) > 5, 'a drag turns');
    await page.mouse.wheel(0, -300);
    await frames(page, 4);
    const nearer = (await status(page)).camera;
    const far = (c) => Math.hypot(c[0] - c[3], c[1] - c[4], c[2] - c[5]);
    assert.ok(far(nearer) < 0.8 * far(turned), 'the wheel goes nearer');
    assert.deepEqual(page.complaints, []);
  },

  async 'works with two fingers at a phone\'s width'() {
    const page = await new_page(browser, { viewport: { width: 390, height: 700 }, hasTouch: true, isMobile: true, deviceScaleFactor: 1 });
    await page.goto(`${server.url}?open=builtin:garage&avatars=50`);
    await walking(page, 40);
    const size = await page.evaluate(() => [document.documentElement.scrollWidth, document.getElementById('canvas').width]);
    assert.deepEqual(size, [390, 390]);
    const touch = await page.context().newCDPSession(page);
    const send = async (type, ...points) => {
      await touch.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
      await frames(page, 1);
    };
    const before = (await status(page)).camera;
    await send('touchStart', [200, 400]);
    for (const x of [245, 290]) await send('touchMove', [x, 400]);
    await send('touchEnd');
    await frames(page, 4);
    const turned = (await status(page)).camera;
    assert.ok(Math.hypot(turned[0] - before[0], turned[2] - before[2]) > 5, 'a finger turns');
    await send('touchStart', [180, 400]);
    await send('touchStart', [180, 400], [220, 400]);
    for (const by of [50, 80]) await send('touchMove', [200 - by, 400], [200 + by, 400]);
    await send('touchEnd');
    await frames(page, 8);
    const nearer = (await status(page)).camera;
    const far = (c) => Math.hypot(c[0] - c[3], c[1] - c[4], c[2] - c[5]);
    assert.ok(far(nearer) < 0.6 * far(turned), `two fingers go nearer: ${far(turned)} to ${far(nearer)}`);
    assert.deepEqual(page.complaints, []);
    if (process.env.PICTURES) await page.screenshot({ path: path.join(process.env.PICTURES, 'phone.png') });
    await page.context().close();
  },

  async 'says in a sentence what a browser lacks'() {
    const page = await new_page(browser);
    await page.addInitScript(() => {
      const get = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...more) { return kind === 'webgl2' ? null : get.call(this, kind, ...more); };
    });
    await page.goto(server.url);
    await page.waitForFunction(() => document.getElementById('notice').className === 'fault');
    assert.match(await page.textContent('#sentence'), /draws with WebGL 2, which this browser does not offer/);
    await page.context().close();
  },

  async 'says in a sentence what cannot be opened, and goes on'(page) {
    let last = '';  // Its notice may still be there for a moment.
    const fault = async () => {
      await page.waitForFunction(([before]) => document.getElementById('notice').className === 'fault' &&
        document.getElementById('sentence').textContent !== before, [last], { timeout: 60000 });
      last = await page.textContent('#sentence');
      return last;
    };
    await page.goto(`${server.url}?open=nothing.replay`);
    assert.match(await fault(), /nothing\.replay: the server answers 404/);
    const give = async (name, text) => {
      await page.click('#dismiss');
      await page.evaluate(([n, t]) => { window.throng.open([{ name: n, bytes: new TextEncoder().encode(t) }]); }, [name, text]);
      return fault();
    };
    assert.match(await give('bad.replay', 'this is none'), /bad\.replay/);
    assert.match(await give('bad.tar', 'x'.repeat(2000)), /no tar archive/);
    assert.match(await give('bad.obj', 'v 0 0\nf 1 2 3\n'), /bad\.obj/);
    assert.match(await give('letter.txt', 'dear all'), /neither a recording/);
    await page.click('#dismiss');
    await page.evaluate(() => { window.throng.open([{ name: 'flat.obj', bytes: new TextEncoder().encode('v 0 0 0\nv 20 0 0\nv 20 0 20\nv 0 0 20\nf 4 3 2 1\n') }]); });
    await wait_for(page, 'the model that was dropped', () => window.throng.status().name === 'flat.obj' && window.throng.status().avatars > 10);
    assert.deepEqual(page.complaints.filter((one) => !one.includes('404')), []);
  },

  async 'takes a scenario and the folder of a world that are dropped on it'(page) {
    const hall = path.join(mkdtempSync(path.join(tmpdir(), 'throng-drop-')), 'hall.toml');
    writeFileSync(hall, kHall);
    const devtools = await page.context().newCDPSession(page);
    const drop = async (...files) => {
      const data = { items: [], files, dragOperationsMask: 1 };
      for (const type of ['dragEnter', 'dragOver', 'drop']) await devtools.send('Input.dispatchDragEvent', { type, x: 300, y: 300, data });
    };
    await page.goto(`${server.url}?open=builtin:stairs&avatars=5`);
    await walking(page, 5);
    await drop(hall);
    await wait_for(page, 'the scenario', () => window.throng.status().name === 'hall.toml' && window.throng.status().avatars > 3);
    await drop(path.resolve(folder, 'garage.throng'));
    await wait_for(page, 'the world', () => window.throng.status().name === 'garage.throng' && window.throng.status().avatars > 3);
    assert.deepEqual(page.complaints, []);
  },

  async 'a card of a phone, with ETC2 and without S3TC, gets its own figure'(page) {
    await page.addInitScript(() => {
      const is_s3tc = (name) => name.startsWith('WEBGL_compressed_texture_s3tc');
      const { getExtension, getSupportedExtensions } = WebGL2RenderingContext.prototype;
      WebGL2RenderingContext.prototype.getExtension = function (name) { return is_s3tc(name) ? null : getExtension.call(this, name); };
      WebGL2RenderingContext.prototype.getSupportedExtensions = function () { return getSupportedExtensions.call(this).filter((name) => !is_s3tc(name)); };
      window.kinds = new Set();
      const { compressedTexImage3D } = WebGL2RenderingContext.prototype;
      WebGL2RenderingContext.prototype.compressedTexImage3D = function (...given) { window.kinds.add(given[2]); return compressedTexImage3D.apply(this, given); };
    });
    const fetched = [];
    page.on('request', (request) => fetched.push(path.basename(new URL(request.url()).pathname)));
    await page.goto(`${server.url}?open=builtin:garage&avatars=200&${kNear}`);
    assert.ok(await page.evaluate(() => document.createElement('canvas').getContext('webgl2').getExtension('WEBGL_compressed_texture_etc')), 'the software renderer offers ETC2');
    await walking(page, 150);
    assert.deepEqual(fetched.filter((name) => name.endsWith('.atlas')), ['people_etc2.atlas']);
    assert.deepEqual(await page.evaluate(() => [...window.kinds]), [0x9276]);  // COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2
    assert.deepEqual(page.complaints, []);
    if (process.env.PICTURES) await page.screenshot({ path: path.join(process.env.PICTURES, 'etc2.png') });
    return undefined;
  },

  async 'opens a recording and its world by address'(page) {
    await page.goto(`${server.url}?open=walk.replay&world=garage.throng.tar&source=builtin:garage`);
    await walking(page, 50);
    assert.equal((await status(page)).name, 'walk.replay');
    assert.deepEqual(page.complaints, []);
    if (process.env.PICTURES) await page.screenshot({ path: path.join(process.env.PICTURES, 'replay.png') });
    await page.goto(`${server.url}?open=garage.throng.tar&avatars=60`);
    await walking(page, 50);
    assert.deepEqual(page.complaints, []);
    const cut = readFileSync(path.join(folder, 'walk.replay')).subarray(0, 150).toString('latin1');
    await page.evaluate((text) => { window.throng.open([{ name: 'cut.replay', bytes: Uint8Array.from(text, (c) => c.charCodeAt(0)) }]); }, cut);
    await page.waitForFunction(() => document.getElementById('notice').className === 'fault');
    assert.match(await page.textContent('#sentence'), /cut\.replay/);
    return undefined;
  },
};

let failed = 0;
const only = process.env.ONLY ?? '';
for (const [name, test] of Object.entries(tests)) {
  if (!name.includes(only)) continue;
  const page = await new_page(browser);
  const started = Date.now();
  try {
    const details = await test(page);
    console.log(`ok    ${name} (${((Date.now() - started) / 1000).toFixed(1)} s${details ? `; ${details}` : ''})`);
  } catch (fault) {
    failed += 1;
    console.log(`FAIL  ${name}: ${fault.message}`);
    if (process.env.PICTURES) await page.screenshot({ path: path.join(process.env.PICTURES, 'fault.png') }).catch(() => {});
  }
  await page.context().close().catch(() => {});
}
await browser.close();
server.close();
process.exit(failed === 0 ? 0 : 1);
