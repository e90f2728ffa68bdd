// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_building.h"
#include "import/builtin/world_shapes.h"

// A city of square blocks, about 125 m from street to street, in groups of 4 x 4 blocks with the
// same content, so that the triangles grow with the area: two squares, twelve blocks of eight
// houses around a yard, a canal with a towpath, bridges and stairs, a pedestrian underpass. Above
// 16 km2 some houses lose their inside, more of them the larger the city.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kPitch = 125;
constexpr double kHalfRoad = 4.5;
constexpr double kKerb = 0.12;
constexpr double kPavement = 3.5;
constexpr double kCanal = 2.6;       // Depth of the towpath.
constexpr double kUnderpass = 2.88;  // Depth of the tunnel's floor.
constexpr double kNotch = 1.6;       // Width of stairs sunk into a pavement.
constexpr double kPerKm2 = 330e3;    // Triangles of the full detail: measured.
constexpr double kMaxTriangles = 14e6;

struct Plan {
  int32_t n = 4;
  double pitch = kPitch;
  double inside = 1;  // Share of the houses that have an inside.
  uint64_t seed = 1;
  [[nodiscard]] double block() const { return pitch - 2 * kHalfRoad; }
  // What lies along the boundary below row bz: a canal, a street with an underpass, a street.
  [[nodiscard]] bool is_canal(int32_t bz) const { return bz > 0 && bz < n && bz % 4 == 2; }
  [[nodiscard]] bool has_underpass(int32_t bx, int32_t bz) const {
    return bz > 0 && bz < n && bz % 4 == 1 && bx % 4 == 1;
  }
  [[nodiscard]] bool has_canal_stairs(int32_t bx, int32_t bz) const {
    return is_canal(bz) && bx % 2 == 1;
  }
  [[nodiscard]] static bool is_square(int32_t bx, int32_t bz) {
    return (bx % 4 == 1 && bz % 4 == 1) || (bx % 4 == 3 && bz % 4 == 2);
  }
  [[nodiscard]] uint64_t dice(int32_t bx, int32_t bz, uint64_t k) const {
    return random_u64(seed, (static_cast<uint64_t>(bz) << 20) | static_cast<uint64_t>(bx), k);
  }
  [[nodiscard]] double unit(int32_t bx, int32_t bz, uint64_t k) const {
    return static_cast<double>(dice(bx, bz, k) >> 11) * 0x1p-53;
  }
};

// Stairs or a ramp sunk into a pavement. In the frame of a street's edge: x along the street, z
// into the block. The landing at the bottom is x in [0, 2.4]; from there it climbs towards +x.
struct Sunken {
  double depth = 2.6;  // Under the street; the pavement is a kerb higher.
  bool ramp = false;
  [[nodiscard]] double climb() const { return depth + kKerb; }
  [[nodiscard]] int32_t risers() const { return static_cast<int32_t>(climb() / 0.175 + 0.999); }
  [[nodiscard]] double length() const { return ramp ? climb() / 0.12 : (risers() - 1) * 0.29; }
  [[nodiscard]] Rect hole() const { return {0, 0, 2.4 + length(), kNotch}; }
};

void add_sunken(WorldBuilder& b, const Sunken& s) {
  const Rect r = s.hole();
  const double y = -s.depth;
  floor_rect(b, Mat::kFloor, {0, 0, 2.4, kNotch}, y);
  if (s.ramp) {
    const uint32_t v0 = b.vertex({2.4, y, 0});
    const uint32_t v1 = b.vertex({2.4, y, kNotch});
    const uint32_t v2 = b.vertex({r.x1, kKerb, kNotch});
    b.quad(Mat::kRamp, v0, v1, v2, b.vertex({r.x1, kKerb, 0}));
  } else {
    flight(b, Mat::kStairs,
           {.x = 2.4,
            .y = y,
            .z = 0,
            .width = kNotch,
            .rise = s.climb() / s.risers(),
            .run = 0.29,
            .risers = s.risers(),
            .thickness = 0.3});
    thin_wall(b, Mat::kStone, r.x1, kNotch, r.x1, 0, y, kKerb);
  }
  thin_wall(b, Mat::kStone, 0, 0, 0, kNotch, y, kKerb);
  thin_wall(b, Mat::kStone, 0, kNotch, r.x1, kNotch, y, kKerb);
  thin_wall(b, Mat::kStone, r.x1, 0, 2.4, 0, y, kKerb);
  railing(b, {-0.05, kKerb, 0}, {-0.05, kKerb, kNotch});
  railing(b, {0, kKerb, kNotch + 0.05}, {r.x1, kKerb, kNotch + 0.05});
  railing(b, {0, kKerb, 0.05}, {r.x1, kKerb, 0.05});
}

