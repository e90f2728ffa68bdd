// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// A church like the one of [ML06], whose model is lost: from 159 slices its height follows, 17.55
// m. The nave runs along x between two arcades at z = +-4.5; side galleries lie over the aisles
// at 5.2 m and an organ loft at 10.4 m. Two west towers hold spiral stairs to both; the one at +z
// goes on to an open platform at 15.6 m.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kHeight = 17.55;
constexpr double kArcade = 4.5;
constexpr double kAisleWall = 9;  // Middle of the outer walls.
constexpr double kEaves = 9.6;
constexpr double kRidge = 16.15;  // Under the roof, at z = 0.
constexpr double kGallery = 5.2;
constexpr double kLoft = 10.4;
constexpr double kPlatform = 15.6;
constexpr double kTower = 5;  // The towers: x from 0 to 5, |z| from 4.2 to 9.3.
constexpr double kTowerIn = 4.2;
constexpr double kTowerOut = 9.3;
constexpr double kTowerMiddleX = 2.5;
constexpr double kTowerMiddleZ = 6.75;
constexpr double kSpiral = 1.95;

double roof_at(double z) {
  return kEaves + (kAisleWall - std::fabs(z)) * ((kRidge - kEaves) / kAisleWall);
}

struct Plan {
  double length = 42;
  int32_t bays = 6;
  [[nodiscard]] double chancel() const { return length - 8; }
  [[nodiscard]] double bay() const { return (chancel() - kTower) / bays; }
  [[nodiscard]] double column(int32_t i) const { return kTower + i * bay(); }
};

// A round arch between x0 and x1 in a wall of |z - middle| <= half, and the wall over it up to
// `top`.
void arch(WorldBuilder& b, double x0, double x1, double middle, double half, double spring,
          double top) {
  constexpr int32_t kParts = 12;
  const double radius = (x1 - x0) / 2;
  std::array<uint32_t, 4> last{};
  for (int32_t i = 0; i <= kParts; ++i) {
    const auto [c, s] = unit_circle(0.5 - 0.5 * i / kParts);
    const double x = x0 + radius + radius * c;
    const double y = spring + radius * s;
    const std::array<uint32_t, 4> now{
        b.vertex({x, y, middle - half}), b.vertex({x, y, middle + half}),
        b.vertex({x, top, middle - half}), b.vertex({x, top, middle + half})};
    if (i > 0) {
      b.quad(Mat::kStone, last[0], now[0], now[1], last[1]);
      b.quad(Mat::kWall, last[0], last[2], now[2], now[0]);
      b.quad(Mat::kWall, last[1], now[1], now[3], last[3]);
      b.quad(Mat::kWall, last[2], last[3], now[3], now[2]);
    }
    last = now;
  }
}

void column(WorldBuilder& b, double x, double z, double foot, double spring) {
  constexpr double kHalf = 0.42;
  box(b, Mat::kStone, {x - kHalf, foot, z - kHalf}, {x + kHalf, foot + 0.3, z + kHalf}, kNoBottom);
  cylinder(b, Mat::kPillar, {x, foot + 0.3, z}, {x, spring - 0.3, z}, 0.32, 12, false);
  hexahedron(b, Mat::kStone,
             {{{x - 0.3, spring - 0.3, z - 0.3},
               {x - 0.3, spring - 0.3, z + 0.3},
               {x + 0.3, spring - 0.3, z + 0.3},
               {x + 0.3, spring - 0.3, z - 0.3},
               {x - kHalf, spring, z - kHalf},
               {x - kHalf, spring, z + kHalf},
               {x + kHalf, spring, z + kHalf},
               {x + kHalf, spring, z - kHalf}}});
}

// A pointed window as a pane on each side of a wall along x at `z`, `half` thick on each side.
void window(WorldBuilder& b, double x, double z, double half, double sill, double head,
            double wide) {
  for (const double side : {-1.0, 1.0}) {
    const double at = z + side * (half + 0.01);
    std::vector<uint32_t> pane{
        b.vertex({x - wide / 2, sill, at}), b.vertex({x + wide / 2, sill, at}),
        b.vertex({x + wide / 2, head - wide * 0.8, at}), b.vertex({x, head, at}),
        b.vertex({x - wide / 2, head - wide * 0.8, at})};
    if (side < 0) std::reverse(pane.begin(), pane.end());
    b.polygon(Mat::kGlass, pane);
  }
}

// A round window as a pane on each side of a wall across x.
void rose_window(WorldBuilder& b, double west, double east, double y) {
  for (const double x : {west, east}) {
    std::vector<uint32_t> pane;
    for (int32_t i = 0; i < 16; ++i) {
      const auto [c, s] = unit_circle((i + 0.5) / 16);
      pane.push_back(b.vertex({x, y + 1.7 * s, 1.7 * c}));
    }
    if (x == east) std::reverse(pane.begin(), pane.end());
    b.polygon(Mat::kGlass, pane);
  }
}

