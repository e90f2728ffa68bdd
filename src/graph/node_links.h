// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/quadtree.h"
#include "throng/surface.h"

/// Links between nodes, from which cells lie beside each other. Source: [PACS00] 1.2.3.6.
namespace throng::graph {

/// Trees of all patches; node n of patch p is node first[p] + n of all.
struct NodeForest {
  std::vector<PatchTree> trees;
  std::vector<uint32_t> first{0};  ///< patches + 1

  void add(PatchTree tree);
  [[nodiscard]] uint32_t size() const { return first.back(); }
  /// The smallest node of all that holds a cell, or kNoNode.
  [[nodiscard]] uint32_t leaf(uint32_t patch, size_t cell) const {
    const uint32_t node = trees[patch].leaf_of(cell);
    return trees[patch].nodes.empty() || node == kNoNode ? kNoNode : first[patch] + node;
  }
};

/// Two cells of different patches that lie beside each other, for the classes that can step from
/// one to the other and back.
struct CellPair {
  uint32_t patch_a = 0, cell_a = 0;
  uint32_t patch_b = 0, cell_b = 0;
  uint16_t classes = 0;
  LinkKind kind = LinkKind::kWalk;
  uint8_t side_a = 4, side_b = 4;  ///< Sides of the cells where they touch, like a patch's edges.
  uint32_t hole_link1 = 0;         ///< If they do not touch: number of the hole link, plus one.
  bool one_way = false;            ///< From a to b only.
  uint32_t spot = 0;               ///< Of a drop: where it begins, to some cells.
};

/// A link between two nodes of all, a < b: undirected for every class in `classes`.
struct NodeLink {
  uint32_t a = 0, b = 0;
  uint16_t classes = 0;
  LinkKind kind = LinkKind::kWalk;
  uint32_t hole_link1 = 0;  ///< As of the pair of cells; 0: the nodes touch.
  bool turned = false;      ///< The hole link leads from b to a.
  bool one_way = false;     ///< Only in the hole link's direction.
  uint32_t spot = 0;        ///< As of the pair of cells.
};

/// Links nodes whose cells lie beside each other. Of the nodes around one cell, a node is linked to
/// the largest around the other that is no more restrictive; where neither of two is, they are
/// linked for what both allow. What a smaller node could reach by its parents is not linked again:
/// a parent's classes go in and out of its children. Sorted by (a, b, kind), each pair once, or
/// as often as its classes need different hole links; drops once for every spot that they lead
/// from. A class that anywhere gets from one to the other without a step has no link over one.
class NodeLinker {
 public:
  explicit NodeLinker(const NodeForest& forest) : forest_(&forest) {}

  /// Cells of one patch. [cells are those that its tree was built from]
  void link_inside(uint32_t patch, const PatchCells& cells);
  void link(const CellPair& pair);
  /// All links so far, merged.
  [[nodiscard]] std::vector<NodeLink> take();

 private:
  void add(uint32_t a, uint32_t b, uint16_t classes, LinkKind kind);
  [[nodiscard]] const PatchNode& node(uint32_t patch, uint32_t id) const {
    return forest_->trees[patch].nodes[id - forest_->first[patch]];
  }
  /// Nodes that hold a cell, the smallest first.
  uint32_t chain(uint32_t patch, size_t cell, std::span<uint32_t> out) const;

  void link_chains(uint32_t patch_a, size_t cell_a, uint32_t patch_b, size_t cell_b,
                   uint16_t classes, LinkKind kind);

  const NodeForest* forest_;
  std::vector<NodeLink> links_;
  uint32_t hole_link1_ = 0;  // of the pair that is being linked
  bool one_way_ = false;
  uint32_t spot_ = 0;
};

/// Sorts pairs and makes one of those that name the same cells and sides, for all their classes.
void merge_cell_pairs(std::vector<CellPair>& pairs);

/// Merges and sorts links.
void merge_node_links(std::vector<NodeLink>& links);

}  // namespace throng::graph
