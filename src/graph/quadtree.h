// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Nodes of one patch, Bezier patch or level tile alike: a quadtree over its finest sub-patches,
/// the *cells*, from what each of them promises. Source: [PACS00] 1.2.3.
namespace throng::graph {

/// What a body may rely on anywhere in a sub-patch, always on the safe side. Codes are bins whose
/// edges stand in NodeBins.
struct Promise {
  uint16_t classes = 0;     ///< Bit per class: its body may stand anywhere there. 0: a hole.
  uint8_t inclination = 0;  ///< The steepest there; less is better.
  uint8_t height = 0;       ///< Free height along the body's axis; more is better.
  uint8_t headroom = 0;     ///< Free height straight up; more is better.

  friend bool operator==(const Promise&, const Promise&) = default;
};

/// The promise of two sub-patches together: the worse of each.
inline Promise both(const Promise& a, const Promise& b) {
  return {static_cast<uint16_t>(a.classes & b.classes),
          a.inclination > b.inclination ? a.inclination : b.inclination,
          a.height < b.height ? a.height : b.height,
          a.headroom < b.headroom ? a.headroom : b.headroom};
}

/// True if `a` promises all that `b` does: it is no more restrictive.
inline bool covers(const Promise& a, const Promise& b) { return both(a, b) == b; }

/// The smallest blocks of patches with partial nodes have 2^kPartialDepth cells along a side.
inline constexpr int32_t kPartialDepth = 3;

/// The finest sub-patches of one patch: 2^depth x 2^depth cells, cell = t * side + s.
struct PatchCells {
  int32_t depth = 0;
  /// Blocks of 2^kPartialDepth cells along a side are divided no further: what is left of them are
  /// partial nodes. [depth >= kPartialDepth]
  bool partial = false;
  std::vector<Promise> cells;
  /// Per cell, classes that may stand on it and on the next cell along s (along t), but cannot step
  /// from one to the other. Empty: none.
  std::vector<uint16_t> cut_s, cut_t;
  /// Per row of cells, bit s: the ground steps up or down to the next cell along s (along t). No
  /// node lies on both sides, for any class. Both are empty: nowhere.
  std::vector<uint64_t> step_s = {}, step_t = {};

  [[nodiscard]] int32_t side() const { return 1 << depth; }
  [[nodiscard]] size_t index(int32_t s, int32_t t) const {
    return (static_cast<size_t>(t) << depth) + static_cast<size_t>(s);
  }
  /// Does the ground step between a cell and the next along s, or along t?
  [[nodiscard]] bool steps(size_t cell, bool along_s) const {
    const std::vector<uint64_t>& rows = along_s ? step_s : step_t;
    return !rows.empty() && (rows[cell >> depth] >> (cell & ((size_t{1} << depth) - 1)) & 1) != 0;
  }
  [[nodiscard]] bool is_cut() const { return !cut_s.empty() || !step_s.empty(); }
  /// Classes for which no node may lie on both of a cell and the next. [is_cut()]
  [[nodiscard]] uint16_t parted(size_t cell, bool along_s) const {
    if (steps(cell, along_s)) return UINT16_MAX;
    const std::vector<uint16_t>& cuts = along_s ? cut_s : cut_t;
    return cuts.empty() ? uint16_t{0} : cuts[cell];
  }
};

inline constexpr uint32_t kNoNode = UINT32_MAX;

/// A block of cells on which a promise holds that is better than its parent's; or a *partial* node:
/// some cells of a block of 8 x 8. Its classes stand on some of these cells, each on cells that its
/// steps connect, and the rest of the promise holds on all of them.
struct PatchNode {
  Promise promise;
  uint64_t cells = 0;  ///< Partial: which of the block's, bit 8 t + s. 0: all, for all its classes.
  uint32_t partial = 0;       ///< Of such a node: which of the tree's partial blocks it lies in.
  uint8_t level = 0;          ///< Halvings from the whole patch: 2^level blocks along a side.
  uint8_t s = 0, t = 0;       ///< Which block of its level.
  bool terminal = true;       ///< No smaller node lies in it.
  uint32_t parent = kNoNode;  ///< The smallest node around it, of this patch.
};

/// Which bit of a partial node's mask a cell is. [cell of a patch of that depth]
inline uint32_t partial_bit(size_t cell, int32_t depth) {
  constexpr size_t kIn = (size_t{1} << kPartialDepth) - 1;
  return static_cast<uint32_t>(((cell >> depth) & kIn) << kPartialDepth | (cell & kIn));
}

struct PatchTree {
  int32_t depth = 0;
  std::vector<PatchNode> nodes;  ///< Parents first.
  /// Per cell the smallest node that holds it, or kNoNode. Of a patch with partial nodes per
  /// smallest block: its first partial node, if it has any; the others follow. Empty: node 0 for
  /// all.
  std::vector<uint32_t> leaf;
  int32_t leaf_depth = 0;  ///< Of the blocks in `leaf`, as halvings of a side.
  /// The classes that may stand on each cell of the blocks that have partial nodes.
  std::vector<std::array<uint16_t, 64>> partial;