void balustrade(WorldBuilder& b, double x0, double z0, double x1, double z1, double y) {
  wall(b, Mat::kStone, x0, z0, x1, z1, y, y + 0.95, 0.15);
}

void add_arcade(WorldBuilder& b, const Plan& p, double z) {
  for (int32_t i = 0; i <= p.bays; ++i) {
    const double x = p.column(i);
    column(b, x, z, 0, 2.7);
    column(b, x, z, kGallery, 7.6);
    box(b, Mat::kWall, {x - 0.42, 2.7, z - 0.25}, {x + 0.42, 4.9, z + 0.25});
    box(b, Mat::kWall, {x - 0.42, 7.6, z - 0.25}, {x + 0.42, 12.7, z + 0.25});
    if (i == p.bays) break;
    arch(b, x + 0.42, p.column(i + 1) - 0.42, z, 0.25, 2.7, 4.9);
    arch(b, x + 0.42, p.column(i + 1) - 0.42, z, 0.25, 7.6, 12.7);
    window(b, x + p.bay() / 2, z, 0.25, 10.3, 12.2, 1.0);
  }
}

void add_side(WorldBuilder& b, const Plan& p, double sign) {
  const double wall_z = sign * kAisleWall;
  b.node(sign > 0 ? "north side" : "south side");
  wall(b, Mat::kWall, kTower, wall_z, p.length, wall_z, 0, kEaves, 0.6);
  for (int32_t i = 0; i <= p.bays; ++i) {
    const double x = p.column(i);
    const double out = sign * (kAisleWall + 0.3);
    box(b, Mat::kStone, {x - 0.3, 0, std::min(out, out + sign * 0.9)},
        {x + 0.3, 7.5, std::max(out, out + sign * 0.9)}, kNoBottom);
    if (i == p.bays) break;
    window(b, x + p.bay() / 2, wall_z, 0.3, 1.5, 4.2, 1.2);
    window(b, x + p.bay() / 2, wall_z, 0.3, 6.2, 8.9, 1.2);
  }
  add_arcade(b, p, sign * kArcade);
  // The side gallery over the aisle.
  const double in = sign * (kArcade - 0.25);
  const double out = sign * (kAisleWall - 0.3);
  box(b, Mat::kWood, {kTower, kGallery - 0.3, std::min(in, out)},
      {p.chancel() + 0.42, kGallery, std::max(in, out)});
  for (int32_t i = 0; i < p.bays; ++i) {
    if (p.column(i + 1) < kTower + 3) continue;
    const double from = std::max(p.column(i) + 0.42, kTower + 3);
    balustrade(b, from, sign * kArcade, p.column(i + 1) - 0.42, sign * kArcade, kGallery);
  }
  balustrade(b, p.chancel() + 0.34, sign * (kArcade + 0.25), p.chancel() + 0.34, out, kGallery);
}

