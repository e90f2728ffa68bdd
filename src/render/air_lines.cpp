// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/air_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/access.h"
#include "path/air/flight_finder.h"
#include "throng/path.h"
#include "world/air_data.h"
#include "world/zone_data.h"

// The free air boxes of the octree, as they are stored for all classes together. Two are linked
// where they share a part of a face. Of the neighbours at a face only the one behind its middle is
// drawn, from the smaller box to the larger, so every line is drawn once. Source: [PACS00] 1.2.3.7.
namespace throng::render {
namespace {

constexpr std::array<std::array<int32_t, 3>, 6> kFaces = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

class LineFinder {
 public:
  LineFinder(const world::WorldData& world, const Box3d& area)
      : world_(world), air_(*world.air), area_(area) {}

  // The free air box that holds a cell of the world, cut to the layers that may be flown in.
  [[nodiscard]] std::optional<world::AirCube> cube_at(int32_t x, int32_t y, int32_t z) const {
    if (x < 0 || z < 0 || x >= air_.width || z >= air_.depth || y < air_.shape.floor ||
        y >= air_.shape.ceiling) {
      return {};
    }
    const int32_t zone_x = x / air_.zone_side, zone_z = z / air_.zone_side;
    const world::AirData::ZoneAir zone = air_.zone(zone_x, zone_z);
    if (!zone.usable || zone.tree == nullptr) return {};
    const world::AirTree::Place place =
        zone.tree->find(x - zone_x * air_.zone_side, y, z - zone_z * air_.zone_side);
    if (world::air_kind(place.word) != world::AirKind::kFree) return {};
    return world::AirCube{place.cube.x + zone_x * air_.zone_side, place.cube.y,
                          place.cube.z + zone_z * air_.zone_side, place.cube.side};
  }

  [[nodiscard]] Vec3d middle(const world::AirCube& cube) const {
    const double low = std::max(cube.y, air_.shape.floor);
    const double high = std::min(cube.y + cube.side, air_.shape.ceiling);
    return metres(cube.x + cube.side * 0.5, (low + high) / 2, cube.z + cube.side * 0.5);
  }

  [[nodiscard]] Vec3d metres(double x, double y, double z) const {
    const double cell = air_.shape.cell * 1e-3;
    return {world_.summary.origin.x + x * cell, (y * air_.shape.cell + air_.shape.origin_y) * 1e-3,
            world_.summary.origin.z + z * cell};
  }

  [[nodiscard]] bool is_wanted(Vec3d p) const {
    return area_.max.x <= area_.min.x ||
           (p.x >= area_.min.x && p.x <= area_.max.x && p.z >= area_.min.z && p.z <= area_.max.z);
  }

  void add_links(const world::AirCube& cube, std::vector<AirLine>& lines) const {
    const Vec3d here = middle(cube);
    for (const auto& face : kFaces) {
      const auto beyond = [&](int32_t at, int32_t direction) {
        return direction == 0 ? at + cube.side / 2 : direction > 0 ? at + cube.side : at - 1;
      };
      const auto next =
          cube_at(beyond(cube.x, face[0]), beyond(cube.y, face[1]), beyond(cube.z, face[2]));
      if (!next || next->side < cube.side) continue;
      const bool forward = face[0] + face[1] + face[2] > 0;
      if (next->side == cube.side && !forward) continue;
      lines.push_back({here, middle(*next)});
    }
  }

  // To the best ground under an air box that has no air below it.
  void add_ground(const world::AirCube& cube, const path::FlightFinder& flight,
                  std::vector<AirLine>& lines) const {
    const int32_t x = cube.x + cube.side / 2, z = cube.z + cube.side / 2;
    if (cube_at(x, cube.y - 1, z)) return;
    const int32_t high = std::min(cube.y + cube.side, air_.shape.ceiling);
    for (int32_t y = std::max(cube.y, air_.shape.floor); y < high; ++y) {
      const Vec3d feet = metres(x + 0.5, y + 0.5, z + 0.5);
      if (!flight.is_legal(feet)) continue;
      if (const Place ground = flight.landing(feet)) {
        lines.push_back({middle(cube), ground.position, true});
      }
      return;
    }
  }

  template <class Visit>
  void for_cubes(Visit visit) const {
    for (const auto& slot : air_.slots) {
      const int32_t x = slot->entry.x(), z = slot->entry.z();
      const world::AirData::ZoneAir zone = air_.zone(x, z);
      if (!zone.usable || zone.tree == nullptr) continue;
      zone.tree->for_each([&](const world::AirCube& cube, uint32_t word) {
        if (world::air_kind(word) != world::AirKind::kFree || cube.y >= air_.shape.ceiling ||
            cube.y + cube.side <= air_.shape.floor) {
          return;
        }
        const world::AirCube found{cube.x + x * air_.zone_side, cube.y, cube.z + z * air_.zone_side,
                                   cube.side};
        if (is_wanted(middle(found))) visit(found);
      });
    }
  }

 private:
  const world::WorldData& world_;
  const world::AirData& air_;
  const Box3d& area_;
};

}  // namespace

Result<std::vector<AirLine>> air_lines(const World& world, const Box3d& area) {
  if (data_of(world) != nullptr) {
    if (auto ok = world::check_air_index(*data_of(world)); !ok) return ok.error();
  }
  if (data_of(world) == nullptr || data_of(world)->air == nullptr) {
    return Error{Errc::kNotFound,
                 "picture: the world was baked without air; bake it with --fly or with --air"};
  }
  if (auto ok = world.check_all(); !ok) return ok.error();
  const std::vector<AvatarClass> classes = world.summary().classes;
  std::optional<path::FlightFinder> flight;
  for (size_t c = 0; c < classes.size() && !flight; ++c) {
    if (!classes[c].flies) continue;
    Context context;
    auto made =
        path::FlightFinder::create(world, {.avatar_class = static_cast<int32_t>(c)}, context);
    if (!made) return made.error();
    flight = *std::move(made);
  }
  const LineFinder finder(*data_of(world), area);
  std::vector<AirLine> lines;
  finder.for_cubes([&](const world::AirCube& cube) {
    finder.add_links(cube, lines);
    if (flight) finder.add_ground(cube, *flight, lines);
  });
  return lines;
}

}  // namespace throng::render
