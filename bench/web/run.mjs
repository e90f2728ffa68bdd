// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// node run.mjs BUILD MODULES ROUNDS: prints the results of page.js as one JSON object.
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch, new_page, serve } from '../../test/web/browser.mjs';

const [build, modules, rounds] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url));
const server = await serve(here, build, path.join(modules, 'three/build'));
const browser = await launch();
const page = await new_page(browser, { viewport: { width: 1300, height: 1480 } });
page.setDefaultTimeout(900000);
await page.goto(`${server.url}page.html`);
await page.waitForFunction(() => window.bench && window.make_throng);
const results = await page.evaluate(([n]) => window.bench([10000, 100000], n), [Number(rounds)]);
if (process.env.PICTURES) writeFileSync(path.join(process.env.PICTURES, 'web_bench.png'), await page.screenshot({ timeout: 120000 }));
await browser.close();
server.close();
console.log(JSON.stringify({ ...results, chromium: browser.version() }));
