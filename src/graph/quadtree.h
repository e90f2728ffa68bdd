// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// Nodes of one patch, Bezier patch or level tile alike: a quadtree over its finest sub-patches,
/// the *cells*, from what each of them promises. Source: [PACS00] 1.2.3.
namespace throng {

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

/// The finest sub-patches of one patch: 2^depth x 2^depth cells, cell = t * side + s.
struct PatchCells {
  int32_t depth = 0;
  std::vector<Promise> cells;
  /// Per cell, classes that may stand on it and on the next cell along s (along t), but cannot step
  /// from one to the other. Empty: none.
  std::vector<uint16_t> cut_s, cut_t;

  [[nodiscard]] int32_t side() const { return 1 << depth; }
  [[nodiscard]] size_t index(int32_t s, int32_t t) const {
    return (static_cast<size_t>(t) << depth) + static_cast<size_t>(s);
  }
};

inline constexpr uint32_t kNoNode = UINT32_MAX;

/// A block of cells on which a promise holds that is better than its parent's.
struct PatchNode {
  Promise promise;
  uint8_t level = 0;          ///< Halvings from the whole patch: 2^level blocks along a side.
  uint8_t s = 0, t = 0;       ///< Which block of its level.
  bool terminal = true;       ///< No smaller node lies in it.
  uint32_t parent = kNoNode;  ///< The smallest node around it, of this patch.
};

struct PatchTree {
  int32_t depth = 0;
  std::vector<PatchNode> nodes;  ///< Parents first.
  /// Per cell the smallest node that holds it, or kNoNode. Empty: node 0 for all.
  std::vector<uint32_t> leaf;

  [[nodiscard]] uint32_t leaf_of(size_t cell) const { return leaf.empty() ? 0 : leaf[cell]; }
};

/// A block gets a node if everything in it lets some class stand, and if it promises more than the
/// node around it: those who can do more can do less, so a steep or low block keeps one node as a
/// whole, and what is better inside it nodes of its own. Linear in the cells.
[[nodiscard]] PatchTree build_tree(const PatchCells& cells);

}  // namespace throng
