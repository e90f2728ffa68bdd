// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/quadtree.h"

#include <array>
#include <utility>

// From the cells up: what a block promises is the worst of its quarters, less the classes that
// cannot step between them. Then from the patch down: nodes where a promise gets better. Every cell
// is judged on its own, so a class has the same cells whichever other classes there are.
namespace throng {
namespace {

struct Block {
  Promise promise;
  uint16_t any = 0;      // classes that may stand on some cell
  bool uniform = false;  // every cell promises the same, and nothing is cut
};

class TreeBuilder {
 public:
  explicit TreeBuilder(const PatchCells& cells) : cells_(cells) {
    levels_.resize(static_cast<size_t>(cells.depth) + 1);
    auto& finest = levels_.back();
    finest.reserve(cells.cells.size());
    for (const Promise& p : cells.cells) finest.push_back({p, p.classes, true});
    for (int32_t level = cells.depth; level-- > 0;) merge(level);
    tree_.depth = cells.depth;
  }

  PatchTree build() && {
    const Block& whole = levels_[0][0];
    if (whole.any == 0) {
      tree_.leaf.assign(cells_.cells.size(), kNoNode);
      return std::move(tree_);
    }
    if (!whole.uniform) tree_.leaf.assign(cells_.cells.size(), kNoNode);
    visit(0, 0, 0, kNoNode);
    return std::move(tree_);
  }

 private:
  [[nodiscard]] const Block& at(int32_t level, int32_t s, int32_t t) const {
    return levels_[static_cast<size_t>(level)]
                  [(static_cast<size_t>(t) << level) + static_cast<size_t>(s)];
  }

  // Classes cut somewhere along the two lines that divide a block into quarters.
  [[nodiscard]] uint16_t cuts(int32_t level, int32_t s, int32_t t) const {
    if (cells_.cut_s.empty()) return 0;
    const int32_t size = 1 << (cells_.depth - level);  // of the block, in cells
    const int32_t s0 = s * size, t0 = t * size, middle = size / 2 - 1;
    uint32_t cut = 0;
    for (int32_t i = 0; i < size; ++i) {
      cut |= cells_.cut_s[cells_.index(s0 + middle, t0 + i)];
      cut |= cells_.cut_t[cells_.index(s0 + i, t0 + middle)];
    }
    return static_cast<uint16_t>(cut);
  }

  void merge(int32_t level) {
    auto& blocks = levels_[static_cast<size_t>(level)];
    const int32_t side = 1 << level;
    blocks.reserve(static_cast<size_t>(side) * static_cast<size_t>(side));
    for (int32_t t = 0; t < side; ++t) {
      for (int32_t s = 0; s < side; ++s) {
        const std::array<const Block*, 4> quarters = {
            &at(level + 1, 2 * s, 2 * t), &at(level + 1, 2 * s + 1, 2 * t),
            &at(level + 1, 2 * s, 2 * t + 1), &at(level + 1, 2 * s + 1, 2 * t + 1)};
        Block block = *quarters[0];
        for (size_t q = 1; q < 4; ++q) {
          block.uniform &= quarters[q]->uniform && quarters[q]->promise == quarters[0]->promise;
          block.promise = both(block.promise, quarters[q]->promise);
          block.any |= quarters[q]->any;
        }
        if (const uint16_t cut = cuts(level, s, t); cut != 0) {
          block.promise.classes = static_cast<uint16_t>(block.promise.classes & ~cut);
          block.uniform = false;
        }
        blocks.push_back(block);
      }
    }
  }

  void fill(int32_t level, int32_t s, int32_t t, uint32_t node) {
    const int32_t size = 1 << (cells_.depth - level);
    for (int32_t j = t * size; j < (t + 1) * size; ++j) {
      for (int32_t i = s * size; i < (s + 1) * size; ++i) tree_.leaf[cells_.index(i, j)] = node;
    }
  }

  void visit(int32_t level, int32_t s, int32_t t, uint32_t parent) {
    const Block& block = at(level, s, t);
    if (block.any == 0) return;
    uint32_t here = parent;
    const bool better = parent == kNoNode || block.promise != tree_.nodes[parent].promise;
    if (block.promise.classes != 0 && better) {
      here = static_cast<uint32_t>(tree_.nodes.size());
      if (parent != kNoNode) tree_.nodes[parent].terminal = false;
      tree_.nodes.push_back({.promise = block.promise,
                             .level = static_cast<uint8_t>(level),
                             .s = static_cast<uint8_t>(s),
                             .t = static_cast<uint8_t>(t),
                             .terminal = true,
                             .parent = parent});
    }
    if (block.uniform) {
      if (!tree_.leaf.empty()) fill(level, s, t, here);
      return;
    }
    for (int32_t q = 0; q < 4; ++q) visit(level + 1, 2 * s + q % 2, 2 * t + q / 2, here);
  }

  const PatchCells& cells_;
  std::vector<std::vector<Block>> levels_;
  PatchTree tree_;
};

}  // namespace

PatchTree build_tree(const PatchCells& cells) { return TreeBuilder(cells).build(); }

}  // namespace throng