// The frame of a block's edge: the low-z side, or (far) the high-z side seen from its own street.
Frame edge_frame(const Plan& p, int32_t bx, int32_t bz, bool far) {
  const double x = (bx + 0.5) * p.pitch;
  return far ? Frame{{x, 0, (bz + 1) * p.pitch - kHalfRoad}, -1, 0}
             : Frame{{x, 0, bz * p.pitch + kHalfRoad}, 1, 0};
}

Rect to_world(const Frame& f, const Rect& r) {
  const Vec3d a = f({r.x0, 0, r.z0});
  const Vec3d c = f({r.x1, 0, r.z1});
  return {std::min(a.x, c.x), std::min(a.z, c.z), std::max(a.x, c.x), std::max(a.z, c.z)};
}

// Both ends of the underpass have their landing over the same stretch of x, hence the shift.
Frame underpass_frame(const Plan& p, int32_t bx, int32_t bz, bool far) {
  Frame f = edge_frame(p, bx, bz, far);
  f.origin.x += far ? 1.2 : -1.2;
  return f;
}

void add_underpass(WorldBuilder& b, const Plan& p, int32_t bx, int32_t bz) {
  const double x0 = (bx + 0.5) * p.pitch - 1.2;
  const double z0 = bz * p.pitch - kHalfRoad;
  const double z1 = bz * p.pitch + kHalfRoad;
  floor_rect(b, Mat::kFloor, {x0, z0, x0 + 2.4, z1}, -kUnderpass);
  floor_rect(b, Mat::kSlab, {x0, z0, x0 + 2.4, z1}, -0.45);
  thin_wall(b, Mat::kStone, x0, z1, x0, z0, -kUnderpass, 0);
  thin_wall(b, Mat::kStone, x0 + 2.4, z0, x0 + 2.4, z1, -kUnderpass, 0);
  for (const double z : {z0, z1}) {  // Lintels over the two mouths.
    thin_wall(b, Mat::kStone, x0, z, x0 + 2.4, z, -0.45, kKerb);
  }
}

// The canal below row bz between two crossings, and the bridge that carries the street on its left.
void add_canal(WorldBuilder& b, const Plan& p, int32_t bx, int32_t bz) {
  const double x0 = bx * p.pitch;
  const double x1 = x0 + p.pitch;
  const double z = bz * p.pitch;
  const double low = z - kHalfRoad;
  const double high = z + kHalfRoad;
  const double path = low + 2.6;
  floor_rect(b, Mat::kPavement, {x0, low, x1, path}, -kCanal);
  floor_rect(b, Mat::kWater, {x0, path, x1, high}, -kCanal - 0.4);
  thin_wall(b, Mat::kStone, x1, path, x0, path, -kCanal - 0.6, -kCanal);
  thin_wall(b, Mat::kStone, x1, high, x0, high, -kCanal - 0.6, 0);
  if (p.has_canal_stairs(bx, bz)) {  // The towpath's wall opens where the stairs come down.
    const Rect door = to_world(edge_frame(p, bx, bz - 1, true), {0, 0, 2.4, 0});
    thin_wall(b, Mat::kStone, x0, low, door.x0, low, -kCanal, 0);
    thin_wall(b, Mat::kStone, door.x1, low, x1, low, -kCanal, 0);
  } else {
    thin_wall(b, Mat::kStone, x0, low, x1, low, -kCanal, 0);
  }
  for (const double edge : {low - 0.1, high + 0.1}) {
    railing(b, {x0 + kHalfRoad, kKerb, edge}, {x1 - kHalfRoad, kKerb, edge}, 1.0, 4.0);
  }
  // Half of the bridge at each end of this stretch.
  for (const auto& [a, c] : {std::array{x0, x0 + kHalfRoad}, std::array{x1 - kHalfRoad, x1}}) {
    box(b, Mat::kStone, {a, -0.4, low}, {c, -0.001, high}, kSides | kLowY);
    floor_rect(b, Mat::kRoad, {a, low, c, high}, 0);
    const double edge = a == x0 ? c - 0.1 : a + 0.1;
    railing(b, {edge, 0, low}, {edge, 0, high});
  }
}

