// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// A car park like the garage of [ML06], whose model is lost: from 86 slices at 0.1 m its height
// follows, 10.25 m. Storeys of 2.9 m; the roof is parked on as well, behind a parapet of 1.55 m.
// The plan is made of modules of about 60 x 40 m: two parking aisles along x and, between them, a
// strip with the ramp (2.9 m up in 24 m: 12 %) and two stairwells.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kStorey = 2.9;
constexpr double kSlab = 0.3;
constexpr double kParapet = 1.55;
constexpr double kModule = 40;  // Along z.
constexpr double kRampRun = 24;
constexpr double kRampWidth = 6;
constexpr double kBay = 2.5;  // Width of a parking space.
constexpr double kRowDepth = 5;
constexpr double kWall = 0.25;
constexpr double kWellLong = 6.6;  // Stairwell, outside of its walls.
constexpr double kWellDeep = 3.4;
constexpr std::array<double, 4> kRows = {0.4, 11.2, 23.8, 34.6};  // Low z of the parking rows.

struct Plan {
  int32_t modules_x = 1;
  int32_t modules_z = 1;
  int32_t levels = 3;
  double module_x = 60;
  CarDetail detail = CarDetail::kFull;
  double parked = 0.6;  // Share of the spaces in use.
  uint64_t seed = 1;
  [[nodiscard]] double width() const { return modules_x * module_x; }
  [[nodiscard]] double depth() const { return modules_z * kModule; }
  [[nodiscard]] double ramp_x(int32_t i) const { return i * module_x + (module_x - kRampRun) / 2; }
  [[nodiscard]] double ramp_z(int32_t j) const { return j * kModule + (kModule - kRampWidth) / 2; }
  [[nodiscard]] double well_x(int32_t i, int32_t which) const {
    const double margin = (module_x - kRampRun) / 2 - kWellLong;  // Left beside the ramp's ends.
    const double off = std::min(1.0, margin / 4);
    return i * module_x + (which == 0 ? off : module_x - off - kWellLong);
  }
  [[nodiscard]] double well_z(int32_t j) const { return j * kModule + (kModule - kWellDeep) / 2; }
};

// The holes of one module in the slab above a storey: over the ramp, and the two wells' flights.
void add_holes(const Plan& p, int32_t i, int32_t j, std::vector<Rect>& holes) {
  const double x = p.ramp_x(i);
  const double z = p.ramp_z(j);
  holes.push_back({x + 2, z, x + kRampRun, z + kRampWidth});
  for (int32_t which = 0; which < 2; ++which) {
    const double wx = p.well_x(i, which);
    const double wz = p.well_z(j);
    holes.push_back({wx + 1.8, wz + 0.2, wx + kWellLong - 0.2, wz + kWellDeep - 0.2});
  }
}

// The slab of a module. It ends within the outer walls: faces in one plane would flicker.
Rect plate(const Plan& p, int32_t i, int32_t j) {
  const double in = kWall / 2;
  return {std::max(i * p.module_x, in), std::max(j * kModule, in),
          std::min((i + 1) * p.module_x, p.width() - in),
          std::min((j + 1) * kModule, p.depth() - in)};
}

void add_ramp(WorldBuilder& b, const Plan& p, int32_t i, int32_t j, int32_t level) {
  const double x0 = p.ramp_x(i);
  const double x1 = x0 + kRampRun;
  const double z0 = p.ramp_z(j);
  const double z1 = z0 + kRampWidth;
  const double y0 = level * kStorey;
  const double y1 = y0 + kStorey;
  const double under = level == 0 ? y0 : y0 - kSlab;
  const double under_end =
      level == 0 ? y0 : y1 - kSlab;  // The lowest ramp is filled to the ground.
  const auto sloped = [&](Mat material, double a, double c, double low0, double low1, double high) {
    hexahedron(b, material,
               {{{x0, low0, a},
                 {x0, low0, c},
                 {x1, low1, c},
                 {x1, low1, a},
                 {x0, y0 + high, a},
                 {x0, y0 + high, c},
                 {x1, y1 + high, c},
                 {x1, y1 + high, a}}});
  };
  sloped(Mat::kRamp, z0 + 0.15, z1 - 0.15, under, under_end, 0);
  sloped(Mat::kWall, z0, z0 + 0.15, under, under_end, 0.9);
  sloped(Mat::kWall, z1 - 0.15, z1, under, under_end, 0.9);
  for (const double z : {z0 - 0.05, z1 + 0.05}) railing(b, {x0 + 2, y1, z}, {x1, y1, z}, 1.0, 3.0);
  if (level + 1 == p.levels) railing(b, {x0 + 1.95, y1, z0}, {x0 + 1.95, y1, z1}, 1.0, 3.0);
}

