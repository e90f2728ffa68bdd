// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// The same avatars at the same places, seen by the same camera: as this library's impostors, textured and
// lit, and as plain quads by three.js. Each frame is timed until one of its pixels has been read.
import * as THREE from 'three';

const kWidth = 1280;
const kHeight = 720;
const kView = 1.0;  // [rad] top to bottom
const kDensity = 0.25;  // avatars a square metre

// The places of all avatars, the same on every machine.
function places(count) {
  const side = Math.sqrt(count / kDensity);
  let state = 12345;
  const draw = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return (state >>> 8) / 16777216;
  };
  const x = new Float32Array(count), z = new Float32Array(count);
  for (let i = 0; i < count; ++i) {
    x[i] = (draw() - 0.5) * side;
    z[i] = (draw() - 0.5) * side;
  }
  return { side, x, z };
}

// Over the roofs at the edge, turning from frame to frame: nearly all are in the picture.
function camera_of(side, frame) {
  const angle = 0.05 + 0.002 * frame;
  const far = side * 0.5 + 12;
  return { eye: [Math.sin(angle) * far, 25, Math.cos(angle) * far], target: [0, -0.02 * side, 0], angle };
}

function read_one(gl) {
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
}

async function make_ours() {
  const canvas = document.getElementById('ours');
  const wasmBinary = await (await fetch('throng_web_bench.wasm')).arrayBuffer();
  const viewer = await window.make_throng({ wasmBinary });
  if (!viewer.ccall('bench_start', 'boolean', ['string', 'number', 'number'], ['#ours', kWidth, kHeight])) throw new Error('no WebGL 2');
  const gl = canvas.getContext('webgl2');
  return {
    set: ({ x, z }) => {
      viewer._bench_resize(x.length);
      viewer.HEAPF32.set(x, viewer._bench_x() / 4);
      viewer.HEAPF32.set(z, viewer._bench_z() / 4);
    },
    draw: ({ eye, target }) => {
      if (!viewer._bench_draw(...eye, ...target, kView)) throw new Error('cannot draw');
      read_one(gl);
    },
    drawn: () => viewer._bench_drawn(),
  };
}

function make_theirs() {
  const renderer = new THREE.WebGLRenderer({ canvas: document.getElementById('theirs'), antialias: false, alpha: false });
  renderer.setSize(kWidth, kHeight, false);
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x9ec0e6);
  const camera = new THREE.PerspectiveCamera(kView * 180 / Math.PI, kWidth / kHeight, 0.5, 4000);
  let mesh = null;
  let turned = new THREE.Object3D();
  let at = null;
  const place = (angle) => {
    turned.rotation.y = angle;
    for (let i = 0; i < at.x.length; ++i) {
      turned.position.set(at.x[i], 0.9, at.z[i]);
      turned.updateMatrix();
      mesh.setMatrixAt(i, turned.matrix);
    }
    mesh.instanceMatrix.needsUpdate = true;
  };
  return {
    set: (given) => {
      at = given;
      if (mesh) {
        scene.remove(mesh);
        mesh.dispose();
      }
      mesh = new THREE.InstancedMesh(new THREE.PlaneGeometry(0.6, 1.8), new THREE.MeshBasicMaterial({ color: 0x40506a, side: THREE.DoubleSide }), at.x.length);
      mesh.frustumCulled = false;  // Its one bounding sphere is always in the picture.
      scene.add(mesh);
      place(camera_of(at.side, 0).angle);
    },
    // If the crowd moves, the matrices are made and sent again, as this library's instances are.
    draw: ({ eye, target, angle }, moves) => {
      if (moves) place(angle);
      camera.position.set(...eye);
      camera.lookAt(...target);
      renderer.render(scene, camera);
      read_one(renderer.getContext());
    },
  };
}

const kEmptyCrowd = { side: 0, x: new Float32Array(0), z: new Float32Array(0) };
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

window.bench = async (counts, rounds) => {
  const ours = await make_ours();
  const theirs = make_theirs();
  const rows = [];
  // Times of frames without avatars, seen by the camera of each crowd.
  const empty = { ours: [], theirs: [] };
  for (const count of counts) {
    const at = places(count);
    const times = { ours: [], still: [], moving: [] };
    const timed = (list, run) => {
      const start = performance.now();
      run();
      list.push(performance.now() - start);
    };
    ours.set(kEmptyCrowd);
    theirs.set(kEmptyCrowd);
    for (let round = -1; round < rounds; ++round) {
      const camera = camera_of(at.side, round + 1);
      const keep = round < 0 ? { ours: [], theirs: [] } : empty;
      timed(keep.theirs, () => theirs.draw(camera, false));
      timed(keep.ours, () => ours.draw(camera));
    }
    ours.set(at);
    theirs.set(at);
    for (let round = -1; round < rounds; ++round) {
      const camera = camera_of(at.side, round + 1);
      // The first round compiles and fills caches.
      const keep = round < 0 ? { ours: [], still: [], moving: [] } : times;
      timed(keep.still, () => theirs.draw(camera, false));
      timed(keep.ours, () => ours.draw(camera));
      timed(keep.moving, () => theirs.draw(camera, true));
    }
    rows.push({ avatars: count, drawn: ours.drawn(), ours: median(times.ours), still: median(times.still), moving: median(times.moving), least: Math.min(...times.ours), most: Math.max(...times.ours) });
  }
  const gl = document.getElementById('ours').getContext('webgl2');
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const without_avatars = { ours: median(empty.ours), theirs: median(empty.theirs) };
  return { rows, empty: without_avatars, renderer: gl.getParameter(info.UNMASKED_RENDERER_WEBGL), three: THREE.REVISION };
};
