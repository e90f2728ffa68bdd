// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/flight_endpoints.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "world/place.h"
#include "world/tile_grid.h"

// Where bodies take off and land, and the flood fills that search for such places. Linear in the
// cells visited.
namespace throng::path {
namespace {

// Cells around in which everything is legal, as the bake has stored it: 0 to 7. [legal cell]
int32_t margin_at(const world::GroundLevel& level, uint32_t zone_level, int32_t avatar_class,
                  int32_t x, int32_t z) {
  const format::Clearance& clearance =
      level.zone->clearance(zone_level, static_cast<uint32_t>(avatar_class));
  if (clearance.kind() != format::CellsKind::Blocks) return 7;
  const uint64_t* words = level.zone->words(clearance.offset());
  int32_t margin = 0;
  for (int32_t bit = 0; bit < 3; ++bit) {
    words += world::bit_words(words);
    if (world::bit_at(words, x, z)) margin |= 1 << bit;
  }
  return margin;
}

// Layers from that of the feet on in which there is room for the whole width of a body.
int32_t free_layers(const world::AirData& air, const world::AirBody& body, int32_t x, int32_t y,
                    int32_t z) {
  for (int32_t dy = 0; dy <= body.up; ++dy) {
    for (int32_t dz = -body.reach; dz <= body.reach; ++dz) {
      const int32_t half = body.half_width[static_cast<size_t>(std::abs(dz))];
      for (int32_t dx = -half; dx <= half; ++dx) {
        if (!air.is_free(x + dx, y + dy, z + dz)) return dy;
      }
    }
  }
  return body.up + 1;
}

}  // namespace

FoundBlocker air_blocker(const world::AirData& air, const world::AirBody& body, const AirView& view,
                         AirPoint from, AirPoint to) {
  constexpr double kStep = 0.25;  // [voxels]
  const AirPoint delta = to - from;
  const double far = air_distance(from, to);
  for (double at = 0; at < far; at += kStep) {
    const AirPoint p = from + (at / far) * delta;
    if (view.box_at(p) != kNoBox) continue;
    const uint32_t box = view.space().box_at(p);
    if (box != kNoBox) return {Blocker::kObstacle, view.changes()->obstacle_at(box, p)};
    const int32_t layers =
        free_layers(air, body, static_cast<int32_t>(std::floor(p.x)),
                    static_cast<int32_t>(std::floor(p.y)), static_cast<int32_t>(std::floor(p.z)));
    return {layers > 0 ? Blocker::kLow : Blocker::kNarrow, 0};
  }
  return {};
}

FlightEndpoints::FlightEndpoints(const world::WorldData& world, const AirView& air,
                                 int32_t avatar_class)
    : world_(world),
      air_(air),
      ground_{world, avatar_class},
      avatar_(world.summary.classes[static_cast<size_t>(avatar_class)]),
      cell_(air.space().shape.cell * 1e-3) {}

AirPoint FlightEndpoints::to_air(Vec3d p) const {
  return {(p.x - world_.summary.origin.x) / cell_,
          (p.y * 1000 - air_.space().shape.origin_y) / air_.space().shape.cell,
          (p.z - world_.summary.origin.z) / cell_};
}

Vec3d FlightEndpoints::to_metres(AirPoint p) const {
  return {world_.summary.origin.x + p.x * cell_,
          (p.y * air_.space().shape.cell + air_.space().shape.origin_y) * 1e-3,
          world_.summary.origin.z + p.z * cell_};
}

std::optional<AirPoint> FlightEndpoints::in_air(Vec3d feet) const {
  if (!std::isfinite(feet.x + feet.y + feet.z)) return {};
  const AirPoint p = to_air(feet);
  if (air_.box_at(p) == kNoBox) return {};
  return off_faces(p);
}

std::optional<AirPoint> FlightEndpoints::take_off(const Place& place) const {
  if (!place || !std::isfinite(place.position.x + place.position.y + place.position.z)) return {};
  if (!may_stand(place)) return {};
  const AirPoint feet = to_air(place.position);
  const double head = feet.y + avatar_.height / cell_;
  const AirPoint column{off_faces(feet.x), 0, off_faces(feet.z)};
  const auto up = world::take_off_height(feet.y, head, [&](double y) {
    return air_.box_at(AirPoint{column.x, y + 0.5, column.z}) != kNoBox;
  });
  if (!up) return {};
  return AirPoint{column.x, *up, column.z};
}

bool FlightEndpoints::may_stand(const Place& place) const {
  if (air_.changes() == nullptr) return true;
  const auto at = world::ground_point(world_, place);
  return at && air_.changes()->may_stand(place.level1 - 1, at->cell_x(), at->cell_z());
}

template <class Visit>
bool FlightEndpoints::for_places(const Place& from, uint64_t max_cells, CircleFlood& flood,
                                 FloodPart& part, Visit visit) const {
  part.is_done = true;
  const auto start = world::ground_point(world_, from);
  if (!start) return false;
  const world::GroundLevel level =
      world::ground_level(world_, from.level1 - 1, ground_.avatar_class);
  if (!level.is_legal(world::in_tile(start->cell_x()), world::in_tile(start->cell_z())))
    return false;
  const AirChanges* changes = air_.changes();
  bool more = true, budget_exhausted = false;
  if (part.visited == 0) flood.start(level, start->cell_x(), start->cell_z());
  part.is_done = flood.advance(
      ground_, world::step_mm(avatar_), part.left,
      [&](int32_t, int32_t) {
        budget_exhausted = more && part.visited == max_cells;
        return more && !budget_exhausted;
      },
      [&](const CircleFlood::Cell& cell) {
        ++part.visited;
        more = visit(
            world::place_at(world_, cell.level,
                            {(int64_t{cell.x} << world::kUnitBits) + world::kUnitsPerCell / 2,
                             (int64_t{cell.z} << world::kUnitBits) + world::kUnitsPerCell / 2}));
      },
      [](const CircleFlood::Cell&, int32_t, int32_t) {},
      [&](const world::GroundLevel& to, int32_t x, int32_t z) {
        return changes == nullptr || changes->may_stand(to.world_level, x, z);
      });
  return budget_exhausted;
}

template <class Visit>
bool FlightEndpoints::for_take_offs(const Place& from, uint64_t max_cells, CircleFlood& flood,
                                    FloodPart& part, Visit visit) const {
  return for_places(from, max_cells, flood, part, [&](const Place& place) {
    const auto up = take_off(place);
    return !up || visit(place, air_.component(air_.box_at(*up)));
  });
}

Place FlightEndpoints::nearest_place(const Place& from, uint64_t max_cells, Vec3d goal,
                                     CircleFlood& flood) const {
  Place nearest;
  double least = HUGE_VAL;
  FloodPart all;
  const bool budget_exhausted = for_places(from, max_cells, flood, all, [&](const Place& place) {
    const double far = length(place.position - goal);
    if (far < least) {
      least = far;
      nearest = place;
    }
    return true;
  });
  return budget_exhausted ? Place{} : nearest;
}

FlightEndpoints::TakeOff FlightEndpoints::nearest_take_off(const Place& from, uint64_t max_cells,
                                                           uint32_t component, CircleFlood& flood,
                                                           FloodPart& part) const {
  Place found;
  const bool budget_exhausted =
      for_take_offs(from, max_cells, flood, part, [&](const Place& place, uint32_t leads_to) {
        if (component == kNoBox || leads_to == component) found = place;
        return !found;
      });
  return {found, budget_exhausted};
}

bool FlightEndpoints::components_over(const Place& from, uint64_t max_cells, CircleFlood& flood,
                                      std::vector<uint32_t>& components) const {
  components.clear();
  FloodPart all;
  return for_take_offs(from, max_cells, flood, all, [&](const Place&, uint32_t leads_to) {
    if (std::find(components.begin(), components.end(), leads_to) == components.end()) {
      components.push_back(leads_to);
    }
    return true;
  });
}

uint32_t FlightEndpoints::lowest_box(AirPoint p) const {
  uint32_t box = air_.box_at(p);
  while (box != kNoBox) {
    const world::AirCube& cube = air_.cube(box);
    const uint32_t below = air_.box_at(static_cast<int32_t>(std::floor(p.x)), cube.y - 1,
                                       static_cast<int32_t>(std::floor(p.z)));
    if (below == kNoBox) return box;
    box = below;
  }
  return kNoBox;
}

// Most accessible first, most aligned with the box's axis next. Source: [PACS00] 1.2.3.7.
Place FlightEndpoints::best_landing(uint32_t box) const {
  const world::AirCube& cube = air_.cube(box);
  const int32_t multiple = air_.space().shape.multiple;
  Place best;
  int32_t best_margin = -1;
  double best_off = 0;
  const double bottom = to_metres({0, static_cast<double>(cube.y), 0}).y;
  struct Floor {
    uint32_t zone_level;
    world::GroundLevel ground;
  };
  std::vector<Floor> floors;  // of a tile
  const int32_t end_x = std::min((cube.x + cube.side) * multiple, world_.width);
  const int32_t end_z = std::min((cube.z + cube.side) * multiple, world_.depth);
  const auto try_cell = [&](const Floor& floor, int32_t x, int32_t z) {
    if (!floor.ground.is_legal(world::in_tile(x), world::in_tile(z))) return;
    const int32_t margin = margin_at(floor.ground, floor.zone_level, ground_.avatar_class,
                                     world::in_tile(x), world::in_tile(z));
    const double dx = (x + 0.5) / multiple - (cube.x + cube.side * 0.5);
    const double dz = (z + 0.5) / multiple - (cube.z + cube.side * 0.5);
    const double off = dx * dx + dz * dz;
    if (margin < best_margin || (margin == best_margin && off >= best_off)) return;
    const Place place =
        world::place_at(world_, floor.ground,
                        {(int64_t{x} << world::kUnitBits) + world::kUnitsPerCell / 2,
                         (int64_t{z} << world::kUnitBits) + world::kUnitsPerCell / 2});
    if (place.position.y > bottom) return;
    const auto up = take_off(place);
    if (!up || air_.box_at(*up) != box) return;
    best = place;
    best_margin = margin;
    best_off = off;
  };
  for (int32_t z = cube.z * multiple; z < end_z; ++z) {
    for (int32_t x = cube.x * multiple; x < end_x;) {
      const auto tile = world_.tile_levels(world::tile_along(x), world::tile_along(z));
      floors.clear();
      for (uint32_t i = tile.first; i < tile.last; ++i) {
        const uint32_t zone_level = tile.zone_first + i - tile.first;
        floors.push_back(
            {zone_level, world::ground_level(*tile.zone, zone_level, i, ground_.avatar_class)});
      }
      for (const int32_t tile_end = std::min(world::tile_last(x) + 1, end_x); x < tile_end; ++x) {
        for (const Floor& floor : floors) try_cell(floor, x, z);
      }
    }
  }
  return best;
}

}  // namespace throng::path