void add_stairwell(WorldBuilder& b, const Plan& p, int32_t i, int32_t j, int32_t which) {
  const double x = p.well_x(i, which);
  const double z = p.well_z(j);
  const double x1 = x + kWellLong;
  const double z1 = z + kWellDeep;
  for (int32_t level = 0; level <= p.levels; ++level) {
    const double y = level * kStorey;
    const double top = level == p.levels ? y + kParapet : y + kStorey - kSlab;
    const double h = top - y;
    const std::array<Opening, 1> door{{{0.9, 2.3, 0, std::min(h, 2.2)}}};
    wall(b, Mat::kWall, x, z + 0.1, x1, z + 0.1, y, top, 0.2);
    wall(b, Mat::kWall, x, z1 - 0.1, x1, z1 - 0.1, y, top, 0.2);
    wall(b, Mat::kWall, x + 0.1, z + 0.2, x + 0.1, z1 - 0.2, y, top, 0.2, door);
    wall(b, Mat::kWall, x1 - 0.1, z + 0.2, x1 - 0.1, z1 - 0.2, y, top, 0.2);
    if (level == p.levels) break;
    dogleg(b, Mat::kStairs,
           {.x = x + 1.8,
            .y = y,
            .z = z + 0.2,
            .height = kStorey,
            .width = 1.4,
            .run = 0.28,
            .landing = kWellLong - 2.0 - 8 * 0.28});
  }
  // A kerb in front of the door, on the ground only: slabs above are level with the wells.
  for (const double side : {z - 0.6, z1}) {
    box(b, Mat::kKerb, {x, 0, side}, {x1, 0.12, side + 0.6}, kNoBottom);
  }
}

void add_outer_walls(WorldBuilder& b, const Plan& p) {
  // Piers through all storeys, a band per storey, an open slot between: the walls reach from the
  // ground to the parapet without a gap in height.
  const double w = p.width();
  const double d = p.depth();
  const double top = p.levels * kStorey + kParapet;
  const auto side = [&](double x0, double z0, double x1, double z1, bool has_exits) {
    const double run = std::fabs(x1 - x0) + std::fabs(z1 - z0);
    const auto piers = static_cast<int32_t>(run / 7.5 + 0.5);
    const double dx = (x1 - x0) / run;
    const double dz = (z1 - z0) / run;
    const auto part = [&](double from, double to, double low, double high) {
      wall(b, Mat::kWall, x0 + from * dx, z0 + from * dz, x0 + to * dx, z0 + to * dz, low, high,
           kWall);
    };
    const double pitch = run / piers;
    for (int32_t i = 0; i <= piers; ++i) {
      const double at = std::clamp(i * pitch, 0.3, run - 0.3);
      part(at - 0.3, at + 0.3, 0, top);
    }
    for (int32_t level = 0; level < p.levels; ++level) {
      const double y = level * kStorey;
      const double band = level + 1 == p.levels ? y + kStorey + kParapet : y + kStorey + 1.1;
      part(0, run, y + kStorey - kSlab - 0.1, band);
      if (level > 0) continue;
      if (!has_exits) {
        part(0, run, 0, 1.1);
        continue;
      }
      for (int32_t i = 0; i < piers; ++i) {  // One bay in eight is an exit to the street.
        if (i % 8 != 1) part(i * pitch, (i + 1) * pitch, 0, 1.1);
      }
    }
  };
  const double h = kWall / 2;
  side(0, h, w, h, true);
  side(0, d - h, w, d - h, true);
  side(h, kWall, h, d - kWall, false);
  side(w - h, kWall, w - h, d - kWall, false);
}

// Spaces next to the core strip stay empty at the ends of the ramp, where cars turn.
bool is_space(const Plan& p, int32_t row, double x_in_module) {
  if (row == 0 || row == 3) return true;
  const double ramp = (p.module_x - kRampRun) / 2;
  const bool beside_ramp = x_in_module > ramp + 1 && x_in_module + kBay < ramp + kRampRun - 1;
  const bool beside_well =
      x_in_module + kBay < kWellLong + 1.5 || x_in_module > p.module_x - kWellLong - 1.5;
  return beside_ramp || beside_well;
}

