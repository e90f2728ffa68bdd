// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "path/ground/open_list.h"
#include "path/ground/search_states.h"
#include "path/ground/slice.h"
#include "path/surface/node_view.h"
#include "throng/path.h"

/// A* over the portals between blocks of nodes.
namespace throng::path {

/// What a metre costs in each block of a mesh, beside its length and slope, where nodes promise
/// little width (PathConfig::narrow_cost) or height (low_cost). Empty if both are 0.
[[nodiscard]] std::vector<double> added_costs(const graph::NodeMesh& mesh, double narrow_cost,
                                              double low_cost);

/// The cost of a straight piece within a block.
class PieceCost {
 public:
  /// `added`: added_costs of the mesh, which must live as long.
  PieceCost(const NodeView& view, double slope_cost, std::span<const double> added = {});

  /// Length over the surface in metres, and its cost. Both ends lie in the patch's block.
  struct Piece {
    double length = 0, cost = 0;
  };
  [[nodiscard]] Piece operator()(uint32_t block, double s0, double t0, Vec3d from, double s1,
                                 double t1, Vec3d to) const;

 private:
  const NodeView* view_;
  double slope_cost_;
  std::span<const double> added_;  // by block of the mesh
  std::vector<double> by_code_;    // cost of a metre on level tiles, by inclination
};

/// Which overlay cell each block of the mesh lies in, and which of them a search stays in.
struct SearchBounds {
  const uint32_t* overlay_cell_of_block = nullptr;  ///< Null: no bounds.
  uint32_t overlay_cell = 0;
};

class NodeSearch {
 public:
  NodeSearch(const NodeView& view, const PieceCost& cost) : view_(&view), cost_(&cost) {}

  /// Fills `crossings` with the portals from one to the other, or, if none leads there, to the
  /// crossing that comes nearest. Paths that cost `less_than` and more are not searched for.
  PathEnd find(const BlockPoint& from, const BlockPoint& to, const SearchBudget& budget,
               std::vector<Crossing>& crossings, const SearchBounds& within = {},
               double less_than = std::numeric_limits<double>::infinity());
  /// The same in parts: call advance with the same budget, which is that of the whole search, until
  /// it returns how the search ended. The view must not change in between.
  void begin(const BlockPoint& from, const BlockPoint& to, const SearchBounds& within = {},
             double less_than = std::numeric_limits<double>::infinity());
  std::optional<PathEnd> advance(const SearchBudget& budget, Slice& slice,
                                 std::vector<Crossing>& crossings);
  [[nodiscard]] double cost() const { return best_cost_; }
  [[nodiscard]] uint64_t expanded() const { return expanded_; }
  [[nodiscard]] uint64_t allocated_bytes() const;
  /// Of these, the maximum that stays allocated from one query to the next. [bytes]
  static constexpr uint64_t kKeptBytes = uint64_t{64} << 20;

 private:
  // A portal has two states: where it leads to b and where it leads to a.
  struct State {
    uint32_t search = 0;
    uint32_t parent = UINT32_MAX;
    double cost = 0;
    Vec3d at;
    bool closed = false;
  };
  struct Open {
    double estimate;
    uint32_t state;
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : state > other.state;
    }
  };

  static constexpr uint32_t kGoal = UINT32_MAX - 1, kStart = UINT32_MAX;

  std::optional<PathEnd> search(const SearchBudget& budget, Slice& slice,
                                std::vector<Crossing>& crossings);
  void arrive(const BlockPoint& in, Vec3d at, double cost, uint32_t parent);
  [[nodiscard]] uint64_t used_bytes() const;
  void give_back();
  void expand(const BlockPoint& from, Vec3d at, double cost, uint32_t parent);
  void push(double estimate, uint32_t state);
  void trace(uint32_t state, std::vector<Crossing>& crossings);

  const NodeView* view_;
  const PieceCost* cost_;
  SearchBounds within_;
  SearchStates<State> states_;
  OpenList<Open> open_;
  BlockPoint to_;
  Vec3d goal_;
  double min_factor_ = 1;  // of costs to the straight line
  double less_than_ = 0;
  double found_ = 0;        // cost of the best path to the goal so far
  uint32_t last_ = kStart;  // its last state
  double nearest_ = 0;      // of what was expanded, from the goal [m]
  uint32_t nearest_state_ = kStart;
  double best_cost_ = 0;
  uint64_t expanded_ = 0;
  uint64_t met_ = 0;  // states that this query has reached
};

}  // namespace throng::path
