// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// Blocks of houses of an exact number of triangles, for times against the complexity of the static
// model ([TC00] figures 3 and 4): ground, closed houses on a grid, then bay windows on their
// fronts, as many as the number asks for. The ground is cut for what remains.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kLot = 75;                 // From street to street. [m]
constexpr uint64_t kHouse = 12, kBay = 10;  // Triangles: six and five faces of a box.
constexpr int32_t kFronts = 4, kRows = 4;
constexpr double kStorey = 3.2, kBayWidth = 1.2, kBayHeight = 1.6, kBayDepth = 0.15;
constexpr double kBayPitch = 2;

struct Grid {
  uint64_t lots = 1;  // Along a side.
  double pitch = kLot;
  [[nodiscard]] double house() const { return 0.7 * pitch; }  // Side of a house.
  // Bay windows in a row of a front.
  [[nodiscard]] uint64_t columns() const {
    return static_cast<uint64_t>(std::max(1.0, std::floor((house() - 1) / kBayPitch)));
  }
  [[nodiscard]] uint64_t bays() const { return kFronts * kRows * columns(); }  // Of a house.
};

Grid grid_of(double size) {
  Grid grid;
  grid.lots = static_cast<uint64_t>(std::max(1.0, std::floor(size / kLot + 0.5)));
  grid.pitch = size / static_cast<double>(grid.lots);
  return grid;
}

// `triangles` of them, at least two: strips along x of two triangles each; in the last one a corner
// on the outer border makes a third.
void add_ground(WorldBuilder& b, double size, uint64_t triangles) {
  const uint64_t strips = triangles / 2;
  for (uint64_t i = 0; i < strips; ++i) {
    const double z0 = size * static_cast<double>(i) / static_cast<double>(strips);
    const double z1 = size * static_cast<double>(i + 1) / static_cast<double>(strips);
    if (i + 1 < strips || triangles % 2 == 0) {
      floor_rect(b, Mat::kRoad, {0, z0, size, z1}, 0);
      continue;
    }
    b.polygon(Mat::kRoad, {b.vertex({size / 2, 0, z1}), b.vertex({size, 0, z1}),
                           b.vertex({size, 0, z0}), b.vertex({0, 0, z0}), b.vertex({0, 0, z1})});
  }
}

// The n-th house, with bay windows in its first places.
void add_house(WorldBuilder& b, const Grid& grid, uint64_t n, uint64_t bays, uint64_t seed) {
  const double side = grid.house(), half = side / 2;
  const double x = (static_cast<double>(n % grid.lots) + 0.5) * grid.pitch;
  const double z = (static_cast<double>(n / grid.lots) + 0.5) * grid.pitch;
  const double height = kStorey * static_cast<double>(kRows + 1 + random_below(seed, n, 0, 4));
  // Places of a front in an order that spreads few bays over it.
  const uint64_t places = kRows * grid.columns();
  uint64_t stride = places * 5 / 13 + 1;
  while (std::gcd(stride, places) != 1) ++stride;
  b.place({{x, 0, z}, 1, 0});
  box(b, Mat::kWall, {-half, 0, -half}, {half, height, half}, kSides);
  box(b, Mat::kTiles, {-half, 0, -half}, {half, height, half}, kHighY);
  // No avatar may stand inside: there is no headroom below this floor, and it is blocked.
  floor_rect(b, Mat::kTiles, {-half, -half, half, half}, 0.3);
  for (uint64_t k = 0; k < bays; ++k) {
    constexpr double kAlongX[kFronts] = {1, 0, -1, 0}, kAlongZ[kFronts] = {0, 1, 0, -1};
    const uint64_t front = k % kFronts, place = k / kFronts * stride % places;
    const double ux = kAlongX[front], uz = kAlongZ[front];
    b.place({{x + half * uz, 0, z - half * ux}, ux, uz});
    const double along = (static_cast<double>(place / kRows) + 0.5) * kBayPitch - half + 0.5;
    const double low = kStorey * static_cast<double>(1 + place % kRows) + 0.8;
    box(b, Mat::kGlass, {along - kBayWidth / 2, low, -kBayDepth},
        {along + kBayWidth / 2, low + kBayHeight, 0}, kAllFaces & ~kHighZ);
  }
  b.place({});
}

}  // namespace

uint64_t max_block_triangles(double size) {
  const Grid grid = grid_of(size);
  return 2 + grid.lots * grid.lots * (kHouse + kBay * grid.bays());
}

void build_blocks(WorldBuilder& b, const BuiltinWorldConfig& config) {
  const Grid grid = grid_of(config.size);
  const uint64_t above_ground = config.triangles - 2;
  const uint64_t houses = std::min(grid.lots * grid.lots, above_ground / kHouse);
  const uint64_t bays =
      houses < grid.lots * grid.lots ? 0 : (above_ground - houses * kHouse) / kBay;
  add_ground(b, config.size, config.triangles - houses * kHouse - bays * kBay);
  for (uint64_t n = 0; n < houses; ++n) {
    b.node(fmt::format("house {}", n));
    add_house(b, grid, n, bays / houses + (n < bays % houses ? 1 : 0), config.seed);
  }
}

}  // namespace throng::importer::builtin
