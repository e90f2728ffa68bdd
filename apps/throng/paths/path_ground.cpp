// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "paths/path_ground.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "command.h"
#include "in_world.h"
#include "paths/boxes.h"

// The ends of `throng path` in a world, and its ground with what the options change.
namespace throng::app {

Error bad_end(const PathOptions& options, const Vec3d& position, const char* option,
              const std::string& what) {
  return bad_position(options.world, option, position, what);
}

Result<Vec3d> position_of(const World& world, const PathOptions& options,
                          const std::vector<double>& at, const char* option) {
  return position_in(world, options.world, option, at);
}

namespace {

// For a class that flies, in a world with air, that an option has put on the ground; else nothing.
std::string why_on_foot(const PathStage& stage) {
  const PathOptions& options = stage.options;
  const auto& classes = stage.world.summary().classes;
  if (!classes[static_cast<size_t>(stage.avatar_class)].flies || options.on_foot) return {};
  if (!options.changes_ground() || !air_summary(stage.world)) return {};
  return fmt::format(" (the path is on foot because of {}; leave it out for one through the air)",
                     options.ground_option());
}

}  // namespace

Result<Place> place_of(const PathStage& stage, const std::vector<double>& at, const char* option) {
  const PathOptions& options = stage.options;
  const Result<Vec3d> position = position_of(stage.world, options, at, option);
  if (!position) return position.error();
  const Place place = stage.world.find_place(stage.avatar_class, *position, options.tolerance);
  if (!place) {
    // Its zone may be damaged.
    const auto ok = options.memory ? stage.world.check_touched() : stage.world.check_ground();
    if (!ok) return ok.error();
    return bad_end(options, *position, option,
                   fmt::format("is no place where class {} can stand, within {} m up or down; see "
                               "`throng picture`, or give a larger --tolerance{}",
                               options.avatar_class, options.tolerance, why_on_foot(stage)));
  }
  return place;
}

Result<NodePlace> node_place_of(const PathStage& stage, PathFinder& finder,
                                const std::vector<double>& at, const char* option) {
  const PathOptions& options = stage.options;
  const Result<Vec3d> position = position_of(stage.world, options, at, option);
  if (!position) return position.error();
  const auto& classes = stage.world.summary().classes;
  const bool climbs = goes_over_nodes(classes[static_cast<size_t>(stage.avatar_class)]);
  const Place ground =
      climbs ? Place{} : stage.world.find_place(stage.avatar_class, *position, options.tolerance);
  const NodePlace place =
      finder.find_node_place(ground ? ground.position : *position, options.tolerance);
  if (!place) {
    return bad_end(options, *position, option,
                   fmt::format("is no place on nodes where class {} can be, within {} m; see "
                               "`throng picture --nodes`, or give a larger --tolerance",
                               options.avatar_class, options.tolerance));
  }
  return place;
}

namespace {

// A kind of ground, in the range of Edits.
Result<uint8_t> kind_of(double given, const char* option) {
  if (given >= 1 && given <= 63 && given == std::floor(given)) return static_cast<uint8_t>(given);
  return Error{
      Errc::kBadConfig,
      fmt::format("{}: {} is no kind of ground; kinds are whole numbers, 1 to 63", option, given)};
}

Error about(const char* option, const Error& error) {
  return {error.code, fmt::format("{}: {}", option, error.message)};
}

Result<void> add_areas(const PathOptions& options, Edits& edits) {
  for (size_t i = 0; i + 7 <= options.areas.size(); i += 7) {
    const auto box = box_of(std::span(options.areas).subspan(i).first<6>(), "--area");
    if (!box) return box.error();
    const auto kind = kind_of(options.areas[i + 6], "--area");
    if (!kind) return kind.error();
    if (auto added = edits.add_area(*box, *kind); !added) return about("--area", added.error());
  }
  return {};
}

bool has_area(const PathOptions& options, double kind) {
  for (size_t i = 6; i < options.areas.size(); i += 7) {
    if (options.areas[i] == kind) return true;
  }
  return false;
}

Result<void> set_area_costs(const PathStage& stage, Edits& edits) {
  const std::vector<double>& costs = stage.options.area_costs;
  for (size_t i = 0; i + 2 <= costs.size(); i += 2) {
    const auto kind = kind_of(costs[i], "--area-cost");
    if (!kind) return kind.error();
    if (auto ok = edits.set_area_cost(*kind, costs[i + 1]); !ok) {
      return about("--area-cost", ok.error());
    }
    if (stage.space == PathSpace::kNodes && !has_area(stage.options, costs[i])) {
      return Error{Errc::kBadConfig,
                   fmt::format("--area-cost: no --area has kind {}, and over nodes the kinds of "
                               "the bake do not count",
                               *kind)};
    }
  }
  return {};
}

// Both ends can be one place although the options differ: each takes the nearest.
Result<void> check_apart(const PathStage& stage, const Vec3d& start, const Vec3d& goal) {
  if (length(goal - start) > 0) return {};
  return bad_end(stage.options, start, "--off-mesh-link",
                 "is both ends of a link; give it two different places");
}

Result<OffMeshLink> link_of(const PathStage& stage, PathFinder& finder,
                            const std::vector<double>& from, const std::vector<double>& to) {
  constexpr const char* kOption = "--off-mesh-link";
  OffMeshLink link;
  if (stage.space == PathSpace::kNodes) {
    const auto start = node_place_of(stage, finder, from, kOption);
    if (!start) return start.error();
    const auto goal = node_place_of(stage, finder, to, kOption);
    if (!goal) return goal.error();
    if (auto ok = check_apart(stage, start->feet, goal->feet); !ok) return ok.error();
    link.from_on_nodes = *start;
    link.to_on_nodes = *goal;
    link.cost = length(goal->feet - start->feet);
    return link;
  }
  const auto start = place_of(stage, from, kOption);
  if (!start) return start.error();
  const auto goal = place_of(stage, to, kOption);
  if (!goal) return goal.error();
  if (auto ok = check_apart(stage, start->position, goal->position); !ok) return ok.error();
  link.from = *start;
  link.to = *goal;
  link.cost = length(goal->position - start->position);
  return link;
}

Result<void> add_links(const PathStage& stage, PathFinder& finder, Edits& edits) {
  const std::vector<double>& given = stage.options.off_mesh_links;
  for (size_t i = 0; i + 6 <= given.size(); i += 6) {
    const auto at = given.begin() + static_cast<ptrdiff_t>(i);
    const auto link = link_of(stage, finder, {at, at + 3}, {at + 3, at + 6});
    if (!link) return link.error();
    if (auto added = edits.add_off_mesh_link(*link); !added) {
      return about("--off-mesh-link", added.error());
    }
  }
  return {};
}

}  // namespace

Result<void> put_up(const PathStage& stage, PathFinder& finder, Edits& edits) {
  // Links first: their ends are places of the world as it was baked.
  if (auto ok = add_links(stage, finder, edits); !ok) return ok.error();
  if (auto ok = add_boxes(stage.options.blocks, edits); !ok) return ok.error();
  if (auto ok = add_areas(stage.options, edits); !ok) return ok.error();
  return set_area_costs(stage, edits);
}

}  // namespace throng::app
