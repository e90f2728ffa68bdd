// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <string>

#include "core/check_class.h"
#include "core/random.h"
#include "path/flight_ends.h"
#include "path/flight_ports.h"
#include "path/flight_pull.h"
#include "path/flight_search.h"
#include "path/mesh.h"
#include "path/reset_path.h"
#include "throng/flight.h"
#include "world/place.h"

namespace throng {
namespace {

constexpr int32_t kLargestBox = 32;            // air cells: larger ones hide good ways
constexpr uint64_t kMostFloodCells = 1 << 18;  // on foot to where one can take off
// The same where the nearest take-off leads into a pocket and there are several others.
constexpr uint64_t kMostPocketCells = 1 << 15;

double distance(Vec3d a, Vec3d b) {
  const Vec3d d = a - b;
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

}  // namespace

struct FlightFinder::Shared {
  World world;
  int32_t avatar_class = 0;
  FlightSpace space;
  std::vector<uint64_t> cells_before;  // per box, and of all
  std::optional<PathFinder> walker;    // none where the class has no ground
  FlightPorts ports;
  FlightSummary summary;

  [[nodiscard]] FlightEnds ends() const { return {*world.data(), space, avatar_class}; }
  // The component of the ground at a place.
  [[nodiscard]] uint32_t ground_of(const Place& place) const {
    const auto at = ground_point(*world.data(), place);
    if (!walker || !at) return kNoRect;
    const PathMesh& mesh = walker->mesh();
    const uint32_t rect = mesh.rect_at(place.level1 - 1, at->cell_x(), at->cell_z());
    return rect == kNoRect ? kNoRect : mesh.rects[rect].component;
  }
};

struct FlightFinder::Scratch {
  explicit Scratch(const Shared& shared) : walker(shared.walker) {}

