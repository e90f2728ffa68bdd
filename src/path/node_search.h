// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "graph/node_mesh.h"
#include "path/node_landmarks.h"
#include "throng/path.h"
#include "throng/search_budget.h"

/// A* over the portals between blocks of nodes.
namespace throng {

/// Somewhere in a block.
struct BlockPoint {
  uint32_t block = kNoNode;
  double s = 0, t = 0;
};

/// What a straight piece within a block costs.
class PieceCost {
 public:
  PieceCost(const NodeMesh& mesh, double slope_cost);

  /// Metres over the surface, and what they cost. Both ends lie in the patch's block.
  struct Piece {
    double length = 0, cost = 0;
  };
  [[nodiscard]] Piece operator()(uint32_t block, double s0, double t0, Vec3d from, double s1,
                                 double t1, Vec3d to) const;

 private:
  const NodeMesh* mesh_;
  double slope_cost_;
  std::vector<double> by_code_;  // cost of a metre on level tiles, by inclination
};

/// A portal as it is gone through.
struct Crossing {
  uint32_t portal = 0;
  bool backward = false;  ///< From b to a.
};

class NodeSearch {
 public:
  NodeSearch(const NodeMesh& mesh, const PieceCost& cost, const NodeLandmarks& landmarks)
      : mesh_(&mesh), cost_(&cost), landmarks_(&landmarks) {}

  /// Fills `way` with the portals from one to the other, or, if none leads there, to the crossing
  /// that comes nearest.
  PathEnd find(const BlockPoint& from, const BlockPoint& to, const SearchBudget& budget,
               std::vector<Crossing>& way);
  [[nodiscard]] double cost() const { return best_cost_; }
  [[nodiscard]] uint64_t looked_at() const { return looked_at_; }

 private:
  // A portal has two states: where it leads to b and where it leads to a.
  struct State {
    uint32_t query = 0;
    uint32_t parent = UINT32_MAX;
    double cost = 0;
    Vec3d at;
    bool closed = false;
  };
  struct Open {
    double estimate;
    uint32_t state;
  };

  void expand(uint32_t block, double s, double t, Vec3d at, double cost, uint32_t parent);
  void push(double estimate, uint32_t state);
  /// What is left to the goal at least, beyond a portal.
  [[nodiscard]] double left(uint32_t portal, Vec3d at) const;
  void trace(uint32_t state, std::vector<Crossing>& way) const;

  const NodeMesh* mesh_;
  const PieceCost* cost_;
  const NodeLandmarks* landmarks_;
  std::vector<State> states_;
  std::vector<Open> open_;
  uint32_t query_ = 0;
  Vec3d goal_;
  NodeLandmarks::Distances goal_far_{};
  double best_cost_ = 0;
  uint64_t looked_at_ = 0;
};

}  // namespace throng