void add_tower(WorldBuilder& b, double sign, double top_of_stairs) {
  b.node(sign > 0 ? "north tower" : "south tower");
  const double top = sign > 0 ? kPlatform + 1.1 : kPlatform - 0.4;
  const double inner = sign * (kTowerIn + 0.175);
  const double outer = sign * (kTowerOut - 0.175);
  const double low = std::min(inner, outer) - 0.175;
  const double high = std::max(inner, outer) + 0.175;
  std::vector<Opening> doors;
  for (const double floor : {0.0, kGallery, kLoft}) {
    doors.push_back({1.9, 3.1, floor, floor + 2.1});
  }
  // The wall to the nave has a door at every floor: three storeys of wall, each with one opening.
  const std::array<double, 4> storey{0, kGallery - 0.3, kLoft - 0.3, top};
  for (size_t i = 0; i < 3; ++i) {
    const std::array<Opening, 1> door{
        {{doors[i].from, doors[i].to, doors[i].low - storey[i], doors[i].high - storey[i]}}};
    wall(b, Mat::kStone, 0, inner, kTower, inner, storey[i], storey[i + 1], 0.35, door);
  }
  wall(b, Mat::kStone, 0, outer, kTower, outer, 0, top, 0.35);
  wall(b, Mat::kStone, 0.175, low + 0.35, 0.175, high - 0.35, 0, top, 0.35);
  wall(b, Mat::kStone, kTower - 0.175, low + 0.35, kTower - 0.175, high - 0.35, 0, top, 0.35);
  for (const double sill : {2.5, 7.5, 12.0}) {
    window(b, kTowerMiddleX, outer, 0.175, sill, sill + 1.8, 0.5);
  }

  b.node(sign > 0 ? "north spiral" : "south spiral");
  const double z = sign * kTowerMiddleZ;
  cylinder(b, Mat::kStone, {kTowerMiddleX, 0, z}, {kTowerMiddleX, top_of_stairs + 1.0, z}, 0.2, 12,
           true);
  double from = 0;
  for (const double to : {kGallery, kLoft, kPlatform}) {
    if (to > top_of_stairs) break;
    // One turn and three quarters: it ends where it began, less the quarter that is the landing.
    spiral(b, Mat::kStairs,
           {.x = kTowerMiddleX,
            .y = from,
            .z = z,
            .inner = 0.15,
            .outer = kSpiral,
            .from = sign * 0.875,
            .turn = sign * 1.75,
            .height = to - from,
            .risers = 30});
    sector(b, Mat::kFloor, kTowerMiddleX, z, 0.1, kSpiral, sign * 0.625, sign * 0.25, to - 0.15,
           to);
    const double edge = sign * (kTowerMiddleZ - 1.36);
    const double door = sign * (to < kPlatform ? kTowerIn : kTowerIn + 0.35);
    box(b, Mat::kFloor, {kTowerMiddleX - 1.36, to - 0.15, std::min(edge, door)},
        {kTowerMiddleX + 1.36, to, std::max(edge, door)});
    from = to;
  }
  if (sign > 0) {  // The platform: a gangway all around the opening, with pinnacles at the corners.
    const Rect inside{0.35, kTowerIn + 0.35, kTower - 0.35, kTowerOut - 0.35};
    const double r = 1.36;
    const std::array<Rect, 2> holes{
        {{kTowerMiddleX - r, z - r, kTowerMiddleX + r, z + r},
         {kTowerMiddleX - r, kTowerIn + 0.35, kTowerMiddleX + r, z - r}}};
    slab(b, Mat::kFloor, Mat::kStone, inside, holes, kPlatform - 0.15, kPlatform);
    railing(b, {kTowerMiddleX - r, kPlatform, z + r}, {kTowerMiddleX + r, kPlatform, z + r}, 0.9);
    for (const double x : {0.175, kTower - 0.175}) {
      for (const double pz : {inner, outer}) {
        box(b, Mat::kStone, {x - 0.25, top, pz - 0.25}, {x + 0.25, top + 0.25, pz + 0.25},
            kNoBottom);
        frustum(b, Mat::kRoof, {x, top + 0.25, pz}, 0.24, 0, kHeight - top - 0.25, 4, false);
      }
    }
  } else {
    const std::array<Vec3d, 8> spire{{{-0.2, top, low - 0.2},
                                      {-0.2, top, high + 0.2},
                                      {kTower + 0.2, top, high + 0.2},
                                      {kTower + 0.2, top, low - 0.2},
                                      {kTowerMiddleX, 17.0, z},
                                      {kTowerMiddleX, 17.0, z},
                                      {kTowerMiddleX, 17.0, z},
                                      {kTowerMiddleX, 17.0, z}}};
    hexahedron(b, Mat::kRoof, spire);
    box(b, Mat::kSteel, {kTowerMiddleX - 0.05, 16.9, z - 0.05},
        {kTowerMiddleX + 0.05, kHeight, z + 0.05}, kNoBottom);
  }
}

void add_roof(WorldBuilder& b, const Plan& p) {
  b.node("roof");
  const auto slope = [&](double x0, double x1, double z0,
                         double z1) {  // z0 is nearer to the ridge.
    const double low = roof_at(z1);
    const double high = roof_at(z0);
    const bool north = z1 > z0;
    const double a = north ? z0 : z1;
    const double c = north ? z1 : z0;
    const double ya = north ? high : low;
    const double yc = north ? low : high;
    hexahedron(b, Mat::kRoof,
               {{{x0, ya, a},
                 {x0, yc, c},
                 {x1, yc, c},
                 {x1, ya, a},
                 {x0, ya + 0.25, a},
                 {x0, yc + 0.25, c},
                 {x1, yc + 0.25, c},
                 {x1, ya + 0.25, a}}});
  };
  for (const double sign : {-1.0, 1.0}) {
    slope(-0.2, kTower, 0, sign * kTowerIn);
    slope(kTower, p.length + 0.4, 0, sign * (kAisleWall + 0.7));
  }
  // Gables, up to the underside of the roof.
  const auto gable = [&](double x0, double x1, double half) {
    const double foot = roof_at(half);
    hexahedron(b, Mat::kWall,
               {{{x0, foot, -half},
                 {x0, foot, half},
                 {x1, foot, half},
                 {x1, foot, -half},
                 {x0, kRidge, 0},
                 {x0, kRidge, 0},
                 {x1, kRidge, 0},
                 {x1, kRidge, 0}}});
  };
  gable(0, 0.6, kTowerIn);
  gable(p.length - 0.3, p.length + 0.3, kAisleWall);
}

