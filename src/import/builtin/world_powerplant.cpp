// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// A boiler house like the power plant of [ML06], whose 13 million triangles we may not ship: a
// steel frame of 6 m bays and 3.5 m storeys, floors of grating with their bearing bars, pipe racks,
// vessels, shafts, ladders. Blocks of 6 x 6 bays repeat; each has a boiler with a chimney in its
// middle and two staircases. 835 slices mean a height between 85.05 and 85.15 m; 85.125 m is exact
// in float files.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kBay = 6;
constexpr double kStorey = 3.5;
constexpr double kYard = 6;         // Ground around the frame.
constexpr double kChimney = 8.125;  // Over the top floor.
constexpr int32_t kBlock = 6;       // Bays along a side of a block.

enum class Use { kGrating, kVessel, kShaft, kStairs, kBoiler };

struct Plan {
  int32_t nx = 6;
  int32_t nz = 6;
  int32_t levels = 22;
  uint64_t seed = 1;

  [[nodiscard]] double x(int32_t i) const { return i * kBay; }
  [[nodiscard]] double z(int32_t j) const { return j * kBay; }
  [[nodiscard]] uint64_t dice(int32_t i, int32_t j, int32_t level, uint64_t k) const {
    const auto stream = (static_cast<uint64_t>(level) << 40) | (static_cast<uint64_t>(j) << 20) |
                        static_cast<uint64_t>(i);
    return random_u64(seed, stream, k);
  }
  [[nodiscard]] bool in_boiler(int32_t i, int32_t j) const {
    const int32_t bi = i % kBlock;
    const int32_t bj = j % kBlock;
    const bool whole = i / kBlock * kBlock + 4 < nx && j / kBlock * kBlock + 4 < nz;
    return whole && bi >= 2 && bi < 4 && bj >= 2 && bj < 4;
  }
  // Storeys of the boiler of a block: the floors above it close over it.
  [[nodiscard]] int32_t boiler_top(int32_t i, int32_t j) const {
    const auto roll = static_cast<int32_t>(dice(i / kBlock, j / kBlock, 1000, 0) % 4);
    return std::max(1, levels - 4 - roll);
  }
  [[nodiscard]] Use use(int32_t i, int32_t j, int32_t level) const {
    if (in_boiler(i, j)) return level <= boiler_top(i, j) ? Use::kBoiler : Use::kGrating;
    const int32_t bi = i % kBlock;
    const int32_t bj = j % kBlock;
    if ((bi == 0 && bj == 1) || (bi == 3 && bj == 4)) return Use::kStairs;
    const bool kept_free = bi == 1 || bj == 1 || bi == 4 || bj == 4;  // Kept free to walk around.
    const uint64_t roll = dice(i, j, level, 0) % 100;
    // A shaft goes through several storeys: the same roll for all of them.
    if (!kept_free && level > 0 && dice(i, j, 2000 + level / 5, 0) % 100 < 30) return Use::kShaft;
    return roll < 30 ? Use::kVessel : Use::kGrating;
  }
  [[nodiscard]] bool has_floor(int32_t i, int32_t j, int32_t level) const {
    if (i < 0 || j < 0 || i >= nx || j >= nz) return false;
    const Use u = use(i, j, level);
    return u != Use::kShaft && u != Use::kBoiler;
  }
};

// The staircase of a stair bay, relative to the bay's corner.
constexpr double kWellX = 1.5;
constexpr double kWellZ = 0.4;
Dogleg well(double y) {
  return {.x = kWellX,
          .y = y,
          .z = kWellZ,
          .height = kStorey,
          .width = 1.25,
          .gap = 0.2,
          .run = 0.26,
          .landing = 1.4,
          .risers = 10};
}

// One surface to walk on and, under it, the bars that carry it, all along x.
void add_grating(WorldBuilder& b, double x, double z, double y, std::span<const Rect> holes) {
  floor_with_holes(b, Mat::kGrating, {x, z, x + kBay, z + kBay}, holes, y);
  for (int32_t i = 0; i < 12; ++i) {
    const double at = z + 0.25 + 0.5 * i;
    double from = x;
    for (const Rect& hole : holes) {
      if (at < hole.z0 || at > hole.z1) continue;
      box(b, Mat::kSteel, {from, y - 0.05, at - 0.006}, {hole.x0, y - 0.002, at + 0.006},
          kSides | kLowY);
      from = hole.x1;
    }
    box(b, Mat::kSteel, {from, y - 0.05, at - 0.006}, {x + kBay, y - 0.002, at + 0.006},
        kSides | kLowY);
  }
}

