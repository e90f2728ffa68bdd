// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "path/edits/cluster_search.h"
#include "path/edits/ground_finder.h"
#include "path/edits/ground_view.h"
#include "path/edits/point_search.h"
#include "path/ground/search.h"

/// What a GroundFinder holds.
namespace throng::path {

struct GroundFinder::State {
  State(const World& world, const PathConfig& config) : mesh(world, config) {}
  explicit State(const GroundView& of) : mesh(of) {}

  bool locate(const Place& place, ViewStop& stop);
  void begin(const Place& start, const Place& goal, bool over_points = false);
  /// To the end of what has begun, of the slice, or of the budget of the whole search. False: the
  /// slice is spent.
  bool advance(const SearchBudget& budget, Slice& slice, Path& path);
  /// False: the search has more to expand.
  bool advance(uint64_t max_nodes, uint64_t max_bytes, Path& path);
  /// The exact search. None if points of portals have to be searched instead.
  std::optional<bool> advance_exactly(uint64_t max_bytes, Path& path);
  std::optional<bool> end_exactly(SearchResult result, const SearchBudget& budget, double length,
                                  Path& path);
  void begin_over_points();
  /// Is the ground around the start or the goal known to end before it comes to the other?
  bool is_cut_off();
  [[nodiscard]] Stop exact_stop(const ViewStop& stop);
  /// Of the corners that the exact search has found. False if no path can be drawn over them.
  bool give_exactly(double length, Path& path);
  /// Of `stops`.
  void give(Path& path);
  /// What a straight line meets first.
  FoundBlocker blocker(const ViewStop& start, const ViewStop& goal);
  /// The change that stopped a walk on a level; none if the bake did.
  FoundBlocker changed_beyond(const ViewLevel& level, const world::WalkStop& stop);

  GroundView mesh;
  PointSearch search;
  std::unique_ptr<ClusterSearch> clusters;  // null: no search by delays yet
  CostString string;
  Place from_place, to_place;
  ViewStop from, to;
  uint64_t version = 0;
  bool searching = false;
  IfUnreachable otherwise = IfUnreachable::kNearest;
  uint64_t expanded = 0;  // within the budget
  std::vector<ViewStop> stops;
  std::array<std::vector<ViewStop>, 2> sampled;  // points of two paths that are compared
  std::vector<uint8_t> paired;
  std::vector<uint32_t> pairs;

  // While no metre costs more than another, and no off-mesh link is in force.
  PathSearch exact;
  bool is_exact = false;
  uint64_t exact_nodes = 0;                      // that it may expand
  uint64_t nodes_before = 0;                     // that it has expanded, before points are searched
  bool was_flooded = false;                      // is_cut_off() was asked
  std::array<std::vector<uint32_t>, 2> flooded;  // rectangles around the start, and the goal
  std::vector<uint8_t> flooded_by;               // by rectangle: 1, 2, or 0 for none
  std::vector<uint32_t> corners;
  std::vector<Stop> exact_stops;
};

}  // namespace throng::path
