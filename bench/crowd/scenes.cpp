// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenes.h"

#include <cmath>

#include "core/random.h"

// The scenes as quads and lists of walkers.
namespace throng::bench {
namespace {

constexpr double kSpeed = 1.34;

void add_floor(Scene& scene, double x0, double z0, double x1, double z1) {
  scene.add_quad({x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0});
}

// A random point near another one.
Vec3d shaken(Vec3d at, double by, uint64_t seed, uint64_t n) {
  return {at.x + by * (2 * random_unit(seed, 2 * n, 0) - 1), at.y,
          at.z + by * (2 * random_unit(seed, 2 * n + 1, 0) - 1)};
}

}  // namespace

Play corridor(uint32_t side, double area, uint64_t seed) {
  constexpr double kWidth = 4, kGroupDistance = 20;
  constexpr uint32_t kRowSize = 4;
  const double row = area * kRowSize / kWidth;  // [m]
  const double group = std::ceil(static_cast<double>(side) / kRowSize) * row;
  const double length = 2 * group + kGroupDistance;
  Play play{.name = "corridor", .scene = {}, .avatar = {}, .walkers = {}};
  add_floor(play.scene, 0, 0, length, kWidth);
  for (uint32_t n = 0; n < 2 * side; ++n) {
    const uint32_t i = n / 2;
    const Vec3d at{(i / kRowSize + 0.5) * row, 0, (i % kRowSize + 0.5) * kWidth / kRowSize};
    const Vec3d from = shaken(at, 0.15, seed, n);
    const Vec3d to = {from.x + group + kGroupDistance, 0, from.z};
    const auto turned = [&](Vec3d p) {  // half around
      return n % 2 == 0 ? p : Vec3d{length - p.x, 0, kWidth - p.z};
    };
    play.walkers.push_back({turned(from), turned(to), kSpeed});
  }
  return play;
}

Play crossing(uint32_t arm, double area, uint64_t seed) {
  constexpr double kWidth = 10, kRim = 0.5;
  const double apart = std::sqrt(area);
  const auto across = static_cast<uint32_t>((kWidth - 2 * kRim) / apart);
  const double group = std::ceil(static_cast<double>(arm) / across) * apart;
  const double length = group + 5;  // of an arm
  const double middle = length + kWidth / 2;
  Play play{.name = "crossing", .scene = {}, .avatar = {}, .walkers = {}};
  const double low = length, high = length + kWidth, end = 2 * length + kWidth;
  add_floor(play.scene, 0, low, low, high);
  add_floor(play.scene, low, low, high, high);
  add_floor(play.scene, high, low, end, high);
  add_floor(play.scene, low, 0, high, low);
  add_floor(play.scene, low, high, high, end);
  for (uint32_t n = 0; n < 4 * arm; ++n) {
    const uint32_t i = n / 4;
    const Vec3d at{(i / across + 0.5) * apart, 0, low + kRim + (i % across + 0.5) * apart};
    const Vec3d from = shaken(at, 0.2 * apart, seed, n);
    const Vec3d to{from.x + end - group, 0, from.z};
    const auto turned = [&](Vec3d p) {  // about the middle, by quarters
      for (uint32_t quarter = 0; quarter < n % 4; ++quarter) {
        p = {middle - (p.z - middle), 0, middle + (p.x - middle)};
      }
      return p;
    };
    play.walkers.push_back({turned(from), turned(to), kSpeed});
  }
  return play;
}

}  // namespace throng::bench
