// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "path/surface/node_search.h"

/// A string over blocks of nodes.
namespace throng::path {

/// A portal of a path, and where the path crosses it.
struct PulledCrossing {
  Crossing crossing;
  double along = 0.5;  ///< From the portal's start to its end.
  BlockPoint out, in;  ///< In the block that it leaves, and in the one that it enters.
  Vec3d out_at, in_at;
  Vec3d first_at, last_at;  ///< Ends of the portal, in the block that it leaves.
  double around = 0;        ///< Cost of the path from the crossing before to the one after.
  bool settled = false;     ///< It and its neighbours lie where they did when it was last moved.
};

/// Moves where a path crosses each portal, as long as that lowers its cost.
class NodeString {
 public:
  NodeString(const NodeView& view, const PieceCost& cost) : view_(&view), cost_(&cost) {}

  /// Pulls the path from one point to the other over `crossings` taut; `out` is where it crosses.
  void pull(const BlockPoint& from, const BlockPoint& to, const std::vector<Crossing>& crossings,
            std::vector<PulledCrossing>& out);

  static constexpr int kRounds = 48;
  static constexpr size_t kEnds = 0;
  void leave_out(std::vector<PulledCrossing>&) const {}  // All are needed: each is in its portal.
  bool move(std::vector<PulledCrossing>& crossings, int round) const;

 private:
  void place(PulledCrossing& crossing, double along) const;
  [[nodiscard]] double cost_around(const std::vector<PulledCrossing>& crossings, size_t i,
                                   const PulledCrossing& crossing) const;

  const NodeView* view_;
  const PieceCost* cost_;
  BlockPoint from_, to_;
  Vec3d from_at_, to_at_;
};

}  // namespace throng::path