void add_streets(WorldBuilder& b, const Plan& p, int32_t bx, int32_t bz) {
  const double x0 = bx * p.pitch;
  const double z0 = bz * p.pitch;
  const double x1 = x0 + p.pitch;
  const double z1 = z0 + p.pitch;
  const double h = kHalfRoad;
  // Half of each street around the block; a canal takes the place of its half.
  const double low = z0 + (p.is_canal(bz) ? h : 0);
  const double high = z1 - (p.is_canal(bz + 1) ? h : 0);
  floor_rect(b, Mat::kRoad, {x0, low, x0 + h, high}, 0);
  floor_rect(b, Mat::kRoad, {x1 - h, low, x1, high}, 0);
  if (low == z0) floor_rect(b, Mat::kRoad, {x0 + h, z0, x1 - h, z0 + h}, 0);
  if (high == z1) floor_rect(b, Mat::kRoad, {x0 + h, z1 - h, x1 - h, z1}, 0);

  // Parked cars, at most one for each 25 m of kerb.
  for (uint64_t k = 0; k < 8; ++k) {
    if (p.unit(bx, bz, 100 + k) > 0.55 * std::sqrt(p.inside)) continue;
    const double along = 12 + (p.block() - 24) * (static_cast<double>(k % 4) + 0.5) / 4;
    const auto variant = static_cast<uint32_t>(p.dice(bx, bz, 120 + k) % 12);
    if (k < 4) {
      b.place({{x0 + h - 1.2, 0, z0 + h + along}, 0, 1});
    } else {
      b.place({{x1 - h + 1.2, 0, z0 + h + along}, 0, -1});
    }
    car(b, variant, CarDetail::kPlain);
    b.place({});
  }
}

// Trees along the kerb, clear of what is sunk into the pavement.
void add_street_trees(WorldBuilder& b, const Plan& p, const Rect& block,
                      std::span<const Rect> holes, int32_t bx, int32_t bz) {
  const double run = p.block();
  const int32_t count = p.inside < 1 ? 3 : 5;
  for (int32_t side = 0; side < 4; ++side) {
    for (int32_t i = 0; i < count; ++i) {
      const double along = run * (i + 0.5) / count;
      const double x = side == 0 ? block.x0 + 0.8 : side == 1 ? block.x1 - 0.8 : block.x0 + along;
      const double z = side == 2 ? block.z0 + 0.8 : side == 3 ? block.z1 - 0.8 : block.z0 + along;
      const bool sunk = std::any_of(holes.begin(), holes.end(), [&](const Rect& r) {
        return x > r.x0 - 2 && x < r.x1 + 2 && z > r.z0 - 2 && z < r.z1 + 2;
      });
      if (!sunk) tree(b, {x, kKerb, z}, p.dice(bx, bz, 200 + static_cast<uint64_t>(side * 8 + i)));
    }
  }
}

void add_square(WorldBuilder& b, const Plan& p, const Rect& block, int32_t bx, int32_t bz) {
  const double cx = (block.x0 + block.x1) / 2;
  const double cz = (block.z0 + block.z1) / 2;
  const double far = p.block() / 2 - kPavement - 1;
  for (int32_t quarter = 0; quarter < 4; ++quarter) {
    const double sx = quarter % 2 == 0 ? -1 : 1;
    const double sz = quarter / 2 == 0 ? -1 : 1;
    const double x0 = cx + sx * (sx < 0 ? far : 8);
    const double z0 = cz + sz * (sz < 0 ? far : 8);
    box(b, Mat::kGrass, {x0, kKerb, z0}, {x0 + far - 8, kKerb + 0.1, z0 + far - 8}, kNoBottom);
    for (uint64_t i = 0; i < 9; ++i) {
      const uint64_t k = 300 + static_cast<uint64_t>(quarter) * 20 + i;
      const double cell = (far - 8) / 3;
      const double tx = x0 + cell * (static_cast<double>(i % 3) + 0.3 + 0.4 * p.unit(bx, bz, k));
      const double tz =
          z0 + cell * (static_cast<double>(i / 3) + 0.3 + 0.4 * p.unit(bx, bz, k + 10));
      tree(b, {tx, kKerb + 0.1, tz}, p.dice(bx, bz, k + 400));
    }
  }
  // A fountain where the footpaths cross.
  cylinder(b, Mat::kStone, {cx, kKerb, cz}, {cx, kKerb + 0.55, cz}, 3.5, 16, true);
  frustum(b, Mat::kWater, {cx, kKerb + 0.55, cz}, 3.1, 3.0, 0.02, 16, true);
  frustum(b, Mat::kStone, {cx, kKerb + 0.55, cz}, 0.5, 0.2, 1.6, 8, true);
}

