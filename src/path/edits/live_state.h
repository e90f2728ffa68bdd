// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "path/edits/live_finder.h"
#include "path/edits/live_mesh.h"
#include "path/edits/live_search.h"

/// What a LiveFinder holds.
namespace throng::path {

struct LiveFinder::State {
  explicit State(LiveMesh of) : mesh(std::move(of)) {}

  bool locate(const Place& place, LiveStop& stop);
  /// False: the search has more to expand.
  bool advance(uint64_t max_nodes, uint64_t max_bytes, Path& path);
  /// Of `stops`.
  void give(Path& path);
  /// What a straight line from its end to the goal meets first.
  Blocker blocker();

  LiveMesh mesh;
  LiveSearch search;
  LiveStringPuller straight;
  Place from_place, to_place;
  LiveStop from, to;
  uint64_t version = 0;
  bool searching = false;
  std::vector<LiveStop> stops;
};

}  // namespace throng::path
