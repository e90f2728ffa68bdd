// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "path/ground/open_list.h"
#include "path/ground/slice.h"
#include "path/surface/node_search.h"

/// The arcs within one overlay cell of a mesh, with costs from one point or to one point.
namespace throng::path {

inline constexpr double kNoPath = std::numeric_limits<double>::infinity();

class OverlayGraph {
 public:
  OverlayGraph(const NodeView& view, const PieceCost& cost) : view_(&view), piece_(&cost) {}

  /// An arc out of a block of the overlay cell: into another one, or out of the overlay cell.
  struct Arc {
    Crossing crossing;
    BlockPoint out, in;
    Vec3d out_at, in_at;
    double through = 0;  ///< From `out` to `in`. [m]
    uint32_t into =
        graph::kNoNode;  ///< Place of its block in the overlay cell; none: it leads out.
  };

  /// Of these blocks, rising; `keep` stores the costs of all pieces, for many calls of run().
  void set(std::span<const uint32_t> blocks, bool keep);
  /// In the order of the blocks that they leave.
  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  /// The place of a crossing among them, or kNoNode.
  [[nodiscard]] uint32_t arc_of(const Crossing& crossing) const;
  /// The minimum cost from a point of the overlay cell to the end of each arc; infinite if it
  /// cannot be reached. Dijkstra's algorithm.
  const std::vector<double>& run(const BlockPoint& from);
  /// The minimum cost from the end of each arc to a point of the overlay cell.
  const std::vector<double>& run_back(const BlockPoint& to);
  /// Both in parts: begin one of them, then advance until it returns true; then costs() are known.
  void begin(const BlockPoint& from);
  void begin_back(const BlockPoint& to);
  bool advance(Slice& slice);
  bool advance_back(Slice& slice);
  [[nodiscard]] const std::vector<double>& costs() const { return cost_; }
  /// After run_back(): from a point of the overlay cell.
  [[nodiscard]] double rest(const BlockPoint& from) const;
  /// Arcs expanded since set().
  [[nodiscard]] uint64_t expanded() const { return expanded_; }

 private:
  struct Open {
    double cost;
    uint32_t arc;
    bool operator<(const Open& other) const {
      return cost != other.cost ? cost > other.cost : arc > other.arc;
    }
  };

  [[nodiscard]] uint32_t place_of(uint32_t block) const;
  [[nodiscard]] double piece(const BlockPoint& from, Vec3d at, const BlockPoint& to,
                             Vec3d to_at) const {
    return (*piece_)(from.block, from.s, from.t, at, to.s, to.t, to_at).cost;
  }
  void reach(uint32_t arc, double cost);
  bool next(Open& top, Slice& slice);

  const NodeView* view_;
  const PieceCost* piece_;
  std::span<const uint32_t> blocks_;
  std::vector<uint32_t> first_arc_;  // by place of the block that is left, and the end
  std::vector<Arc> arcs_;
  std::vector<uint32_t> first_in_, in_of_;  // by place of the block that is entered: arcs
  std::vector<size_t> first_kept_;
  std::vector<double> kept_;  // by arc, and arc out of the block that it enters
  std::vector<double> cost_;
  OpenList<Open> open_;
  BlockPoint goal_;
  Vec3d goal_at_;
  uint64_t expanded_ = 0;
};

}  // namespace throng::path