void add_front_and_galleries(WorldBuilder& b, const Plan& p) {
  b.node("west front");
  const std::array<Opening, 1> portal{{{kTowerIn - 1.3, kTowerIn + 1.3, 0, 3.4}}};
  wall(b, Mat::kStone, 0.3, -kTowerIn, 0.3, kTowerIn, 0, roof_at(kTowerIn), 0.6, portal);
  rose_window(b, -0.01, 0.61, 8.2);
  b.node("galleries");
  const double reach = kArcade - 0.25;
  const double front = kTower + 3;
  box(b, Mat::kWood, {0.6, kGallery - 0.3, -kTowerIn}, {kTower, kGallery, kTowerIn});
  box(b, Mat::kWood, {kTower, kGallery - 0.3, -reach}, {front, kGallery, reach});
  balustrade(b, front - 0.08, -reach - 0.1, front - 0.08, reach + 0.1, kGallery);
  for (const double z : {-1.6, 1.6}) column(b, front - 0.5, z, 0, kGallery - 0.3);
  const double loft = kTower + 1.5;
  box(b, Mat::kWood, {0.6, kLoft - 0.3, -kTowerIn}, {loft, kLoft, kTowerIn});
  balustrade(b, loft - 0.08, -kTowerIn, loft - 0.08, kTowerIn, kLoft);
  box(b, Mat::kWood, {0.7, kLoft, -1.6}, {1.3, kLoft + 2.6, 1.6}, kNoBottom);  // The organ.
  for (int32_t i = 0; i < 9; ++i) {
    const double z = -1.4 + 0.35 * i;
    cylinder(b, Mat::kPipe, {1.4, kLoft, z}, {1.4, kLoft + 3.2 - 0.2 * std::abs(i - 4), z}, 0.12, 8,
             true);
  }
  b.node("east wall");
  wall(b, Mat::kWall, p.length, -kTowerOut, p.length, kTowerOut, 0, kEaves, 0.6);
  rose_window(b, p.length - 0.31, p.length + 0.31, 7.2);
}

void add_floor_and_furniture(WorldBuilder& b, const Plan& p, uint64_t seed) {
  b.node("ground");
  const std::array<Rect, 1> inside{{{0, -kTowerOut, p.length, kTowerOut}}};
  floor_with_holes(b, Mat::kPavement, {-9, -15, p.length + 6, 15}, inside, 0);
  floor_rect(b, Mat::kFloor, inside[0], 0);
  for (uint64_t i = 0; i < 8; ++i) {
    const double x = kTower + 4 + static_cast<double>(i / 2) * (p.length - kTower) / 4;
    tree(b, {x, 0, i % 2 == 0 ? 13.2 : -13.2}, random_u64(seed, 7, i));
  }
  b.node("chancel");
  const double end = p.length - 0.3;
  const double side = kAisleWall - 0.3;
  box(b, Mat::kStairs, {p.chancel() + 0.6, 0, -side}, {end, 0.17, side}, kNoBottom);
  box(b, Mat::kFloor, {p.chancel() + 1, 0.17, -side}, {end, 0.34, side}, kNoBottom);
  box(b, Mat::kStone, {p.length - 3.4, 0.34, -1.3}, {p.length - 2.4, 1.35, 1.3}, kNoBottom);
  b.node("benches");
  for (double x = kTower + 4.5; x < p.chancel() - 2.5; x += 1.3) {
    for (const double sign : {-1.0, 1.0}) {
      // Some rows are shorter, for the prams.
      const double from = random_below(seed, 11, static_cast<uint64_t>(x * 10), 6) == 0 ? 1.8 : 1.0;
      const double low = std::min(sign * from, sign * 3.7);
      const double high = std::max(sign * from, sign * 3.7);
      box(b, Mat::kWood, {x, 0.40, low}, {x + 0.42, 0.46, high});
      box(b, Mat::kWood, {x - 0.06, 0, low}, {x, 0.95, high}, kNoBottom);
      for (const double z : {low, high - 0.05}) {
        box(b, Mat::kWood, {x, 0, z}, {x + 0.42, 0.40, z + 0.05}, kSides);
      }
    }
  }
}

}  // namespace

void build_church(WorldBuilder& b, const BuiltinWorldConfig& config) {
  Plan p;
  p.length = config.size;
  p.bays = std::max(2, static_cast<int32_t>((p.chancel() - kTower) / 4.83 + 0.5));
  add_floor_and_furniture(b, p, config.seed);
  add_front_and_galleries(b, p);
  for (const double sign : {-1.0, 1.0}) add_side(b, p, sign);
  add_tower(b, 1, kPlatform);
  add_tower(b, -1, kLoft);
  add_roof(b, p);
}

}  // namespace throng::importer::builtin
