// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/random.h"
#include "verify/claims.h"

/// Hand-made worlds whose claims are written down as a function, to test the oracle: honest ones,
/// and ones broken in exactly one way.
namespace throng::verify {

/// Triangles, and where the world says feet may be: floor(x, z) is their height, or nothing.
struct FakeWorld {
  using Floor = std::function<std::optional<double>(double x, double z)>;

  Scene scene;
  double side = 12;  ///< All places lie in [0, side] x [0, side]. [m]
  AvatarClass avatar;
  Floor floor;
  Floor floor_on_moves;  ///< What move and find_place say instead, if they differ.
  Floor floor_found;     ///< What find_place alone says instead.
  bool moves_look_at_ends_only = false;

  [[nodiscard]] Claims claims() const {
    const Floor moving = floor_on_moves ? floor_on_moves : floor;
    const Floor found = floor_found ? floor_found : moving;
    const auto place_at = [](const Floor& f, double x, double z) -> Place {
      const auto y = f(x, z);
      return y ? Place{{x, *y, z}, 1} : Place{};
    };
    const bool ends_only = moves_look_at_ends_only;
    return {.avatar = avatar,
            .cell = 0.1,
            .resolution = 0.1,
            .random_place =
                [f = floor, size = side, place_at](uint64_t seed, uint64_t n) {
                  for (uint64_t k = 0; k < 2000; k += 2) {
                    const double x = size * random_unit(seed, n, k);
                    const double z = size * random_unit(seed, n, k + 1);
                    if (const Place place = place_at(f, x, z)) return place;
                  }
                  return Place{};
                },
            .find_place =
                [found, place_at](Vec3d p, double reach) {
                  const Place place = place_at(found, p.x, p.z);
                  return place && std::fabs(place.position.y - p.y) <= reach ? place : Place{};
                },
            .move =
                [moving, place_at, ends_only](const Place& from, double dx, double dz) {
                  const Vec3d p = from.position;
                  const int parts =
                      ends_only ? 1 : std::max(1, static_cast<int>(std::hypot(dx, dz) / 0.002));
                  for (int k = 1; k <= parts; ++k) {
                    const double t = static_cast<double>(k) / parts;
                    if (!moving(p.x + t * dx, p.z + t * dz))
                      return MoveResult{from, MoveEnd::kBlocked};
                  }
                  return MoveResult{place_at(moving, p.x + dx, p.z + dz), MoveEnd::kArrived};
                },
            .feet = [](const Place& place) { return place.position.y; }};
  }
};

/// A rectangle of the ground plane.
struct Rectangle {
  double min_x = 0, min_z = 0, max_x = 0, max_z = 0;

  [[nodiscard]] double distance(double x, double z) const {
    const double dx = std::max({min_x - x, x - max_x, 0.0});
    const double dz = std::max({min_z - z, z - max_z, 0.0});
    return std::hypot(dx, dz);
  }
};

/// A flat floor at y = 0 with walls 3 m high; the world allows what is `margin` beyond the body's
/// radius from every wall and from the rim.
inline FakeWorld flat_world(const std::vector<Rectangle>& walls, double margin = 0.001) {
  FakeWorld world;
  world.scene.add_quad({0, 0, 0}, {world.side, 0, 0}, {world.side, 0, world.side},
                       {0, 0, world.side});
  for (const Rectangle& w : walls) {
    world.scene.add_box({w.min_x, 0, w.min_z}, {w.max_x, 3, w.max_z});
  }
  const double keep = world.avatar.radius + margin;
  const double far = world.side - keep;
  world.floor = [walls, keep, far](double x, double z) -> std::optional<double> {
    if (x < keep || z < keep || x > far || z > far) return std::nullopt;
    for (const Rectangle& w : walls) {
      if (w.distance(x, z) < keep) return std::nullopt;
    }
    return 0.0;
  };
  return world;
}

/// A wall across most of the floor, with a passage at one end.
inline std::vector<Rectangle> one_wall() { return {{5.9, 0, 6.1, 9}}; }

/// Four walls around [low, high] x [low, high], without a door.
inline std::vector<Rectangle> closed_room(double low, double high) {
  return {{low - 0.2, low - 0.2, low, high + 0.2},
          {high, low - 0.2, high + 0.2, high + 0.2},
          {low, low - 0.2, high, low},
          {low, high, high, high + 0.2}};
}

}  // namespace throng::verify
