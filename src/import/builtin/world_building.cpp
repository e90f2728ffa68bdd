// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/builtin/world_building.h"

#include "import/builtin/world_shapes.h"

// A house: a corridor along x on every storey, rooms in front and behind, a staircase behind the
// middle, the front door in the middle of the front. Outer walls are 0.25 m thick; floors and inner
// walls are single surfaces, as in most models of cities.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kWallThickness = 0.25;
constexpr double kFloor0 = 0.03;     // The ground floor's height over the pavement.
constexpr double kCorridor0 = -1.0;  // The corridor, in z.
constexpr double kCorridor1 = 1.2;
constexpr double kDoor = 1.1;
constexpr double kDoorHeight = 2.1;

Dogleg stairs(double y) {
  return {.x = 0,
          .y = y,
          .z = 0,
          .height = kBuildingStorey,
          .width = 1.3,
          .gap = 0.1,
          .run = 0.27,
          .landing = 1.4,
          .risers = 9};
}

Rect well() {
  const Dogleg d = stairs(0);
  return {-d.depth() / 2, kCorridor1, d.depth() / 2, kCorridor1 + d.length()};
}

double floor_height(int32_t storey) { return storey == 0 ? kFloor0 : storey * kBuildingStorey; }

void add_stairs(WorldBuilder& b, int32_t storey) {
  const Frame outer = b.frame();
  const Dogleg d = stairs(0);
  const double y = floor_height(storey);
  b.place({outer({d.depth() / 2, y, kCorridor1}), -outer.uz, outer.ux});  // Up along the house's z.
  Dogleg flight = d;
  flight.height = floor_height(storey + 1) - y;
  dogleg(b, Mat::kStairs, flight);
  b.place(outer);
}

// A single surface along x at `z` with doors around the given middles, in order.
void thin_wall_with_doors(WorldBuilder& b, double x0, double x1, double z, double y0, double y1,
                          std::span<const double> doors, double door_width) {
  double at = x0;
  for (const double middle : doors) {
    const double from = middle - door_width / 2;
    const double to = middle + door_width / 2;
    thin_wall(b, Mat::kWall, at, z, from, z, y0, y1);
    thin_wall(b, Mat::kWall, from, z, to, z, y0 + kDoorHeight, y1);
    at = to;
  }
  thin_wall(b, Mat::kWall, at, z, x1, z, y0, y1);
}

void add_rooms(WorldBuilder& b, const Building& h, int32_t storey) {
  const double x1 = h.width / 2 - kWallThickness;
  const double z1 = h.depth / 2 - kWallThickness;
  const double y0 = floor_height(storey);
  const double y1 = floor_height(storey + 1);
  const double third = h.width / 6;
  const std::array<double, 3> front{-2 * third, 0, 2 * third};
  thin_wall_with_doors(b, -x1, x1, kCorridor0, y0, y1, front, kDoor);
  // Behind: a door to the room on each side, and the stairs open in the middle.
  const Rect w = well();
  const std::array<double, 1> left{(-x1 + w.x0) / 2};
  const std::array<double, 1> right{(x1 + w.x1) / 2};
  thin_wall_with_doors(b, -x1, w.x0, kCorridor1, y0, y1, left, kDoor);
  thin_wall_with_doors(b, w.x1, x1, kCorridor1, y0, y1, right, kDoor);
  thin_wall(b, Mat::kWall, w.x0, kCorridor1, w.x0, z1, y0, y1);
  thin_wall(b, Mat::kWall, w.x1, kCorridor1, w.x1, z1, y0, y1);
  for (const double x : {-third, third}) thin_wall(b, Mat::kWall, x, -z1, x, kCorridor0, y0, y1);
}

// Four outer walls; the front has a door on the ground.
void add_shell(WorldBuilder& b, const Building& h, double top) {
  const double x1 = h.width / 2;
  const double z1 = h.depth / 2;
  box(b, Mat::kWall, {-x1, 0, z1 - kWallThickness}, {x1, top, z1}, kNoBottom);
  box(b, Mat::kWall, {-x1, 0, -z1 + kWallThickness},
      {-x1 + kWallThickness, top, z1 - kWallThickness}, kNoBottom);
  box(b, Mat::kWall, {x1 - kWallThickness, 0, -z1 + kWallThickness}, {x1, top, z1 - kWallThickness},
      kNoBottom);
  constexpr double kHalf = 0.8;
  box(b, Mat::kWall, {-x1, 0, -z1}, {-kHalf, top, -z1 + kWallThickness}, kNoBottom);
  box(b, Mat::kWall, {kHalf, 0, -z1}, {x1, top, -z1 + kWallThickness}, kNoBottom);
  box(b, Mat::kWall, {-kHalf, 2.3, -z1}, {kHalf, top, -z1 + kWallThickness});
}

