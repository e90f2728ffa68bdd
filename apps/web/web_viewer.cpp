// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <emscripten.h>
#include <emscripten/html5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "command.h"
#include "throng_view/viewer.h"
#include "window/view_stage.h"

// The viewer's functions for JavaScript, which has the canvas, the pointer and the network
// (page/throng.js).
namespace throng::app {
namespace {

struct Page {
  std::unique_ptr<Viewer> viewer;
  std::string error;  // Of the last call that failed.
  std::string text;   // Result of the last call that returned text.
};

Page& page() {
  static Page one;
  return one;
}

bool fail_with(const std::string& sentence) {
  page().error = sentence;
  return false;
}

// By KeyboardEvent.code, which names a key by its position, as GLFW does.
Key key_of_code(const std::string& code) {
  if (code.size() == 4 && code.starts_with("Key")) return static_cast<Key>(code[3]);
  if (code.size() == 6 && code.starts_with("Digit")) return static_cast<Key>(code[5]);
  constexpr std::array<std::pair<const char*, Key>, 28> kNames{{
      {"Space", Key::kSpace},
      {"Comma", Key::kComma},
      {"Period", Key::kPeriod},
      {"Escape", Key::kEscape},
      {"Enter", Key::kEnter},
      {"NumpadEnter", Key::kEnter},
      {"Tab", Key::kTab},
      {"Backspace", Key::kBackspace},
      {"Delete", Key::kDelete},
      {"ArrowLeft", Key::kLeft},
      {"ArrowRight", Key::kRight},
      {"ArrowUp", Key::kUp},
      {"ArrowDown", Key::kDown},
      {"PageUp", Key::kPageUp},
      {"PageDown", Key::kPageDown},
      {"Home", Key::kHome},
      {"End", Key::kEnd},
      {"F1", Key::kF1},
      {"F2", Key::kF2},
      {"F11", Key::kF11},
      {"F12", Key::kF12},
      {"ShiftLeft", Key::kShift},
      {"ShiftRight", Key::kShift},
      {"ControlLeft", Key::kControl},
      {"ControlRight", Key::kControl},
      {"AltLeft", Key::kAlt},
      {"AltRight", Key::kAlt},
      {"", Key::kNone},
  }};
  for (const auto& [name, key] : kNames) {
    if (code == name) return key;
  }
  return Key::kNone;
}

// Colours are the page's own: the picture is opaque, and smoothed by the drawing itself.
bool make_context(const char* canvas) {
  EmscriptenWebGLContextAttributes attributes;
  emscripten_webgl_init_context_attributes(&attributes);
  attributes.majorVersion = 2;
  attributes.alpha = attributes.depth = attributes.stencil = attributes.antialias = false;
  attributes.powerPreference = EM_WEBGL_POWER_PREFERENCE_HIGH_PERFORMANCE;
  const auto context = emscripten_webgl_create_context(canvas, &attributes);
  if (context <= 0 || emscripten_webgl_make_context_current(context) != EMSCRIPTEN_RESULT_SUCCESS) {
    return false;
  }
  // The drawing reports the renderer's name.
  (void)emscripten_webgl_enable_extension(context, "WEBGL_debug_renderer_info");
  return true;
}

}  // namespace

extern "C" {

/// Creates the viewer on the canvas of a CSS selector. False: throng_error() returns the reason.
EMSCRIPTEN_KEEPALIVE bool throng_start(const char* canvas, const char* settings,
                                       double pixel_ratio) {
  if (!make_context(canvas)) return fail_with("this browser gives no WebGL 2 context");
  Result<Drawing> drawing = Drawing::create_in_current_context();
  if (!drawing) return fail_with(drawing.error().message);
  ViewerConfig config;
  config.settings = settings;
  config.font = "/throng/panel.ttf";
  config.pixel_ratio = pixel_ratio;
  Result<Viewer> viewer = Viewer::create(*std::move(drawing), config);
  if (!viewer) return fail_with(viewer.error().message);
  page().viewer = std::make_unique<Viewer>(*std::move(viewer));
  return true;
}

EMSCRIPTEN_KEEPALIVE const char* throng_error() { return page().error.c_str(); }

/// Shows a file that the page has put into its file system, as `throng view` does. `what` is a JSON
/// object: path, optionally world, source, atlas, avatars, cell, seed.
EMSCRIPTEN_KEEPALIVE bool throng_open(const char* what) {
  const Json json = Json::parse(what, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("path")) return fail_with("nothing to open");
  ViewTarget target;
  target.path = json.value("path", "");
  target.world = json.value("world", "");
  if (json.contains("source")) target.sources.files.push_back(json.value("source", ""));
  if (json.contains("atlas")) target.atlases.push_back(json.value("atlas", ""));
  target.cell = std::clamp(json.value("cell", target.cell), 0.01, 10.0);
  target.start.avatars = std::min(json.value("avatars", target.start.avatars), 1000000U);
  if (json.contains("seed")) target.start.seed = json.value("seed", uint64_t{1});
  if (json.contains("seed")) target.seed = target.start.seed;
  page().viewer->load(short_name(target.path), stage_of(target));
  return true;
}

/// Draws a frame. Loads and steps get their share of time here.
EMSCRIPTEN_KEEPALIVE void throng_frame(double seconds, int32_t width, int32_t height) {
  const Result<void> ok = page().viewer->frame(seconds, width, height);
  page().error = ok ? "" : ok.error().message;
}

EMSCRIPTEN_KEEPALIVE void throng_key(const char* code, bool down) {
  ViewEvent event{.kind = down ? ViewEventKind::kKeyDown : ViewEventKind::kKeyUp};
  event.key = key_of_code(code);
  page().viewer->handle(event);
}

EMSCRIPTEN_KEEPALIVE void throng_text(uint32_t unicode) {
  ViewEvent event{.kind = ViewEventKind::kText};
  event.text = unicode;
  page().viewer->handle(event);
}

EMSCRIPTEN_KEEPALIVE void throng_move(double x, double y) {
  ViewEvent event{.kind = ViewEventKind::kMouseMove};
  event.x = x;
  event.y = y;
  page().viewer->handle(event);
}

/// `button` as MouseEvent counts: 0 left, 1 middle, 2 right.
EMSCRIPTEN_KEEPALIVE void throng_button(int32_t button, bool down, double x, double y) {
  ViewEvent event{.kind = down ? ViewEventKind::kMouseDown : ViewEventKind::kMouseUp};
  event.button = button == 1   ? MouseButton::kMiddle
                 : button == 2 ? MouseButton::kRight
                               : MouseButton::kLeft;
  event.x = x;
  event.y = y;
  page().viewer->handle(event);
}

EMSCRIPTEN_KEEPALIVE void throng_wheel(double notches) {
  ViewEvent event{.kind = ViewEventKind::kWheel};
  event.y = notches;
  page().viewer->handle(event);
}

/// Sticks of a gamepad now; see GamepadState.
EMSCRIPTEN_KEEPALIVE void throng_gamepad(double walk_x, double walk_y, double look_x, double look_y,
                                         bool hurry) {
  page().viewer->set_gamepad({walk_x, walk_y, look_x, look_y, hurry});
}

/// All keys and buttons are up.
EMSCRIPTEN_KEEPALIVE void throng_leave() { page().viewer->handle({.kind = ViewEventKind::kLeave}); }

EMSCRIPTEN_KEEPALIVE void throng_look(double x, double y, double z, double to_x, double to_y,
                                      double to_z) {
  page().viewer->look_at({x, y, z}, {to_x, to_y, to_z});
}

EMSCRIPTEN_KEEPALIVE void throng_show_overlay(const char* name) {
  page().viewer->show_overlay(name);
}

/// The viewer's status and requests as a JSON object. Each request is reported once.
EMSCRIPTEN_KEEPALIVE const char* throng_status() {
  const ViewerStatus s = page().viewer->status();
  const ViewerRequests requests = page().viewer->take_requests();
  const Json json = {{"name", s.name},
                     {"loading", s.loading},
                     {"error", s.error},
                     {"playing", s.playing},
                     {"time", s.time},
                     {"avatars", s.avatars},
                     {"drawn", s.drawn},
                     {"picked", s.picked},
                     {"controlled", s.controlled},
                     {"grab_mouse", requests.grab_mouse},
                     {"save_picture", requests.save_picture},
                     {"camera",
                      {s.camera.eye.x, s.camera.eye.y, s.camera.eye.z, s.camera.target.x,
                       s.camera.target.y, s.camera.target.z}}};
  page().text = json.dump();
  return page().text.c_str();
}

/// To pass to throng_start() at the next start.
EMSCRIPTEN_KEEPALIVE const char* throng_settings() {
  page().text = page().viewer->settings();
  return page().text.c_str();
}

/// Writes the built-in figure's atlas in BC1 or, for phones, in ETC2: for scripts/web, so that no
/// visitor has to wait for it.
EMSCRIPTEN_KEEPALIVE bool throng_make_figure(const char* path, bool etc2) {
  AtlasConfig config;
  config.clips = {"Walk", "Idle"};
  Context context;
  const Result<Atlas> atlas = create_atlas(built_in_character(), config, context);
  if (!atlas) return fail_with(atlas.error().message);
  const AtlasFormat format = etc2 ? AtlasFormat::kEtc2a1 : AtlasFormat::kBc1;
  const Result<void> saved = save_atlas(convert_atlas(*atlas, format), path);
  return saved ? true : fail_with(saved.error().message);
}

}  // extern "C"
}  // namespace throng::app
