// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/access.h"
#include "path/air/air_string.h"
#include "path/air/air_view.h"
#include "path/air/flight_endpoints.h"
#include "path/air/flight_finder.h"
#include "path/air/flight_log.h"
#include "path/air/flight_path.h"
#include "path/air/flight_search.h"
#include "path/air/ground_air_links.h"
#include "path/air/linked_landing.h"
#include "path/edits/ground_finder.h"
#include "path/edits/solid.h"
#include "path/ground/mesh.h"
#include "path/overlay/mesh_finder.h"
#include "world/place.h"

/// What a FlightFinder holds: what all copies share, and the memory of one.
namespace throng::path {

inline constexpr uint64_t kMaxFloodCells = 1 << 18;  // on foot to a take-off
inline constexpr uint64_t kFloodCells = 2;           // take the time of a node
// The same where the nearest take-off leads into an island and there are several others.
inline constexpr uint64_t kMaxIslandCells = 1 << 15;
// Paths over other ground, or to what is less near, where obstacles block the first.
inline constexpr int32_t kMaxTries = 4;

// A point of the air, or a place with the nearest place to take off or to land.
struct FlightFinder::End {
  std::optional<AirPoint> air;
  Place ground, ground_air_link;
};

struct FlightFinder::Shared {
  World world;
  int32_t avatar_class = 0;
  world::AirBody body;
  FlightSpace space;
  std::vector<uint64_t> cells_before;  // per box, and of all
  std::optional<MeshFinder> walker;    // none where the class has no ground
  GroundAirLinks ground_air_links;
  AirLinks links;  // that the bake has stored; empty: none
  PathSummary summary;

  [[nodiscard]] FlightEndpoints ends(const AirView& air) const {
    return {*data_of(world), air, avatar_class};
  }
  // Where a stored link leads down from a point; nowhere if none can be used.
  [[nodiscard]] Place linked_from(const AirView& air, AirPoint at) const {
    return linked_landing(links, ends(air), air, avatar_class, at);
  }
  // The component of the ground at a place.
  [[nodiscard]] uint32_t ground_of(const Place& place) const {
    const auto at = world::ground_point(*data_of(world), place);
    if (!walker || !at) return kNoRect;
    const PathMesh& mesh = walker->mesh();
    const uint32_t rect = mesh.rect_at(place.level1 - 1, at->cell_x(), at->cell_z());
    return rect == kNoRect ? kNoRect : mesh.rects[rect].component;
  }
  [[nodiscard]] GroundAirLinks::Part part_of(const End& end) const {
    if (end.air) return {space.component[space.box_at(*end.air)], true};
    return {ground_of(end.ground), false};
  }
  // The middle of a cell.
  [[nodiscard]] Place place_of(const GroundAirLinks::Cell& cell) const {
    return world::place_at(*data_of(world),
                           world::ground_level(*data_of(world), cell.level, avatar_class),
                           {(int64_t{cell.x} << world::kUnitBits) + world::kUnitsPerCell / 2,
                            (int64_t{cell.z} << world::kUnitBits) + world::kUnitsPerCell / 2});
  }
  [[nodiscard]] Place nearest_ground(uint32_t component, Vec3d at) const {
    Place nearest;
    double least = std::numeric_limits<double>::infinity();
    if (!walker) return nearest;
    const world::GroundPoint to = world::to_ground(*data_of(world), at.x, at.z);
    for (const MeshRect& rect : walker->mesh().rects) {
      if (rect.component != component) continue;
      const Place place =
          place_of({rect.level, std::clamp(to.cell_x(), rect.x, rect.x + rect.width - 1),
                    std::clamp(to.cell_z(), rect.z, rect.z + rect.depth - 1)});
      const double far = distance(place.position, at);
      if (far >= least) continue;
      least = far;
      nearest = place;
    }
    return nearest;
  }
};

struct FlightFinder::Scratch {
  explicit Scratch(const Shared& shared) : walker(shared.walker) {}

  [[nodiscard]] bool is_changed() const { return changes && changes->any(); }
  [[nodiscard]] AirView air(const Shared& shared) const {
    return {shared.space, is_changed() ? &*changes : nullptr};
  }
  AirChanges& changes_of(const Shared& shared) {
    if (!changes) changes.emplace(*data_of(shared.world), shared.space, shared.avatar_class);
    return *changes;
  }
  ChangeId add(const Shared& shared, Solid solid) {
    if (live) live_ids.push_back(live->add_obstacle(solid));
    return changes_of(shared).add(std::move(solid));
  }
  // The ground with all changes; made on the first walk.
  GroundFinder& ground(const Shared& shared) {
    if (!live) {
      auto made = GroundFinder::create(shared.world, {.avatar_class = shared.avatar_class});
      THRONG_ASSERT(made);  // The class was checked.
      changes->add_all_to(*made, live_ids);
      live = std::move(*made);
      live_began = live->version();
    }
    return *live;
  }

  // From the ground into the air: into this component of it, or any (kNoBox). False: none is found.
  bool find_link(const Shared& shared, const AirView& air, End& end, uint32_t component,
                 bool& budget_exhausted);
  // A component of the air over the ground at both ends: if there is more than one, the one that is
  // nearest to both, as far as a flood around them shows. kNoBox: none.
  uint32_t common_air(const Shared& shared, const AirView& air, const End& a, const End& b,
                      const SearchBudget& budget, bool& budget_exhausted);

  // These take from the log what the query has found before.
  // The place nearest to another, on foot, from where it can take off into a component of the air,
  // or into any (kNoBox).
  const FlightLog::Entry& nearest_take_off(const FlightEndpoints& ends, const Place& from,
                                           uint32_t component);
  const std::vector<uint32_t>& components_over(const FlightEndpoints& ends, const Place& from) {
    const auto make = [&](FlightLog::Entry& entry) {
      ends.components_over(from, kMaxIslandCells, flood, entry.components);
    };
    return log.next(make).components;
  }
  bool is_cancelled(const SearchBudget& budget) {
    const auto make = [&](FlightLog::Entry& entry) {
      entry.budget_exhausted = budget.cancel != nullptr && *budget.cancel;
    };
    return log.next(make).budget_exhausted;
  }
  // The flight from one point to another, pulled taut; if there is none, the point nearest to
  // `towards` that the search reached.
  const FlightLog::Entry& fly(const AirView& air, const FlightQuery& query, AirPoint from,
                              AirPoint to, AirPoint towards);

  FlightLog log;
  FlightQuery begun;
  uint64_t taken = 0;     // nodes, by the parts before
  uint64_t expanded = 0;  // by the searches that the part has come to, of all parts
  FlightSearch search;
  SpentBudget spent = SpentBudget::kNone;  // the budget that the last search exhausted
  bool is_flood_cut = false;               // a flood to a take-off had more than kMaxFloodCells
  AirString pull;
  CircleFlood flood;
  std::optional<MeshFinder> walker;
  std::vector<uint32_t> common;  // components of the air
  AirView::ZoneOrder zone_order;
  GroundAirLinks::Scratch parts;
  std::vector<GroundAirLinks::Part> route;
  std::vector<GroundAirLinks::Pair> banned;
  // Made with the first obstacle; none before.
  std::optional<AirChanges> changes;
  std::optional<GroundFinder> live;
  uint64_t live_began = 0;         // its version, with the changes of that time
  std::vector<ChangeId> live_ids;  // by id of a change - 1
  // Of a search that found no path between ends that could be connected: the point that it reached
  // in the air that is nearest to where the query leads.
  std::optional<AirPoint> reached;
};

}  // namespace throng::path
