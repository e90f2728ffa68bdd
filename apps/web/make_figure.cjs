// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// node make_figure.cjs SITE: writes SITE/people.atlas, who walks in the page, with the code that will draw it.
const fs = require('fs');
const path = require('path');

const site = path.resolve(process.argv[2]);
const make = require(path.join(site, 'throng_web.js'));
// This Emscripten would fetch it, as a page does.
make({ wasmBinary: fs.readFileSync(path.join(site, 'throng_web.wasm')) }).then((viewer) => {
  if (!viewer.ccall('throng_make_figure', 'boolean', ['string'], ['/people.atlas'])) {
    console.error('web: ' + viewer.ccall('throng_error', 'string', [], []));
    process.exit(1);
  }
  fs.writeFileSync(path.join(site, 'people.atlas'), viewer.FS.readFile('/people.atlas'));
});
