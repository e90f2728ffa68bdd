// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// node make_figure.cjs SITE: writes SITE/people.atlas, the avatars' atlas of the page, and SITE/people_etc2.atlas, the same
// for the graphics cards of phones, with the code that will draw it.
const fs = require('fs');
const path = require('path');

const site = path.resolve(process.argv[2]);
const make = require(path.join(site, 'throng_web.js'));
// This Emscripten would fetch it, as a page does.
make({ wasmBinary: fs.readFileSync(path.join(site, 'throng_web.wasm')) }).then((viewer) => {
  for (const [name, etc2] of [['people.atlas', false], ['people_etc2.atlas', true]]) {
    if (!viewer.ccall('throng_make_figure', 'boolean', ['string', 'boolean'], ['/' + name, etc2])) {
      console.error('web: ' + viewer.ccall('throng_error', 'string', [], []));
      process.exit(1);
    }
    fs.writeFileSync(path.join(site, name), viewer.FS.readFile('/' + name));
  }
});
