// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "run/memory_bound.h"
#include "throng/path.h"
#include "throng/world.h"

namespace throng::app {

/// The options of `throng path`.
struct PathOptions {
  std::string world;
  std::string avatar_class = "adult";
  std::vector<double> from, to;
  double tolerance = 1.0;
  double spacing = PathQuery{}.spacing;
  int32_t threads = 0;
  bool fly = false;
  bool nodes = false;
  bool on_foot = false;
  std::vector<double> blocks;          // six numbers a box
  std::vector<double> off_mesh_links;  // six numbers a link
  std::vector<double> areas;           // six numbers a box, and a kind
  std::vector<double> area_costs;      // a kind and its cost
  double slope_cost = 0;
  double narrow_cost = 0, low_cost = 0;  // over nodes
  uint64_t search_bytes = SearchBudget::kDefaultBytes;
  MemoryBound memory = {};

  /// The first option that changes the ground, but not the air; or nothing.
  [[nodiscard]] std::string ground_option() const {
    if (!off_mesh_links.empty()) return "--off-mesh-link";
    if (!areas.empty()) return "--area";
    if (!area_costs.empty()) return "--area-cost";
    return slope_cost > 0 ? "--slope-cost" : "";
  }
  [[nodiscard]] bool changes_ground() const { return !ground_option().empty(); }
  [[nodiscard]] bool is_live() const { return !blocks.empty() || changes_ground(); }
};

void add_path_options(CLI::App& command, PathOptions& options);

/// What is searched: what the options name, else what the class moves over, as far as the world has
/// it. Fails with kBadConfig if options do not go together, and as air_summary does.
[[nodiscard]] Result<PathSpace> space_of(const PathOptions& options, const World& world,
                                         const AvatarClass& avatar);

}  // namespace throng::app
