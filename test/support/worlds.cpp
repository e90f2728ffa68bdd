// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "worlds.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"

// Scenes from quads, boxes and random triangles.
namespace throng::worlds {
namespace {

// A level rectangle seen from above: normal up.
void add_floor(Scene& scene, double x0, double z0, double x1, double z1, double y) {
  scene.add_quad({x0, y, z0}, {x0, y, z1}, {x1, y, z1}, {x1, y, z0});
}

double millimetres(double metres) { return std::floor(metres * 1000 + 0.5) / 1000; }

}  // namespace

Scene flat(double side) {
  Scene scene;
  add_floor(scene, 0, 0, side, side, 0);
  return scene;
}

Scene two_floors() {
  constexpr int kSteps = 18;
  constexpr double kRise = 3.0 / kSteps;
  constexpr double kRun = 0.25;
  Scene scene;
  add_floor(scene, 0, 0, 10, 6, 0);
  scene.add_box({5, 2.8, 0}, {10, 3, 6});
  for (int i = 0; i + 1 < kSteps; ++i) {  // The last riser is the deck's edge.
    const double x = 5 - (kSteps - 1 - i) * kRun;
    scene.add_box({x, 0, 0}, {x + kRun, millimetres((i + 1) * kRise), 2});
  }
  return scene;
}

Scene steps(double rise, double run, int32_t count) {
  Scene scene;
  add_floor(scene, 0, 0, 3, 3, 0);
  for (int32_t i = 0; i < count; ++i) {
    scene.add_box({3 + i * run, 0, 0}, {3 + (i + 1) * run, (i + 1) * rise, 3});
  }
  add_floor(scene, 3 + count * run, 0, 6 + count * run, 3, count * rise);
  return scene;
}

Scene ramp(double slope_degrees, double length) {
  const double top = millimetres(length * std::tan(slope_degrees * std::numbers::pi / 180));
  Scene scene;
  add_floor(scene, 0, 0, 3, 3, 0);
  scene.add_quad({3, 0, 0}, {3, 0, 3}, {3 + length, top, 3}, {3 + length, top, 0});
  add_floor(scene, 3 + length, 0, 6 + length, 3, top);
  return scene;
}

Scene doorway(double width) {
  Scene scene;
  add_floor(scene, 0, 0, 8, 6, 0);
  scene.add_box({3.9, 0, 0}, {4.1, 3, 3 - width / 2});
  scene.add_box({3.9, 0, 3 + width / 2}, {4.1, 3, 6});
  return scene;
}

Scene low_ceiling(double height) {
  Scene scene;
  add_floor(scene, 0, 0, 10, 4, 0);
  scene.add_box({4, height, 0}, {6, height + 0.2, 4});
  return scene;
}

Scene random_soup(uint64_t seed, uint32_t triangles, double extent) {
  // Sizes spread over four decades; one triangle in eight is level, one in eight upright.
  Scene scene;
  for (uint32_t t = 0; t < triangles; ++t) {
    uint64_t counter = 0;
    const auto unit = [&] { return random_unit(seed, t, counter++); };
    const double scales[] = {1, 0.3, 0.03, 0.003};
    const double size = extent * scales[random_below(seed, t, counter++, 4)];
    const uint64_t shape = random_below(seed, t, counter++, 8);
    const Vec3d low{unit() * (extent - size), unit() * (extent - size), unit() * (extent - size)};
    std::array<Vec3d, 3> corner;
    for (Vec3d& c : corner) {
      c = {low.x + unit() * size, low.y + unit() * size, low.z + unit() * size};
      if (shape == 0) c.y = low.y;
      if (shape == 1) c.x = low.x;
      c = {millimetres(c.x), millimetres(c.y), millimetres(c.z)};
    }
    scene.add_triangle(corner[0], corner[1], corner[2]);
  }
  return scene;
}

Scene worked_example() {
  Scene scene;
  add_floor(scene, 0, 0, 8, 4, 1);
  scene.add_box({8, 1, 0}, {12, 4, 4});
  scene.add_box({4, 5.95, 0}, {10, 9, 4});
  return scene;
}

Scene roofs_8_7_6() {
  Scene scene;
  add_floor(scene, 0, 0, 6, 4, 0);
  for (int i = 0; i < 3; ++i) add_floor(scene, 2.0 * i, 0, 2.0 * i + 2, 4, 8.0 - i);
  return scene;
}

}  // namespace throng::worlds