  FlightSearch search;
  FlightPull pull;
  CircleFlood flood;
  std::optional<PathFinder> walker;
  std::vector<AirPoint> way;
  Path walk_there, walk_on, walk_all;
  std::vector<uint32_t> over_from, over_to, common;  // components of the air
};

FlightFinder::FlightFinder(std::shared_ptr<const Shared> shared)
    : shared_(std::move(shared)), scratch_(std::make_unique<Scratch>(*shared_)) {}
FlightFinder::FlightFinder(const FlightFinder& other) : FlightFinder(other.shared_) {}
FlightFinder& FlightFinder::operator=(const FlightFinder& other) {
  shared_ = other.shared_;
  scratch_ = std::make_unique<Scratch>(*shared_);
  return *this;
}
FlightFinder::FlightFinder(FlightFinder&&) noexcept = default;
FlightFinder& FlightFinder::operator=(FlightFinder&&) noexcept = default;
FlightFinder::~FlightFinder() = default;

Result<FlightFinder> FlightFinder::make(const World& world, const FlightConfig& config,
                                        Context& context) {
  if (world.data() == nullptr) return Error{Errc::kBadInput, "flight: the world is empty"};
  const WorldData& data = *world.data();
  if (data.air == nullptr) {
    return Error{Errc::kNotFound,
                 "flight: the world was baked without air; bake it with --air or with a class that "
                 "flies"};
  }
  if (auto ok = check_class(data.summary.classes, config.avatar_class, "flight"); !ok)
    return ok.error();
  if (config.workers < 0) return Error{Errc::kBadConfig, "flight: workers must be 0 or more"};
  const AvatarClass& avatar = data.summary.classes[static_cast<size_t>(config.avatar_class)];
  if (!avatar.flies) {
    return Error{Errc::kBadConfig, "flight: class " + avatar.name +
                                       " does not fly; say `flies = true` in the classes' file"};
  }
  const auto start = std::chrono::steady_clock::now();
  if (auto ok = world.check_all(); !ok) return ok.error();
  auto space = build_flight_space(*data.air, air_body(avatar, data.air->shape), kLargestBox,
                                  config.workers, context);
  if (!space) return space.error();
  auto shared = std::make_shared<Shared>();
  shared->world = world;
  shared->avatar_class = config.avatar_class;
  shared->space = std::move(*space);
  shared->cells_before.reserve(shared->space.boxes.size() + 1);
  shared->cells_before.push_back(0);
  for (const AirCube& box : shared->space.boxes) {
    const auto side = static_cast<uint64_t>(box.side);
    shared->cells_before.push_back(shared->cells_before.back() + side * side * side);
  }
  if (data.level_count > 0) {
    auto walker = PathFinder::make(
        world, {.avatar_class = config.avatar_class, .workers = config.workers}, context);
    if (!walker) return walker.error();
    shared->walker = std::move(*walker);
    shared->ports = FlightPorts(data, shared->walker->mesh(), shared->space, config.workers);
  }
  shared->summary.boxes = shared->space.boxes.size();
  shared->summary.bytes = shared->space.bytes() + shared->cells_before.size() * sizeof(uint64_t) +
                          shared->ports.bytes() +
                          (shared->walker ? shared->walker->summary().bytes : 0);
  shared->summary.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return FlightFinder(std::move(shared));
}

FlightSummary FlightFinder::summary() const { return shared_->summary; }
const FlightSpace& FlightFinder::space() const { return shared_->space; }

bool FlightFinder::is_legal(Vec3d feet) const { return shared_->ends().in_air(feet).has_value(); }

std::optional<Vec3d> FlightFinder::random_point(uint64_t seed, uint64_t n) const {
  const std::vector<uint64_t>& before = shared_->cells_before;
  if (before.back() == 0) return {};
  const uint64_t pick = random_below(seed, n, 0, before.back());
  const auto box = static_cast<size_t>(std::upper_bound(before.begin(), before.end(), pick) -
                                       before.begin() - 1);
  const AirCube& cube = shared_->space.boxes[box];
  const auto part = [&](uint64_t i) {
    return kAirSkin + random_unit(seed, n, i) * (cube.side - 2 * kAirSkin);
  };
  return shared_->ends().to_metres({cube.x + part(1), cube.y + part(2), cube.z + part(3)});
}

std::optional<Vec3d> FlightFinder::take_off(const Place& place) const {
  const FlightEnds ends = shared_->ends();
  const auto up = ends.take_off(place);
  if (!up) return {};
  return ends.to_metres(*up);
}

Place FlightFinder::landing(Vec3d feet) const {
  const FlightEnds ends = shared_->ends();
  const auto point = ends.in_air(feet);
  if (!point) return {};
  return ends.best_landing(ends.lowest_box(*point));
}

void FlightFinder::find(const FlightQuery& query, FlightPath& path) {
  const FlightEnds ends = shared_->ends();
  Scratch& scratch = *scratch_;
  path.end = PathEnd::kNoPlace;
  path.points.clear();
  path.legs.clear();
  path.length = 0;
  path.nodes = 0;

  // An end is a point of the air, or a place with the nearest place to take off or to land.
  struct End {
    std::optional<AirPoint> air;
    Place ground, port;
  };
  const auto locate = [&](Vec3d at, End& end) {
    end.air = ends.in_air(at);
    if (end.air) return true;
    end.ground = shared_->world.find_place(shared_->avatar_class, at, query.reach);
    return static_cast<bool>(end.ground);
  };
  bool gave_up = false;  // somewhere: then what was not found may be there all the same
  const FlightSpace& space = shared_->space;
  const auto component_of = [&](AirPoint p) { return space.component[space.box_at(p)]; };
  // From the ground into the air: into this component of it, or any (kNoBox).
  const auto to_port = [&](End& end, uint32_t component) {
    if (!end.ground) return end.air.has_value();
    end.port = end.ground;
    end.air = ends.take_off(end.port);
    if (end.air && (component == kNoBox || component_of(*end.air) == component)) return true;
    end.air.reset();
    const uint32_t ground = shared_->ground_of(end.ground);
    const bool leads = component == kNoBox ? !shared_->ports.air_over(ground).empty()
                                           : shared_->ports.joins(ground, component);
    if (!leads) return false;
    const auto nearest =
        ends.nearest_take_off(end.ground, kMostFloodCells, component, scratch.flood);
    gave_up = gave_up || nearest.gave_up;
    end.port = nearest.place;
    end.air = ends.take_off(end.port);
    return end.air.has_value();
  };
  // Air over the ground at both ends: the one that is nearest to both, as far as a look around
  // tells, where there is more than one.
  const auto common_air = [&](const End& a, const End& b) {
    const auto over_a = shared_->ports.air_over(shared_->ground_of(a.ground));
    const auto over_b = shared_->ports.air_over(shared_->ground_of(b.ground));
    scratch.common.clear();
    std::set_intersection(over_a.begin(), over_a.end(), over_b.begin(), over_b.end(),
                          std::back_inserter(scratch.common));
    if (scratch.common.size() < 2) return scratch.common.empty() ? kNoBox : scratch.common[0];
    for (const auto& [end, over] :
         {std::pair{&a, &scratch.over_from}, std::pair{&b, &scratch.over_to}}) {
      if (query.cancel != nullptr && *query.cancel) {
        gave_up = true;
        return kNoBox;
      }
      ends.components_over(end->ground, kMostPocketCells, scratch.flood, *over);
    }
    size_t least = SIZE_MAX;
    uint32_t best = scratch.common[0];
    for (size_t i = 0; i < scratch.over_from.size(); ++i) {
      const auto found =
          std::find(scratch.over_to.begin(), scratch.over_to.end(), scratch.over_from[i]);
      const size_t rank = i + static_cast<size_t>(found - scratch.over_to.begin());
      if (found == scratch.over_to.end() || rank >= least) continue;
      least = rank;
      best = scratch.over_from[i];
    }
    return best;
  };
  // The nearest ways into the air may lead into pockets of it, a room or a yard under a net: then
  // from one further off into air that leads to the other end.
  const auto to_ports = [&](End& a, End& b) {
    if (!a.ground && !b.ground) return true;
    if (!a.ground) return to_port(b, component_of(*a.air));
    if (!b.ground) return to_port(a, component_of(*b.air));
    if (!to_port(a, kNoBox) || !to_port(b, kNoBox)) return false;
    if (space.hold_together(*a.air, *b.air)) return true;
    const uint32_t common = common_air(a, b);
    return common != kNoBox && to_port(a, common) && to_port(b, common);
  };
  const auto find_on_foot = [&](const Place& a, const Place& b, Path& ground) {
    reset(ground);
    if (query.cancel != nullptr && *query.cancel) {
      gave_up = true;
      return false;
    }
    scratch.walker->find(a, b, ground, query.max_nodes);
    gave_up = gave_up || ground.end == PathEnd::kGaveUp;
    return ground.end == PathEnd::kReached;
  };
  End from, to;
  if (!locate(query.from, from) || !locate(query.to, to)) return;

  double on_foot = INFINITY;
  if (from.ground && to.ground && scratch.walker &&
      find_on_foot(from.ground, to.ground, scratch.walk_all)) {
    on_foot = 0;
    const auto& places = scratch.walk_all.points;
    for (size_t i = 1; i < places.size(); ++i) {
      on_foot += distance(places[i - 1].position, places[i].position);
    }
  }
  const auto add = [&](Vec3d point, LegKind kind) {
    if (!path.points.empty()) {
      path.length += distance(path.points.back(), point);
      path.legs.push_back(kind);
    }
    path.points.push_back(point);
  };
  const auto walk = [&](const Path& ground, size_t first) {
    for (size_t i = first; i < ground.points.size(); ++i) {
      add(ground.points[i].position, LegKind::kWalk);
    }
  };

  const bool ports = to_ports(from, to);
  SearchResult result = SearchResult::kNone;
  if (ports && shared_->space.hold_together(*from.air, *to.air)) {
    result = scratch.search.find(shared_->space, *from.air, *to.air, query.max_nodes, query.cancel,
                                 scratch.way);
    path.nodes = scratch.search.expanded();
    gave_up = gave_up || result == SearchResult::kBudget;
  }
  if (result == SearchResult::kFound) {
    scratch.pull.pull(shared_->space, scratch.way);
    bool walked = true;
    if (from.ground) {
      if (from.port.position.x != from.ground.position.x ||
          from.port.position.z != from.ground.position.z) {
        walked = find_on_foot(from.ground, from.port, scratch.walk_there);
        walk(scratch.walk_there, 0);
      } else {
        add(from.port.position, LegKind::kWalk);
      }
    }
    for (size_t i = 0; i < scratch.way.size(); ++i) {
      add(ends.to_metres(scratch.way[i]), i == 0 ? LegKind::kTakeOff : LegKind::kFly);
    }
    if (to.ground) {
      add(to.port.position, LegKind::kLand);
      if (to.port.position.x != to.ground.position.x ||
          to.port.position.z != to.ground.position.z) {
        walked = find_on_foot(to.port, to.ground, scratch.walk_on) && walked;
        walk(scratch.walk_on, 1);
      }
    }
    if (walked && path.length <= on_foot) {
      path.end = PathEnd::kReached;
      return;
    }
  }
  path.points.clear();
  path.legs.clear();
  path.length = 0;
  path.end = gave_up ? PathEnd::kGaveUp : PathEnd::kUnreachable;
  if (on_foot == INFINITY) return;
  walk(scratch.walk_all, 0);
  path.end = PathEnd::kReached;
}

Result<AirSummary> air_summary(const World& world) {
  if (world.data() == nullptr || world.data()->air == nullptr) {
    return Error{Errc::kNotFound, "the world was baked without air"};
  }
  const AirData& air = *world.data()->air;
  const AirShape& shape = air.shape;
  const auto height = [&](int32_t layer) {
    return (static_cast<double>(layer) * shape.cell + shape.origin_y) * 1e-3;
  };
  AirSummary summary{.cell = shape.cell * 1e-3,
                     .floor = height(shape.floor),
                     .ceiling = height(shape.ceiling),
                     .zones = air.slots.size(),
                     .bytes = air.bytes};
  for (const auto& slot : air.slots) {
    const AirData::ZoneAir zone = air.zone(slot->entry.x(), slot->entry.z());
    if (!zone.usable) return Error{Errc::kBadFile, slot->error};
    zone.tree->for_each([&](const AirCube& cube, uint32_t word) {
      if (air_kind(word) == AirKind::kFull) return;
      ++summary.nodes;
      if (air_kind(word) == AirKind::kLeaf) {
        summary.free_cells +=
            static_cast<uint64_t>(std::popcount(zone.tree->leaves[air_number(word)]));
        return;
      }
      const int32_t layers =
          std::min(cube.y + cube.side, shape.ceiling) - std::max(cube.y, shape.floor);
      summary.free_cells += static_cast<uint64_t>(std::max(layers, 0)) *
                            static_cast<uint64_t>(cube.side) * static_cast<uint64_t>(cube.side);
    });
  }
  return summary;
}

}  // namespace throng