void add_stairs(WorldBuilder& b, const Plan& p, double x, double z, int32_t level) {
  const double y = level * kStorey;
  const Dogleg d = well(0);
  const Frame outer = b.frame();
  b.place({{x, y, z}, 1, 0});
  const double end = d.x + d.length();
  if (level < p.levels) dogleg(b, Mat::kStairs, d);
  if (level > 0) {
    railing(b, {d.x, 0, d.z - 0.05}, {end, 0, d.z - 0.05});
    railing(b, {d.x, 0, d.z + d.depth() + 0.05}, {end, 0, d.z + d.depth() + 0.05});
    railing(b, {end + 0.05, 0, d.z}, {end + 0.05, 0, d.z + d.depth()});
  }
  if (level == p.levels) railing(b, {d.x - 0.05, 0, d.z}, {d.x - 0.05, 0, d.z + d.width});
  b.place(outer);
}

// Something that stands in the middle of a bay and leaves 1.2 m or more to walk around it.
void add_vessel(WorldBuilder& b, double x, double z, double y, uint64_t random) {
  const double cx = x + 2.6;
  const double cz = z + 2.6;
  const double size = 0.8 + 0.4 * static_cast<double>(random >> 8 & 255) / 255;
  const auto riser = [&](Vec3d from, double reach, double radius) {
    // Up, over, and into the rack.
    const std::array<Vec3d, 4> path{{from,
                                     {from.x, y + 2.9, from.z},
                                     {from.x + reach, y + 2.9, from.z},
                                     {from.x + reach, y + 3.3, from.z}}};
    pipe(b, Mat::kPipe, path, radius, 8);
  };
  switch (random % 4) {
    case 0:  // A standing tank on a plinth.
      box(b, Mat::kSlab, {cx - 1.2, y, cz - 1.2}, {cx + 1.2, y + 0.15, cz + 1.2}, kNoBottom);
      frustum(b, Mat::kTank, {cx, y + 0.15, cz}, 1.1 * size, 1.1 * size, 1.9, 14, false);
      frustum(b, Mat::kTank, {cx, y + 2.05, cz}, 1.1 * size, 0.25, 0.35, 14, true);
      riser({cx, y + 2.3, cz}, 1.4, 0.12);
      ladder(b, {cx - 1.1 * size - 0.2, y, cz}, 2.3, 0, 1);
      break;
    case 1:  // A lying drum on two saddles.
      for (const double at : {cx - 0.9, cx + 0.9}) {
        box(b, Mat::kSlab, {at - 0.15, y, cz - 0.6}, {at + 0.15, y + 0.8, cz + 0.6}, kNoBottom);
      }
      cylinder(b, Mat::kTank, {cx - 1.5, y + 1.1, cz}, {cx + 1.5, y + 1.1, cz}, 0.65 * size, 14,
               true);
      riser({cx - 0.8, y + 1.6, cz}, 1.0, 0.1);
      riser({cx + 0.8, y + 1.6, cz}, 0.8, 0.08);
      break;
    case 2:  // Two pumps with their motors.
      for (const double at : {cz - 0.7, cz + 0.7}) {
        box(b, Mat::kSteel, {cx - 1.1, y, at - 0.35}, {cx + 1.1, y + 0.25, at + 0.35}, kNoBottom);
        cylinder(b, Mat::kTank, {cx - 1.0, y + 0.6, at}, {cx - 0.1, y + 0.6, at}, 0.32 * size, 10,
                 true);
        cylinder(b, Mat::kPipe, {cx - 0.1, y + 0.6, at}, {cx + 0.4, y + 0.6, at}, 0.1, 6, false);
        frustum(b, Mat::kTank, {cx + 0.7, y + 0.25, at}, 0.4 * size, 0.3, 0.7, 10, true);
        riser({cx + 0.7, y + 0.9, at}, 0.9, 0.09);
      }
      break;
    default:  // A row of cabinets.
      for (int32_t i = 0; i < 4; ++i) {
        const double at = cx - 1.6 + 0.8 * i;
        box(b, Mat::kTank, {at, y, cz - 0.3}, {at + 0.76, y + 2.0, cz + 0.3}, kNoBottom);
        box(b, Mat::kGlass, {at + 0.15, y + 1.3, cz + 0.3}, {at + 0.6, y + 1.6, cz + 0.32},
            kNoBottom);
      }
      riser({cx, y + 2.0, cz}, 1.2, 0.06);
      break;
  }
}

