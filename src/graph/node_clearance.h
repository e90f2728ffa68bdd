// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "graph/node_data.h"
#include "graph/node_surface.h"
#include "throng/surface.h"

/// How steep the ground is, and how tall and how wide a body passes, by what nodes promise.
namespace throng::graph {

/// A straight line of a patch's parameters; its ends may be the same.
struct PatchLine {
  double s0 = 0, t0 = 0, s1 = 0, t1 = 0;
};

/// Answers about one patch after the other. What is known of a patch is kept until the next one is
/// asked for. Not for several threads at a time.
class NodeClearances {
 public:
  /// The nodes' data must live as long.
  explicit NodeClearances(const NodeData& data);

  /// What holds at every place of a line on a node's patch, see Nodes::clearance.
  [[nodiscard]] NodeClearance along(int32_t avatar_class, uint32_t node, const PatchLine& line);
  /// See Nodes::fits.
  [[nodiscard]] bool fits(uint32_t node, double s, double t, const AvatarClass& body);

 private:
  /// A piece of ground, or of an open side of a patch, and what is around it.
  struct Ball {
    Vec3d middle;
    double radius = 0;
  };
  using Rows = std::vector<uint64_t>;
  // Where one class stands on a patch with at least some headroom.
  struct Region {
    int32_t avatar_class = 0;
    uint8_t headroom = 0;  // [code]
    Rows rows;             // Bit s of row t.
    std::vector<Ball> borders;
  };

  bool open(uint32_t node);
  [[nodiscard]] const format::Node& node_at(uint32_t local) const { return zone_->nodes()[local]; }
  [[nodiscard]] int32_t side() const { return 1 << surface_.depth; }
  [[nodiscard]] bool is_curved() const { return surface_.points != nullptr; }
  [[nodiscard]] uint64_t cells_of(uint32_t local, int32_t avatar_class) const;
  [[nodiscard]] uint16_t classes_at(uint32_t local, double s, double t) const;
  [[nodiscard]] double tallest(uint16_t classes, bool along_normal) const;
  [[nodiscard]] double gentlest(uint16_t classes) const;
  [[nodiscard]] bool is_around(uint32_t local, double s, double t) const;
  const Region& region(int32_t avatar_class, uint8_t headroom);
  [[nodiscard]] Ball ball_of(double s0, double t0, double s1, double t1) const;
  [[nodiscard]] double free_distance(const Region& region, double s, double t) const;
  [[nodiscard]] double rise(const Region& region, double s, double t, double radius,
                            double slope) const;
  [[nodiscard]] std::vector<double> breaks_of(const PatchLine& line,
                                              std::vector<uint32_t>& touched) const;
  [[nodiscard]] bool fits_beside(const AvatarClass& avatar, int32_t avatar_class, double s,
                                 double t, const AvatarClass& body);

  const NodeData& data_;
  double greatest_bottom_ = 0;  // of all classes [m]
  const NodeZone* zone_ = nullptr;
  uint32_t first_ = 0, end_ = 0;  // nodes of the patch, in its zone
  uint32_t zone_first_ = 0;       // the zone's first node, of all
  NodeSurface surface_;
  std::vector<Vec3d> middles_;  // of the patch's nodes, made when they are needed
  std::vector<uint8_t> has_middle_;
  std::vector<Region> regions_;
};

}  // namespace throng::graph