void add_houses(WorldBuilder& b, const Plan& p, const Rect& block, int32_t bx, int32_t bz) {
  const double x0 = block.x0 + kPavement;
  const double z0 = block.z0 + kPavement;
  const double lot = (p.block() - 2 * kPavement) / 3;
  for (int32_t k = 0; k < 9; ++k) {
    const int32_t i = k % 3;
    const int32_t j = k / 3;
    const double cx = x0 + (i + 0.5) * lot;
    const double cz = z0 + (j + 0.5) * lot;
    const auto roll = [&](uint64_t n) {
      return p.unit(bx, bz, 1000 + static_cast<uint64_t>(k) * 16 + n);
    };
    if (k == 4) {  // The yard.
      box(b, Mat::kGrass, {cx - lot / 2 + 3, kKerb, cz - lot / 2 + 3},
          {cx + lot / 2 - 3, kKerb + 0.1, cz + lot / 2 - 3}, kNoBottom);
      for (uint64_t t = 0; t < 5; ++t) {
        tree(
            b,
            {cx + (roll(t) - 0.5) * (lot - 12), kKerb + 0.1, cz + (roll(t + 5) - 0.5) * (lot - 12)},
            p.dice(bx, bz, 1200 + t));
      }
      continue;
    }
    Building h;
    h.width = std::floor(std::min(lot - 5, 21 + 9 * roll(0)));
    h.depth = std::floor(std::min(lot - 8, 14 + 5 * roll(1)));
    const double height = roll(2);
    h.storeys = height < 0.25 ? 1 : height < 0.6 ? 2 : height < 0.85 ? 3 : 4;
    h.gable = h.storeys <= 2 && roll(3) < 0.6;
    h.roof_access = !h.gable && roll(4) < 0.4;
    h.interior = roll(5) < p.inside;
    // Fronts face the nearest street; corner lots the one along x.
    const double setback = lot / 2 - h.depth / 2 - 0.5;
    Frame f{{cx, kKerb, cz}, 1, 0};
    if (j == 0) f.origin.z -= setback;
    if (j == 2) f = {{cx, kKerb, cz + setback}, -1, 0};
    if (j == 1) f = {{cx + (i == 0 ? -setback : setback), kKerb, cz}, 0, i == 0 ? -1.0 : 1.0};
    b.place(f);
    add_building(b, h);
    b.place({});
  }
}

void add_block(WorldBuilder& b, const Plan& p, int32_t bx, int32_t bz) {
  const Rect block{bx * p.pitch + kHalfRoad, bz * p.pitch + kHalfRoad,
                   (bx + 1) * p.pitch - kHalfRoad, (bz + 1) * p.pitch - kHalfRoad};
  std::vector<Rect> holes;
  const auto sink = [&](const Frame& frame, const Sunken& sunken) {
    holes.push_back(to_world(frame, sunken.hole()));
    b.place(frame);
    add_sunken(b, sunken);
    b.place({});
  };
  if (p.has_canal_stairs(bx, bz + 1)) sink(edge_frame(p, bx, bz, true), {.depth = kCanal});
  if (p.has_underpass(bx, bz + 1)) {
    sink(underpass_frame(p, bx, bz, true), {.depth = kUnderpass});
  }
  if (p.has_underpass(bx, bz)) {  // Up a ramp on this side.
    sink(underpass_frame(p, bx, bz, false), {.depth = kUnderpass, .ramp = true});
  }
  floor_with_holes(b, Mat::kPavement, block, holes, kKerb);
  box(b, Mat::kKerb, {block.x0, 0, block.z0}, {block.x1, kKerb, block.z1}, kSides);
  add_street_trees(b, p, block, holes, bx, bz);
  if (Plan::is_square(bx, bz)) {
    add_square(b, p, block, bx, bz);
  } else {
    add_houses(b, p, block, bx, bz);
  }
}

}  // namespace

double city_size(uint64_t triangles) {
  return std::sqrt(static_cast<double>(triangles) / kPerKm2) * 1000;
}

void build_city(WorldBuilder& b, const BuiltinWorldConfig& config) {
  Plan p;
  p.n = std::max(1, static_cast<int32_t>(config.size / kPitch + 0.5));
  p.pitch = config.size / p.n;
  p.seed = config.seed;
  const double km2 = config.size * config.size / 1e6;
  p.inside = std::clamp((kMaxTriangles / km2 - 75e3) / (kPerKm2 - 75e3), 0.0, 1.0);
  for (int32_t dz = 0; dz < p.n; dz += 4) {
    for (int32_t dx = 0; dx < p.n; dx += 4) {
      b.node(fmt::format("district {} {}", dx / 4, dz / 4));
      for (int32_t bz = dz; bz < std::min(dz + 4, p.n); ++bz) {
        for (int32_t bx = dx; bx < std::min(dx + 4, p.n); ++bx) {
          add_streets(b, p, bx, bz);
          add_block(b, p, bx, bz);
          if (p.is_canal(bz)) add_canal(b, p, bx, bz);
          if (p.has_underpass(bx, bz)) add_underpass(b, p, bx, bz);
        }
      }
    }
  }
}

}  // namespace throng::importer::builtin