// Pipes under the floor above, along x and, lower, along z, with a flange at every bay.
void add_rack(WorldBuilder& b, const Plan& p, int32_t i, int32_t j, int32_t level, Use use) {
  const double x = p.x(i);
  const double z = p.z(j);
  const double y = level * kStorey;
  const auto radius = [&](int32_t line, int32_t level_of, uint64_t k) {  // The same along a line.
    return 0.05 + 0.1 * static_cast<double>(p.dice(line, 4000, level_of, k) >> 40) * 0x1p-24;
  };
  for (int32_t k = 0; k < 3; ++k) {
    const double r = radius(j, level, static_cast<uint64_t>(k));
    const double at = z + 4.55 + 0.4 * k;
    cylinder(b, Mat::kPipe, {x, y + 2.98, at}, {x + kBay, y + 2.98, at}, r, 8, false);
    cylinder(b, Mat::kSteel, {x + 2.9, y + 2.98, at}, {x + 3.0, y + 2.98, at}, r + 0.04, 8, true);
  }
  if (use == Use::kStairs) return;
  for (int32_t k = 0; k < 2; ++k) {
    const double r = radius(i, level, static_cast<uint64_t>(k) + 8);
    const double at = x + 4.75 + 0.45 * k;
    cylinder(b, Mat::kPipe, {at, y + 2.66, z}, {at, y + 2.66, z + kBay}, r, 8, false);
    cylinder(b, Mat::kSteel, {at, y + 2.66, z + 2.9}, {at, y + 2.66, z + 3.0}, r + 0.04, 8, true);
  }
}

void add_shaft(WorldBuilder& b, const Plan& p, int32_t i, int32_t j, int32_t level) {
  const double y = level * kStorey;
  for (int32_t k = 0; k < 6; ++k) {
    const double r =
        0.15 + 0.25 * static_cast<double>(p.dice(i, j, 3000, static_cast<uint64_t>(k)) & 255) / 255;
    const double x = p.x(i) + 1.0 + 1.9 * (k % 3);
    const double z = p.z(j) + 1.6 + 2.6 * (k / 3);
    cylinder(b, Mat::kPipe, {x, y, z}, {x, y + kStorey, z}, r, 10, false);
    cylinder(b, Mat::kSteel, {x, y + 0.1, z}, {x, y + 0.25, z}, r + 0.05, 10, true);
  }
  ladder(b, {p.x(i) + 5.7, y, p.z(j) + 3}, kStorey, 0, 1);
}

void add_bay(WorldBuilder& b, const Plan& p, int32_t i, int32_t j, int32_t level) {
  const Use use = p.use(i, j, level);
  const double x = p.x(i);
  const double z = p.z(j);
  const double y = level * kStorey;
  if (use == Use::kBoiler) return;
  if (level > 0) {
    // Beams under the floor's low sides; the frame's last row closes the other two.
    const double top = y - 0.05;
    box(b, Mat::kSteel, {x, top - 0.3, z - 0.1}, {x + kBay, top, z + 0.1}, kSides | kLowY);
    box(b, Mat::kSteel, {x - 0.1, top - 0.3, z}, {x + 0.1, top, z + kBay}, kSides | kLowY);
    if (use == Use::kShaft) {
      add_shaft(b, p, i, j, level);
      if (level < p.levels) add_rack(b, p, i, j, level, use);
      return;
    }
    std::vector<Rect> holes;
    if (use == Use::kStairs) {
      const Dogleg d = well(0);
      holes.push_back({x + d.x, z + d.z, x + d.x + d.length(), z + d.z + d.depth()});
    }
    add_grating(b, x, z, y, holes);
    const auto guard = [&](int32_t ni, int32_t nj, Vec3d from, Vec3d to) {
      if (!p.has_floor(ni, nj, level)) railing(b, from, to);
    };
    guard(i - 1, j, {x + 0.25, y, z}, {x + 0.25, y, z + kBay});
    guard(i + 1, j, {x + kBay - 0.25, y, z}, {x + kBay - 0.25, y, z + kBay});
    guard(i, j - 1, {x, y, z + 0.25}, {x + kBay, y, z + 0.25});
    guard(i, j + 1, {x, y, z + kBay - 0.25}, {x + kBay, y, z + kBay - 0.25});
  }
  if (use == Use::kStairs) add_stairs(b, p, x, z, level);
  if (level == p.levels) return;
  if (use == Use::kVessel) add_vessel(b, x, z, y, p.dice(i, j, level, 5));
  add_rack(b, p, i, j, level, use);
}

