// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "throng/surface.h"
#include "throng_draw/draw.h"
#include "view/ground_pick.h"

/// Nodes under the pointer, and what is shown of one.
namespace throng::view {

/// Calls visit(corners) for each square of ground of a node, in the order around it: one, or of a
/// partial node one a run of cells. [m, world]
template <class Visit>
void for_node_squares(const Nodes& nodes, uint32_t node, const NodeInfo& info, Visit visit) {
  if (info.cells == 0) return visit(nodes.corners(node));
  // The corners of its block may have no floor.
  constexpr double kCell = 1.0 / kTileCells, kSide = kCell - 1e-5;
  for_partial_runs(info.cells, [&](int32_t first, int32_t row, int32_t count) {
    const double s = (info.s * 8 + first) * kCell, t = (info.t * 8 + row) * kCell;
    const double end = s + (count - 1) * kCell + kSide;
    visit(std::array<Vec3d, 4>{nodes.point(node, s, t), nodes.point(node, s, t + kSide),
                               nodes.point(node, end, t + kSide), nodes.point(node, end, t)});
  });
}

/// The nodes that an overlay shows, as balls around them: 20 bytes each.
class DrawnNodes {
 public:
  explicit DrawnNodes(NodeBins edges) : bins(std::move(edges)) {}
  const NodeBins bins;  ///< Of the nodes' codes.
  /// Adds a node by all its squares. [m, world]
  void add(uint32_t node, const std::vector<std::array<Vec3d, 4>>& squares);
  /// The first node that a sight line meets, not above `cut` and no farther off. Line in the
  /// world's coordinates. Time: linear in the nodes. [m]
  [[nodiscard]] std::optional<uint32_t> first_on(const Nodes& nodes, const SightLine& line,
                                                 double cut, double farthest) const;

 private:
  struct Ball {
    float x = 0, y = 0, z = 0, radius = 0;
    uint32_t node = 0;
  };
  std::vector<Ball> balls_;
};

/// Adds the sides and rims of a cylinder. Relative to `origin`.
void add_cylinder(Marks& marks, const NodeCylinder& cylinder, Vec3d origin, Rgba sides, Rgba rim);

/// What the panel shows of the node that was picked.
struct NodeDetail {
  NodeInfo info;
  double inclination = 0, height = 0, headroom = 0, width = 0;  ///< [degrees, m]
  Vec3d middle;                                                 ///< [m, world]
};
[[nodiscard]] NodeDetail detail_of(const Nodes& nodes, const NodeBins& bins, uint32_t node);
/// Its outline and its cylinder.
[[nodiscard]] Marks picked_node_marks(const Nodes& nodes, uint32_t node, Vec3d origin);

}  // namespace throng::view
