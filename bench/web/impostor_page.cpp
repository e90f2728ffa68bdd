// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <emscripten.h>
#include <emscripten/html5.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "throng/impostor.h"
#include "throng_draw/draw.h"

// Impostors in a browser, for scripts/results web: the page sets the places of all avatars and the
// camera, and measures the time.
namespace throng {
namespace {

struct Bench {
  std::optional<Drawing> drawing;
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, look;
  DrawingConfig config;
  DrawingReport report;
};

Bench& bench() {
  static Bench one;
  return one;
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE bool bench_start(const char* canvas, int32_t width, int32_t height) {
  EmscriptenWebGLContextAttributes attributes;
  emscripten_webgl_init_context_attributes(&attributes);
  attributes.majorVersion = 2;
  attributes.alpha = attributes.antialias = false;
  const auto context = emscripten_webgl_create_context(canvas, &attributes);
  if (context <= 0 || emscripten_webgl_make_context_current(context) != EMSCRIPTEN_RESULT_SUCCESS) {
    return false;
  }
  Result<Drawing> drawing = Drawing::create_in_current_context();
  if (!drawing) return false;
  Context quiet;
  AtlasConfig atlas_config;
  const Result<Atlas> atlas = create_atlas(built_in_character(), atlas_config, quiet);
  if (!atlas || !drawing->add_atlas(*atlas)) return false;
  bench().drawing = std::move(*drawing);
  bench().config.width = width;
  bench().config.height = height;
  bench().config.samples = 1;
  bench().config.sun_pixels = 256;
  bench().config.avatar_shadows = false;
  return true;
}

/// Sets the number of avatars; the page writes their places into bench_x() and bench_z().
EMSCRIPTEN_KEEPALIVE void bench_resize(uint32_t avatars) {
  Bench& b = bench();
  for (auto* array : {&b.x, &b.y, &b.z}) array->assign(avatars, 0.0F);
  for (auto* array : {&b.heading, &b.phase, &b.look}) array->resize(avatars);
  for (uint32_t i = 0; i < avatars; ++i) {
    b.heading[i] = static_cast<uint16_t>(i * 40503U);
    b.phase[i] = static_cast<uint16_t>(i * 10007U);
    b.look[i] = static_cast<uint16_t>(i % 2048);
  }
}
EMSCRIPTEN_KEEPALIVE float* bench_x() { return bench().x.data(); }
EMSCRIPTEN_KEEPALIVE float* bench_z() { return bench().z.data(); }

EMSCRIPTEN_KEEPALIVE bool bench_draw(double x, double y, double z, double to_x, double to_y,
                                     double to_z, double field_of_view) {
  Bench& b = bench();
  b.config.camera = {
      .eye = {x, y, z}, .target = {to_x, to_y, to_z}, .field_of_view = field_of_view};
  b.config.camera.nearest = 0.5;
  b.config.camera.furthest = 4000;
  const DrawnCrowd crowd{.avatars = {.x = b.x,
                                     .y = b.y,
                                     .z = b.z,
                                     .heading = b.heading,
                                     .phase = b.phase,
                                     .appearance = b.look}};
  return bool(b.drawing->show({&crowd, 1}, b.config, &b.report));
}
EMSCRIPTEN_KEEPALIVE uint32_t bench_drawn() { return static_cast<uint32_t>(bench().report.drawn); }

}  // extern "C"
}  // namespace throng
