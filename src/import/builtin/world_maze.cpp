// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "core/arrays/disjoint_sets.h"
#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// A perfect maze a level (exactly one path between any two places), by Kruskal's algorithm on walls
// in random order. Two rooms of 3 x 3 cells, at opposite corners, take turns in holding the spiral
// stairs to the level above.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kPitch = 2.2;  // A corridor of 2 m and a wall of 0.2 m.
constexpr double kWallThickness = 0.2;
constexpr double kStorey = 3.06;
constexpr double kSlab = 0.25;
constexpr double kMargin = 2;  // Ground around the maze.

// Walls of one level: bit per edge. across_x[j * (n + 1) + i] stands between cells (i - 1, j), (i,
// j).
struct Level {
  int32_t n = 0;
  std::vector<uint8_t> across_x;
  std::vector<uint8_t> across_z;
};

bool in_room(int32_t n, int32_t i, int32_t j) {
  const auto inside = [&](int32_t from) {
    return i >= from && i < from + 3 && j >= from && j < from + 3;
  };
  return inside(1) || inside(n - 4);
}

Level carve(int32_t n, uint64_t seed, uint64_t stream) {
  const auto un = static_cast<size_t>(n);
  Level level{n, std::vector<uint8_t>((un + 1) * un, 1), std::vector<uint8_t>((un + 1) * un, 1)};
  DisjointSets sets(un * un);
  struct Edge {
    uint64_t key;
    int32_t i, j, axis;
  };
  std::vector<Edge> edges;
  uint64_t counter = 0;
  for (int32_t j = 0; j < n; ++j) {
    for (int32_t i = 0; i < n; ++i) {
      for (int32_t axis = 0; axis < 2; ++axis) {
        if ((axis == 0 ? i : j) == 0) continue;
        // Within a room there are no walls: key 0 makes those edges come first.
        const bool open =
            in_room(n, i, j) && in_room(n, axis == 0 ? i - 1 : i, axis == 0 ? j : j - 1);
        edges.push_back({open ? 0 : random_u64(seed, stream, counter) | 1, i, j, axis});
        ++counter;
      }
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& c) { return a.key < c.key; });
  for (const Edge& e : edges) {
    const auto here = static_cast<uint32_t>(e.j * n + e.i);
    const uint32_t there = e.axis == 0 ? here - 1 : here - static_cast<uint32_t>(n);
    if (!sets.join(here, there) && e.key != 0) continue;
    if (e.axis == 0) {
      level.across_x[static_cast<size_t>(e.j) * (un + 1) + static_cast<size_t>(e.i)] = 0;
    } else {
      level.across_z[static_cast<size_t>(e.i) * (un + 1) + static_cast<size_t>(e.j)] = 0;
    }
  }
  return level;
}

// Straight runs of wall as one box each. `along_z`: the walls across x.
void raise_walls(WorldBuilder& b, const std::vector<uint8_t>& edges, int32_t n, double at,
                 double y0, double y1, bool along_z) {
  for (int32_t line = 0; line <= n; ++line) {
    const auto stands = [&](int32_t j) {
      return j < n && edges[static_cast<size_t>(j * (n + 1) + line)] != 0;
    };
    for (int32_t j = 0; j < n; ++j) {
      if (!stands(j)) continue;
      const int32_t from = j;
      while (stands(j)) ++j;
      const double u0 = at + line * kPitch;
      const double v0 = at + from * kPitch;
      const double v1 = at + j * kPitch + kWallThickness;
      if (along_z) {
        box(b, Mat::kWall, {u0, y0, v0}, {u0 + kWallThickness, y1, v1}, kNoBottom);
      } else {
        box(b, Mat::kWall, {v0, y0, u0}, {v1, y1, u0 + kWallThickness}, kNoBottom);
      }
    }
  }
}

}  // namespace

void build_maze(WorldBuilder& b, const BuiltinWorldConfig& config) {
  const auto n = static_cast<int32_t>((config.size - 2 * kMargin - kWallThickness) / kPitch);
  const double side = n * kPitch + kWallThickness;
  const double at = (config.size - side) / 2;
  b.node("ground");
  floor_rect(b, Mat::kPavement, {0, 0, config.size, config.size}, 0);
  for (int32_t l = 0; l < config.levels; ++l) {
    const double y = l * kStorey;
    const bool last = l + 1 == config.levels;
    Level level = carve(n, config.seed, static_cast<uint64_t>(l));
    if (l == 0) {  // The entrance and the exit.
      level.across_z[0] = 0;
      level.across_z[static_cast<size_t>((n - 1) * (n + 1) + n)] = 0;
    }
    b.node(fmt::format("level {}", l));
    const double top = last ? y + 2.4 : y + kStorey - kSlab;
    raise_walls(b, level.across_x, n, at, y, top, true);
    raise_walls(b, level.across_z, n, at, y, top, false);
    if (last) continue;

    const int32_t room = l % 2 == 0 ? 1 : n - 4;
    const double centre = at + (room + 1.5) * kPitch + kWallThickness / 2;
    b.node(fmt::format("stairs from level {}", l));
    spiral(b, Mat::kStairs,
           {.x = centre,
            .y = y,
            .z = centre,
            .inner = 0.15,
            .outer = 1.75,
            .from = 0,
            .turn = 0.75,
            .height = kStorey,
            .risers = 18});
    cylinder(b, Mat::kPillar, {centre, y, centre}, {centre, y + kStorey + 1.1, centre}, 0.18, 12,
             true);
    // The quarter that the spiral leaves free is its upper landing; a railing closes the other
    // three.
    const double r = 1.8;
    const double floor = y + kStorey;
    b.node(fmt::format("level {} floor", l + 1));
    const std::array<Rect, 2> holes{
        {{centre - r, centre - r, centre, centre + r}, {centre, centre, centre + r, centre + r}}};
    slab(b, Mat::kFloor, Mat::kSlab, {at, at, at + side, at + side}, holes, floor - kSlab, floor);
    const double e = r + 0.05;
    railing(b, {centre - e, floor, centre - e}, {centre - e, floor, centre + e});
    railing(b, {centre - e, floor, centre + e}, {centre + e, floor, centre + e});
    railing(b, {centre + e, floor, centre}, {centre + e, floor, centre + e});
    railing(b, {centre - e, floor, centre - e}, {centre, floor, centre - e});
    railing(b, {centre + 0.2, floor, centre}, {centre + e, floor, centre});
  }
}

}  // namespace throng::importer::builtin
