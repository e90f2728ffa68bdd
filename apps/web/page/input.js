// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// Pointers, wheel, keys and gamepads as a list of calls to the viewer. A button's change is the last call of
// a frame: the panel would miss a click within one frame.

const kNotch = Math.log(1 / 0.85);  // A wheel's notch goes nearer by 15 %.
// Keys that the browser handles, too.
const kBrowsers = new Set(['F5', 'F11', 'F12']);

export class Input {
  constructor(canvas, calls) {
    this.canvas = canvas;
    this.calls = calls;
    this.waiting = [];
    this.pointers = new Map();
    this.pinch = null;
    this.at = { x: 0, y: 0 };
    this.listen();
  }

  // Makes the calls up to and including one change of a button.
  flush() {
    while (this.waiting.length > 0) {
      const call = this.waiting.shift();
      call.run();
      if (call.last) break;
    }
    this.read_gamepad();
  }

  later(run, last = false) { this.waiting.push({ run, last }); }

  pixel(event) {
    const box = this.canvas.getBoundingClientRect();
    return {
      x: (event.clientX - box.left) * this.canvas.width / box.width,
      y: (event.clientY - box.top) * this.canvas.height / box.height,
    };
  }

  move(p) {
    this.at = p;
    this.later(() => this.calls.move(p.x, p.y));
  }

  button(which, down, p) { this.later(() => this.calls.button(which, down, p.x, p.y), true); }

  listen() {
    const canvas = this.canvas;
    canvas.addEventListener('pointerdown', (event) => this.pointer_down(event));
    canvas.addEventListener('pointermove', (event) => this.pointer_move(event));
    canvas.addEventListener('pointerup', (event) => this.pointer_up(event));
    canvas.addEventListener('pointercancel', (event) => this.pointer_up(event));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const unit = event.deltaMode === 0 ? 100 : event.deltaMode === 1 ? 3 : 1;
      const notches = Math.max(-4, Math.min(4, -event.deltaY / unit));
      this.later(() => this.calls.wheel(notches));
    }, { passive: false });
    window.addEventListener('keydown', (event) => this.key(event, true));
    window.addEventListener('keyup', (event) => this.key(event, false));
    window.addEventListener('blur', () => this.later(() => this.calls.leave()));
    document.addEventListener('pointerlockchange', () => {
      if (document.pointerLockElement === canvas || !this.locked) {
        this.locked = document.pointerLockElement === canvas;
        return;
      }
      // The browser does not report the Escape that releases the pointer.
      this.locked = false;
      if (this.wants_lock) this.tap('Escape');
    });
  }

  tap(code) {
    this.later(() => this.calls.key(code, true), true);
    this.later(() => this.calls.key(code, false));
  }

  // The browser may refuse to hide the pointer: then drags turn the view.
  grab(wanted) {
    this.wants_lock = wanted;
    if (wanted && !this.locked && !this.asked) {
      this.asked = true;
      Promise.resolve(this.canvas.requestPointerLock?.()).catch(() => {});
    }
    if (!wanted) {
      this.asked = false;
      if (this.locked) document.exitPointerLock();
    }
  }

  pointer_down(event) {
    this.canvas.focus({ preventScroll: true });
    try {
      this.canvas.setPointerCapture(event.pointerId);
    } catch { /* A pointer that is up again. */ }
    event.preventDefault();
    const p = this.pixel(event);
    if (event.pointerType !== 'touch') {
      this.move(p);
      this.button(event.button, true, p);
      return;
    }
    this.pointers.set(event.pointerId, p);
    if (this.pointers.size === 1) {
      this.move(p);
      this.later(() => {}, true);  // So that the panel knows what is under the finger.
      this.button(0, true, p);
    } else if (this.pointers.size === 2) {
      this.later(() => this.calls.leave(), true);
      this.pinch = this.spread();
      this.move(this.pinch.middle);
      this.button(2, true, this.pinch.middle);
    }
  }

  spread() {
    const [a, b] = [...this.pointers.values()];
    return { far: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)), middle: { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 } };
  }

  pointer_move(event) {
    if (this.locked) {
      const scale = this.canvas.width / this.canvas.getBoundingClientRect().width;
      this.move({ x: this.at.x + event.movementX * scale, y: this.at.y + event.movementY * scale });
      return;
    }
    const p = this.pixel(event);
    if (event.pointerType !== 'touch') {
      this.move(p);
      return;
    }
    if (!this.pointers.has(event.pointerId)) return;
    this.pointers.set(event.pointerId, p);
    if (!this.pinch) {
      if (this.pointers.size === 1) this.move(p);
      return;
    }
    const now = this.spread();
    const notches = Math.log(now.far / this.pinch.far) / kNotch;
    this.pinch = now;
    this.move(now.middle);
    this.later(() => this.calls.wheel(notches));
  }

  pointer_up(event) {
    const p = this.pixel(event);
    if (event.pointerType !== 'touch') {
      this.button(event.button, false, p);
      return;
    }
    if (!this.pointers.delete(event.pointerId)) return;
    if (this.pinch) {
      this.button(2, false, this.pinch.middle);
      this.pinch = null;
      this.pointers.clear();  // The remaining finger is ignored.
    } else {
      this.button(0, false, p);
    }
    this.move({ x: -1e4, y: -1e4 });  // A finger that is up hovers over nothing.
  }

  key(event, down) {
    if (event.target instanceof HTMLInputElement || kBrowsers.has(event.code)) return;
    if ((event.ctrlKey || event.metaKey) && event.code !== 'ControlLeft' && event.code !== 'ControlRight') return;
    if (event.altKey) return;
    if (event.target instanceof HTMLButtonElement && (event.code === 'Enter' || event.code === 'Space' || event.code === 'Tab')) return;
    event.preventDefault();
    if (!event.repeat) this.later(() => this.calls.key(event.code, down));
    if (down && [...event.key].length === 1) this.later(() => this.calls.text(event.key.codePointAt(0)));
  }

  read_gamepad() {
    const pad = navigator.getGamepads?.().find((one) => one && one.mapping === 'standard');
    if (!pad && !this.had_pad) return;
    this.had_pad = Boolean(pad);
    const stick = (axis) => (pad && Math.abs(pad.axes[axis]) > 0.15 ? pad.axes[axis] : 0);  // None rests at exactly 0.
    this.calls.gamepad(stick(0), stick(1), stick(2), stick(3), Boolean(pad?.buttons[5]?.pressed));
  }
}
