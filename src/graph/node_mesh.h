// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graph/node_surface.h"
#include "graph/portal_list.h"
#include "graph/quadtree.h"
#include "throng/base.h"
#include "throng/surface.h"

/// Nodes as one class sees them: where it can stand, as squares of patches, and where exactly it
/// gets from one to the next. Source: [PACS00] 1.2.3; docs/design/006-nodes.md.
namespace throng::graph {

/// A square of a patch on all of which the class may stand, and go straight by parameters: one of
/// the largest nodes that hold the class, or a part of it no larger than kLargestBlock; of a
/// partial node one of the largest squares of its quadtree on which it can.
struct NodeBlock {
  uint32_t patch = 0;
  uint32_t node = 0;
  uint8_t level = 0, s = 0, t = 0;  ///< One of 2^level x 2^level of the patch.
  uint8_t inclination = 15;         ///< Steepest surface in the node. [code]

  [[nodiscard]] double side() const { return 1.0 / (1 << level); }
};

inline constexpr double kLargestBlock = 4;  // [m]

/// How far a body goes from one end of a portal to the other: straight, or, where it drops, level
/// out and then down. [m]
[[nodiscard]] double portal_length(const NodePortal& portal, Vec3d out, Vec3d in);

/// Where a square of a patch comes among those of its level, in the order of a quadtree.
constexpr uint32_t quad_order(uint32_t s, uint32_t t, int32_t level) {
  uint32_t order = 0;
  for (int32_t k = level; k-- > 0;) order = order << 2 | (t >> k & 1) << 1 | (s >> k & 1);
  return order;
}

class NodeMesh {
 public:
  /// Reads all nodes once. Fails with kBadFile (a zone cannot be used) or kCancelled.
  [[nodiscard]] static Result<NodeMesh> create(const Nodes& nodes, int32_t avatar_class,
                                               int32_t workers, Context& context);

  [[nodiscard]] const Nodes& nodes() const { return nodes_; }
  [[nodiscard]] int32_t avatar_class() const { return avatar_class_; }
  [[nodiscard]] std::span<const NodeBlock> blocks() const { return blocks_; }
  [[nodiscard]] const PortalList& portals() const { return portals_; }
  [[nodiscard]] std::span<const NodeSurface> patches() const { return patches_; }
  [[nodiscard]] const NodeSurface& surface(uint32_t block) const {
    return patches_[blocks_[block].patch];
  }
  /// Portals of a block, to whichever side they lead.
  [[nodiscard]] std::span<const uint32_t> portals_of(uint32_t block) const {
    return std::span(portal_of_)
        .subspan(first_portal_[block], first_portal_[block + 1] - first_portal_[block]);
  }
  [[nodiscard]] std::span<const NodeBlock> blocks_of(uint32_t patch) const {
    return std::span(blocks_).subspan(first_block_[patch],
                                      first_block_[patch + 1] - first_block_[patch]);
  }
  [[nodiscard]] uint32_t first_block(uint32_t patch) const { return first_block_[patch]; }
  /// The block that holds the cell of a patch's parameters, or kNoNode.
  [[nodiscard]] uint32_t block_at(uint32_t patch, double s, double t) const;
  /// The patch of a level of the world, or kNoNode.
  [[nodiscard]] uint32_t patch_of_level(uint32_t level) const;
  [[nodiscard]] uint32_t patch_of_node(uint32_t node) const;
  /// Steepest inclination of a walk. [code]
  [[nodiscard]] uint8_t walking() const { return walking_; }
  [[nodiscard]] uint64_t bytes() const;

 private:
  NodeMesh(Nodes nodes, int32_t avatar_class) : nodes_(nodes), avatar_class_(avatar_class) {}

  void list_blocks(int32_t workers);
  [[nodiscard]] PortalList inside_patch(uint32_t patch) const;
  void open_doors();
  [[nodiscard]] PortalList over_tile(int32_t tile_x, int32_t tile_z) const;
  void add_hole_links();
  void index_portals();
  [[nodiscard]] LinkKind kind_between(uint32_t a, uint32_t b) const;

  Nodes nodes_;
  int32_t avatar_class_ = 0;
  uint8_t walking_ = 0;
  std::vector<NodeSurface> patches_;
  std::vector<uint32_t> first_node_;   // by patch, ascending
  std::vector<uint32_t> of_level_;     // patch, by level of the world
  std::vector<uint32_t> first_block_;  // by patch, and the end
  std::vector<NodeBlock> blocks_;      // of a patch in the order of its quadtree
  PortalList portals_;
  std::vector<uint32_t> first_portal_, portal_of_;
};

}  // namespace throng::graph