void add_module(WorldBuilder& b, const Plan& p, int32_t i, int32_t j, int32_t level) {
  const double y = level * kStorey;
  const double mx = i * p.module_x;
  const double mz = j * kModule;
  const auto spaces = static_cast<int32_t>((p.module_x - 2) / kBay);
  const double first = (p.module_x - spaces * kBay) / 2;
  const auto stream = (static_cast<uint64_t>(level) * 4096 + static_cast<uint64_t>(j)) * 4096 +
                      static_cast<uint64_t>(i);
  for (int32_t row = 0; row < 4; ++row) {
    const bool nose_low = row == 0 || row == 2;  // Cars look towards low z.
    for (int32_t s = 0; s < spaces; ++s) {
      const double x = first + s * kBay;
      const double z = mz + kRows[static_cast<size_t>(row)];
      // A pillar at every third space, on the side away from the outer wall.
      if (level < p.levels && s % 3 == 0) {
        const double pz = nose_low ? z + kRowDepth - 0.4 : z + 0.4;
        box(b, Mat::kPillar, {mx + x - 0.2, y, pz - 0.2},
            {mx + x + 0.2, y + kStorey - kSlab, pz + 0.2}, kSides);
      }
      if (!is_space(p, row, x)) continue;
      const auto dice = [&](uint64_t k) {
        return random_u64(p.seed, stream, static_cast<uint64_t>(row * spaces + s) * 8 + k);
      };
      const double chance = static_cast<double>(dice(0) >> 11) * 0x1p-53;
      if (chance >= (level == p.levels ? p.parked / 2 : p.parked)) continue;
      const double sway = static_cast<double>(dice(1) >> 40) * 0x1p-24 * 0.3 - 0.15;
      const bool reversed = dice(2) % 4 == 0;
      const double uz = nose_low == reversed ? 1 : -1;
      b.place({{mx + x + kBay / 2 + sway, y, z + kRowDepth / 2 + sway}, 0, uz});
      auto variant = static_cast<uint32_t>(dice(3) % 12);
      if (level == p.levels && variant % 4 == 3) --variant;  // Vans would look over the parapet.
      car(b, variant, p.detail);
      b.place({});
    }
  }
}

}  // namespace

void build_garage(WorldBuilder& b, const BuiltinWorldConfig& config) {
  Plan p;
  p.modules_x = std::max(1, static_cast<int32_t>(config.size / 60 + 0.5));
  p.module_x = config.size / p.modules_x;
  p.modules_z = std::max(1, static_cast<int32_t>(config.size / 60 + 0.5));
  p.levels = config.levels;
  p.seed = config.seed;
  const double decks = static_cast<double>(p.modules_x) * p.modules_z * (p.levels + 1);
  if (decks > 100) {  // Many cars: this keeps within about three million triangles.
    p.detail = CarDetail::kPlain;
    p.parked = std::clamp(2'000'000 / (decks * 80 * 42), 0.05, 0.5);
  }

  b.node("ground");
  floor_rect(b, Mat::kFloor, {0, 0, p.width(), p.depth()}, 0);
  b.node("outer walls");
  add_outer_walls(b, p);
  for (int32_t level = 0; level <= p.levels; ++level) {
    if (level > 0) {
      b.node(fmt::format("slab {}", level));
      for (int32_t j = 0; j < p.modules_z; ++j) {
        for (int32_t i = 0; i < p.modules_x; ++i) {
          std::vector<Rect> holes;
          add_holes(p, i, j, holes);
          const double y = level * kStorey;
          slab(b, Mat::kFloor, Mat::kSlab, plate(p, i, j), holes, y - kSlab, y);
        }
      }
    }
    b.node(fmt::format("level {}", level));
    for (int32_t j = 0; j < p.modules_z; ++j) {
      for (int32_t i = 0; i < p.modules_x; ++i) {
        add_module(b, p, i, j, level);
        if (level < p.levels) add_ramp(b, p, i, j, level);
      }
    }
  }
  b.node("stairwells");
  for (int32_t j = 0; j < p.modules_z; ++j) {
    for (int32_t i = 0; i < p.modules_x; ++i) {
      for (int32_t which = 0; which < 2; ++which) add_stairwell(b, p, i, j, which);
    }
  }
}

}  // namespace throng::importer::builtin
