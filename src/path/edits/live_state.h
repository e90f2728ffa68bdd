// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "path/edits/live_mesh.h"
#include "path/edits/live_search.h"

/// What a LiveGround holds.
namespace throng {

struct LiveGround::State {
  explicit State(path::LiveMesh of) : mesh(std::move(of)) {}

  bool locate(const Place& place, path::LiveStop& stop);
  /// False: the search has more to expand.
  bool advance(uint64_t max_nodes, uint64_t max_bytes, Path& path);
  /// Of `stops`.
  void give(Path& path);
  /// What a straight line from its end to the goal meets first.
  Blocker blocker();

  path::LiveMesh mesh;
  path::LiveSearch search;
  path::LiveStringPuller straight;
  Place from_place, to_place;
  path::LiveStop from, to;
  uint64_t version = 0;
  bool searching = false;
  std::vector<path::LiveStop> stops;
};

}  // namespace throng