// Panes a little outside of the walls. `bands`: one long pane a storey, for houses without an
// inside.
void add_windows(WorldBuilder& b, const Building& h) {
  const Frame outer = b.frame();
  const std::array<std::array<double, 4>, 4> sides{{{0, -h.depth / 2, 1, 0},
                                                    {0, h.depth / 2, -1, 0},
                                                    {-h.width / 2, 0, 0, -1},
                                                    {h.width / 2, 0, 0, 1}}};
  for (size_t s = 0; s < 4; ++s) {
    const auto& [x, z, lx, lz] = sides[s];
    const double run = s < 2 ? h.width : h.depth;
    b.place({outer({x, 0, z}), outer.ux * lx - outer.uz * lz, outer.ux * lz + outer.uz * lx});
    const auto count = h.interior ? static_cast<int32_t>(run / 4) : 1;
    const double pitch = run / count;
    const double wide = h.interior ? 1.7 : run - 2;
    for (int32_t storey = 0; storey < h.storeys; ++storey) {
      const double sill = floor_height(storey) + 0.95;
      for (int32_t i = 0; i < count; ++i) {
        const double at = -run / 2 + (i + 0.5) * pitch;
        if (s == 0 && storey == 0 && std::abs(at) < 1.9) continue;  // The front door.
        thin_wall(b, Mat::kGlass, at + wide / 2, -0.02, at - wide / 2, -0.02, sill, sill + 1.45);
      }
    }
  }
  b.place(outer);
}

void add_flat_roof(WorldBuilder& b, const Building& h, double y, std::span<const Rect> hole) {
  const double x1 = h.width / 2 - kWallThickness;
  const double z1 = h.depth / 2 - kWallThickness;
  floor_with_holes(b, Mat::kRoof, {-x1, -z1, x1, z1}, hole, y);
  if (hole.empty()) return;
  const Rect& w = hole[0];
  railing(b, {w.x0 - 0.05, y, w.z0}, {w.x0 - 0.05, y, w.z1});
  railing(b, {w.x1 + 0.05, y, w.z0}, {w.x1 + 0.05, y, w.z1});
  railing(b, {w.x0, y, w.z1 + 0.05}, {w.x1, y, w.z1 + 0.05});
}

// Ridge along x. It also closes the house above: the attic has a floor.
void add_gable_roof(WorldBuilder& b, const Building& h, double y) {
  const double x1 = h.width / 2;
  const double z1 = h.depth / 2 + 0.4;
  const double ridge = y + h.depth * 0.35;
  const std::array<Vec3d, 8> corners{{{-x1, y, -z1},
                                      {-x1, y, z1},
                                      {x1, y, z1},
                                      {x1, y, -z1},
                                      {-x1, ridge, 0},
                                      {-x1, ridge, 0},
                                      {x1, ridge, 0},
                                      {x1, ridge, 0}}};
  hexahedron(b, Mat::kRoof, corners, kLowZ | kHighZ | kLowY);
  hexahedron(b, Mat::kWall, corners, kLowX | kHighX);
}

}  // namespace

void add_building(WorldBuilder& b, const Building& h) {
  const double roof = h.storeys * kBuildingStorey;
  const double top = h.gable ? roof : roof + 0.95;
  const double x1 = h.width / 2;
  const double z1 = h.depth / 2;
  const std::array<Rect, 1> hole{well()};
  if (h.interior) {
    add_shell(b, h, top);
    floor_rect(b, Mat::kFloor,
               {-x1 + kWallThickness, -z1, x1 - kWallThickness, z1 - kWallThickness}, kFloor0);
    for (int32_t storey = 0; storey < h.storeys; ++storey) {
      if (storey > 0) {
        floor_with_holes(
            b, Mat::kFloor,
            {-x1 + kWallThickness, -z1 + kWallThickness, x1 - kWallThickness, z1 - kWallThickness},
            hole, floor_height(storey));
      }
      add_rooms(b, h, storey);
      if (storey + 1 < h.storeys || h.roof_access) add_stairs(b, storey);
    }
  } else {
    box(b, Mat::kWall, {-x1, 0, -z1}, {x1, roof, z1}, kSides);
  }
  add_windows(b, h);
  if (h.gable) {
    add_gable_roof(b, h, roof);
  } else if (h.interior) {
    add_flat_roof(b, h, roof,
                  h.roof_access ? std::span<const Rect>(hole) : std::span<const Rect>());
  } else {
    floor_rect(b, Mat::kRoof, {-x1, -z1, x1, z1}, roof);
  }
}

}  // namespace throng::importer::builtin