void add_boiler(WorldBuilder& b, const Plan& p, int32_t bi, int32_t bj) {
  const int32_t i = bi * kBlock + 2;
  const int32_t j = bj * kBlock + 2;
  if (i >= p.nx || j >= p.nz || !p.in_boiler(i, j)) return;
  b.node(fmt::format("boiler {} {}", bi, bj));
  const double x0 = p.x(i) + 0.5;
  const double z0 = p.z(j) + 0.5;
  const double x1 = p.x(i + 2) - 0.5;
  const double z1 = p.z(j + 2) - 0.5;
  const double top = p.boiler_top(i, j) * kStorey - 1.2;
  box(b, Mat::kTank, {x0, 0, z0}, {x1, top, z1}, kNoBottom);
  for (double y = 1.5; y < top; y += 1.75) {  // Buckstays around it.
    box(b, Mat::kSteel, {x0 - 0.2, y, z0 - 0.2}, {x1 + 0.2, y + 0.25, z1 + 0.2});
  }
  // The chimney goes through the roof; the first one is the highest point of the plant.
  const double height = p.levels * kStorey + (bi == 0 && bj == 0 ? kChimney : 4.0 + (bi + bj) % 4);
  const double cx = (x0 + x1) / 2;
  const double cz = (z0 + z1) / 2;
  frustum(b, Mat::kStone, {cx, top, cz}, 2.4, 1.7, height - top, 24, true);
  for (int32_t ring = 0; ring < 3; ++ring) {
    frustum(b, Mat::kCar, {cx, height - 1.0 - 1.8 * ring, cz}, 1.95, 1.9, 0.7, 24, true);
  }
}

// Measured: triangles of a bay and storey, with and without boilers, and of an outer edge.
double expected_triangles(int32_t nx, int32_t nz, int32_t levels) {
  const double per_bay = std::min(nx, nz) < 5 ? 485 : 441;
  return (levels + 0.5) * (per_bay * nx * nz + 48.0 * 2 * (nx + nz));
}

}  // namespace

double powerplant_size(uint64_t triangles, int32_t levels) {
  int32_t n = 0;
  while (expected_triangles(n + 1, n + 1, levels) <= static_cast<double>(triangles)) ++n;
  return n * kBay;
}

void build_powerplant(WorldBuilder& b, const BuiltinWorldConfig& config) {
  Plan p;
  p.levels = config.levels;
  p.seed = config.seed;
  p.nx = static_cast<int32_t>(config.size / kBay + 1e-9);
  p.nz = p.nx;
  if (config.triangles != 0) {  // As square as the number allows.
    const auto miss = [&](int32_t nz) {
      return std::fabs(expected_triangles(p.nx, nz, p.levels) -
                       static_cast<double>(config.triangles));
    };
    while (miss(p.nz + 1) < miss(p.nz)) ++p.nz;
    b.reserve(static_cast<size_t>(static_cast<double>(config.triangles) * 0.75));
  }
  const double dx = p.nx * kBay;
  const double dz = p.nz * kBay;
  b.node("yard");
  floor_rect(b, Mat::kPavement, {-kYard, -kYard, dx + kYard, dz + kYard}, 0);
  b.node("columns");
  const double top = p.levels * kStorey;
  for (int32_t j = 0; j <= p.nz; ++j) {
    for (int32_t i = 0; i <= p.nx; ++i) {
      if (p.in_boiler(i, j) && p.in_boiler(i - 1 + (i % kBlock == 2), j) && i % kBlock == 3 &&
          j % kBlock == 3) {
        continue;  // Would stand inside the boiler.
      }
      box(b, Mat::kSteel, {p.x(i) - 0.15, 0, p.z(j) - 0.15},
          {p.x(i) + 0.15, top + 1.1, p.z(j) + 0.15}, kNoBottom);
    }
  }
  for (int32_t level = 0; level <= p.levels; ++level) {
    b.node(fmt::format("level {}", level));
    for (int32_t j = 0; j < p.nz; ++j) {
      for (int32_t i = 0; i < p.nx; ++i) add_bay(b, p, i, j, level);
    }
    if (level == 0) continue;
    const double y = level * kStorey - 0.05;
    box(b, Mat::kSteel, {dx - 0.1, y - 0.3, 0}, {dx + 0.1, y, dz}, kSides | kLowY);
    box(b, Mat::kSteel, {0, y - 0.3, dz - 0.1}, {dx, y, dz + 0.1}, kSides | kLowY);
  }
  for (int32_t bj = 0; bj * kBlock < p.nz; ++bj) {
    for (int32_t bi = 0; bi * kBlock < p.nx; ++bi) add_boiler(b, p, bi, bj);
  }
}

}  // namespace throng::importer::builtin