  /// The smallest node that holds a cell, the first of them if they are partial; or kNoNode.
  [[nodiscard]] uint32_t leaf_of(size_t cell) const {
    const uint32_t node = first_of(cell);
    return node == kNoNode || nodes[node].cells == 0 ? node : first_from(node, cell);
  }

  /// The next larger of the nodes that hold a cell, or kNoNode.
  [[nodiscard]] uint32_t next_around(uint32_t node, size_t cell) const {
    const PatchNode& n = nodes[node];
    if (n.cells == 0) return n.parent;
    return is_beside(node + 1, n) ? first_from(node + 1, cell) : n.parent;
  }

  /// Does a cell lie in a block that has partial nodes?
  [[nodiscard]] bool is_partial(size_t cell) const {
    const uint32_t node = nodes.empty() ? kNoNode : first_of(cell);
    return node != kNoNode && nodes[node].cells != 0;
  }

  /// The classes that may stand on a cell.
  [[nodiscard]] uint16_t classes_on(size_t cell) const {
    const uint32_t node = nodes.empty() ? kNoNode : first_of(cell);
    if (node == kNoNode) return 0;
    const PatchNode& n = nodes[node];
    return n.cells == 0 ? n.promise.classes : partial[n.partial][partial_bit(cell, depth)];
  }

 private:
  [[nodiscard]] uint32_t first_of(size_t cell) const {
    if (leaf.empty()) return 0;
    const int32_t up = depth - leaf_depth;
    const size_t s = cell & ((size_t{1} << depth) - 1), t = cell >> depth;
    return leaf[(t >> up) << leaf_depth | s >> up];
  }

  // Is it another partial node of the same block?
  [[nodiscard]] bool is_beside(uint32_t node, const PatchNode& one) const {
    return node < nodes.size() && nodes[node].cells != 0 && nodes[node].partial == one.partial;
  }

  // Of a block's partial nodes from one on the first that holds a cell; else the node around them.
  [[nodiscard]] uint32_t first_from(uint32_t node, size_t cell) const {
    const PatchNode& one = nodes[node];
    for (; is_beside(node, one); ++node) {
      if ((nodes[node].cells >> partial_bit(cell, depth) & 1) != 0) return node;
    }
    return one.parent;
  }
};

/// A block gets a node if everything in it lets some class stand, and if it promises more than the
/// node around it: classes that can do more can do less, so a steep or low block keeps one node as
/// a whole, and what is better inside it nodes of its own. Of patches with partial nodes the
/// smallest blocks on which some class stands in part have partial nodes for all that no larger
/// node holds: as few as possible, with each class's cells in one connected. Linear in the cells.
[[nodiscard]] PatchTree build_tree(const PatchCells& cells);

}  // namespace throng::graph
