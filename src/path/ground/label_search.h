// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "path/ground/hub_labels.h"
#include "path/ground/mesh.h"
#include "path/ground/sight.h"
#include "path/ground/string_puller.h"

/// Shortest paths looked up in hub labels.
namespace throng::path {

/// The path between two ends over the corners that they see. Owns its memory: one per thread.
class LabelSearch {
 public:
  /// As PathSearch::find, without a budget: the length of what it finds is the same up to rounding.
  bool find(const PathMesh& mesh, const HubLabels& labels, const Stop& from, const Stop& to,
            std::vector<uint32_t>& corners, double& length);

 private:
  struct ReachedHub {
    uint32_t search = 0;  // that set it
    uint32_t corner = 0;  // by which the hub is reached
    float length = 0;
  };
  struct Best {
    float length = 0;
    uint32_t hub = 0, first = 0, last = 0;
  };
  // A corner at which a path from an end may turn first.
  struct Turn {
    uint32_t corner = 0;
    float distance = 0;  // from the end [cells]
    float bound = 0;     // and in a straight line to the other end
    bool is_seen = false;
  };

  bool narrow(const PathMesh& mesh, const HubLabels& labels, const Stop& from, const Stop& to,
              float known, Best& best);
  bool join(const PathMesh& mesh, const HubLabels& labels, Best& best);
  bool merge(const PathMesh& mesh, const HubLabels& labels, const Stop& from, const Stop& to,
             Best& best);
  bool by_middles(const PathMesh& mesh, const HubLabels& labels, const Stop& from, const Stop& to,
                  std::vector<uint32_t>& corners, double& length);
  void trace(const HubLabels& labels, const Best& best, std::vector<uint32_t>& corners) const;

  Sight sight_;
  StringPuller pull_;
  std::vector<Waypoint> path_;
  std::vector<Turn> start_, goal_;
  std::vector<ReachedHub> reached_hubs_;  // per hub
  std::vector<float> from_, to_;          // to each candidate of the ends' blocks
  uint32_t search_ = 0;
};

}  // namespace throng::path
