// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// Debian's Chromium over a plain static server: no special headers, as on any host.
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';

// npm's packages are not beside this file.
const { chromium } = await import(path.resolve(process.env.NODE_MODULES ?? 'build/web-deps/npm/node_modules', 'playwright-core/index.mjs'));

const kTypes = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };
// A software renderer: the same on every machine.
const kSoftware = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const kQuiet = ['--no-sandbox', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];

// Serves the files of several folders, from the first that has one.
export async function serve(...folders) {
  const server = createServer((request, answer) => {
    const name = decodeURIComponent(new URL(request.url, 'http://host').pathname).replace(/\/$/, '/index.html');
    const file = folders.map((folder) => path.join(folder, path.normalize(name))).find((one) => existsSync(one) && statSync(one).isFile());
    if (!file) {
      answer.writeHead(404).end();
      return;
    }
    answer.writeHead(200, { 'content-type': kTypes[path.extname(file)] ?? 'application/octet-stream', 'content-length': statSync(file).size });
    createReadStream(file).pipe(answer);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { url: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

export async function launch(extra = kSoftware) {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', headless: true, args: [...kQuiet, ...extra] });
}

// A page that records its complaints; small, because a software renderer draws it.
export async function new_page(browser, options) {
  const context = await browser.newContext({ viewport: { width: 640, height: 400 }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  page.complaints = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) page.complaints.push(message.text());
    if (process.env.VERBOSE) console.log(`  [${message.type()}] ${message.text()}`);
  });
  page.on('pageerror', (fault) => page.complaints.push(String(fault)));
  return page;
}
