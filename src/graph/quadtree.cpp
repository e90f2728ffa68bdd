// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/quadtree.h"

#include <array>
#include <bit>
#include <utility>

// From the cells up: what a block promises is the worst of its quarters, less the classes that
// cannot step between them. Then from the patch down: nodes where a promise gets better. Every cell
// is judged on its own, so a class has the same cells whichever other classes there are.
namespace throng::graph {
namespace {

struct Block {
  Promise promise;
  uint16_t any = 0;      // classes that may stand on some cell
  bool uniform = false;  // every cell promises the same, and nothing is cut
};

constexpr int32_t kPartialSide = 1 << kPartialDepth;

// A block of 8 x 8 cells in bits, 8 t + s.
class PartialBlock {
 public:
  struct Part {
    uint64_t cells = 0;
    Promise promise;
  };

  PartialBlock(const PatchCells& cells, int32_t s0, int32_t t0, uint16_t classes)
      : cells_(cells), s0_(s0), t0_(t0), classes_(classes) {
    for (int32_t bit = 0; bit < kPartialSide * kPartialSide; ++bit) {
      const size_t cell = index(bit);
      const auto set = [&](uint32_t of, std::array<uint64_t, 16>& masks) {
        for (of &= classes_; of != 0; of &= of - 1) {
          masks[static_cast<size_t>(std::countr_zero(of))] |= uint64_t{1} << bit;
        }
      };
      set(cells.cells[cell].classes, stands_);
      if (!cells.is_cut()) continue;
      set(cells.parted(cell, true), cut_s_);
      set(cells.parted(cell, false), cut_t_);
    }
  }

  // Of each cell, all of them.
  [[nodiscard]] std::array<uint16_t, 64> classes() const {
    std::array<uint16_t, 64> all;
    for (int32_t bit = 0; bit < kPartialSide * kPartialSide; ++bit) {
      all[static_cast<size_t>(bit)] = cells_.cells[index(bit)].classes;
    }
    return all;
  }

  // Inner parts before those around them.
  std::vector<Part> divide() {
    uint64_t all = 0;
    for (uint32_t left = classes_; left != 0; left &= left - 1) {
      all |= stands_[static_cast<size_t>(std::countr_zero(left))];
    }
    divide(classes_, all);
    return std::move(parts_);
  }

 private:
  [[nodiscard]] size_t index(int32_t bit) const {
    return cells_.index(s0_ + bit % kPartialSide, t0_ + bit / kPartialSide);
  }

  // Cells of a class beside those given, and these.
  [[nodiscard]] uint64_t grown(uint64_t cells, size_t c) const {
    constexpr uint64_t kFirst = 0x0101010101010101;
    const uint64_t here = cells & stands_[c];
    const uint64_t east = (here & ~cut_s_[c] & ~(kFirst << 7)) << 1;
    const uint64_t west = (here & ~kFirst) >> 1 & ~cut_s_[c];
    const uint64_t south = (here & ~cut_t_[c]) << 8;
    const uint64_t north = here >> 8 & ~cut_t_[c];
    return here | ((east | west | south | north) & stands_[c]);
  }

  // What is connected to some cells, by the steps of any of the classes.
  [[nodiscard]] uint64_t flood(uint64_t from, uint16_t classes) const {
    for (uint64_t last = 0; from != last;) {
      last = from;
      for (uint32_t left = classes; left != 0; left &= left - 1) {
        from |= grown(from, static_cast<size_t>(std::countr_zero(left)));
      }
    }
    return from;
  }

  // A connected part of some classes is one part for all of them whose cells in it are connected.
  // The others are divided again without these; where each falls into pieces, each piece is a part.
  void divide(uint16_t classes, uint64_t cells) {
    while (cells != 0) {
      const uint64_t part = flood(cells & (~cells + 1), classes);
      cells &= ~part;
      uint16_t whole = 0, split = 0;
      uint64_t of_whole = 0, of_split = 0;
      for (uint32_t left = classes; left != 0; left &= left - 1) {
        const auto c = static_cast<size_t>(std::countr_zero(left));
        const uint64_t own = stands_[c] & part;
        if (own == 0) continue;
        const auto bit = static_cast<uint16_t>(1u << c);
        const bool together = flood(own & (~own + 1), bit) == own;
        (together ? whole : split) |= bit;
        (together ? of_whole : of_split) |= own;
      }
      if (whole == 0) {
        // The first one's pieces, so that there are fewer left each time.
        const auto bit = static_cast<uint16_t>(split & (~split + 1));
        uint64_t own = stands_[static_cast<size_t>(std::countr_zero(bit))] & part;
        while (own != 0) {
          const uint64_t piece = flood(own & (~own + 1), bit);
          own &= ~piece;
          add(piece, bit);
        }
        split &= static_cast<uint16_t>(~bit);
        of_split = 0;
        for (uint32_t left = split; left != 0; left &= left - 1) {
          of_split |= stands_[static_cast<size_t>(std::countr_zero(left))] & part;
        }
        if (split != 0) divide(split, of_split);
        continue;
      }
      if (split != 0) divide(split, of_split);
      add(of_whole, whole);
    }
  }

  void add(uint64_t cells, uint16_t classes) {
    Promise promise{classes, 0, 15, 15};
    for (uint64_t left = cells; left != 0; left &= left - 1) {
      const Promise& cell = cells_.cells[index(static_cast<int32_t>(std::countr_zero(left)))];
      promise = both(promise, {classes, cell.inclination, cell.height, cell.headroom});
    }
    parts_.push_back({cells, promise});
  }

  const PatchCells& cells_;
  int32_t s0_, t0_;
  uint16_t classes_;
  std::array<uint64_t, 16> stands_{}, cut_s_{}, cut_t_{};
  std::vector<Part> parts_;
};

class TreeBuilder {
 public:
  explicit TreeBuilder(const PatchCells& cells) : cells_(cells) {
    last_level_ = cells.partial ? cells.depth - kPartialDepth : cells.depth;
    levels_.resize(static_cast<size_t>(last_level_) + 1);
    auto& finest = levels_.back();
    if (cells.partial) {
      const int32_t side = 1 << last_level_;
      finest.reserve(static_cast<size_t>(side) * static_cast<size_t>(side));
      for (int32_t t = 0; t < side; ++t) {
        for (int32_t s = 0; s < side; ++s) finest.push_back(min_block(s, t));
      }
    } else {
      finest.reserve(cells.cells.size());
      for (const Promise& p : cells.cells) finest.push_back({p, p.classes, true});
    }
    for (int32_t level = last_level_; level-- > 0;) merge(level);
    tree_.depth = cells.depth;
    tree_.leaf_depth = last_level_;
  }

  PatchTree build() && {
    const Block& whole = levels_[0][0];
    if (!whole.uniform || whole.any == 0) tree_.leaf.assign(levels_.back().size(), kNoNode);
    if (whole.any == 0) return std::move(tree_);
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
    if (!cells_.is_cut()) return 0;
    const int32_t size = 1 << (cells_.depth - level);  // of the block, in cells
    const int32_t s0 = s * size, t0 = t * size, middle = size / 2 - 1;
    uint32_t cut = 0;
    for (int32_t i = 0; i < size; ++i) {
      cut |= cells_.parted(cells_.index(s0 + middle, t0 + i), true);
      cut |= cells_.parted(cells_.index(s0 + i, t0 + middle), false);
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

  // Eight cells along a side at once.
  [[nodiscard]] Block min_block(int32_t s, int32_t t) const {
    const size_t first = cells_.index(s << kPartialDepth, t << kPartialDepth);
    Block block{cells_.cells[first], 0, true};
    uint32_t cut = 0;
    for (size_t j = 0; j < kPartialSide; ++j) {
      const size_t row = first + (j << cells_.depth);
      for (size_t i = row; i < row + kPartialSide; ++i) {
        const Promise& cell = cells_.cells[i];
        block.uniform &= cell == cells_.cells[first];
        block.promise = both(block.promise, cell);
        block.any |= cell.classes;
      }
      if (!cells_.is_cut()) continue;
      for (size_t i = row; i + 1 < row + kPartialSide; ++i) cut |= cells_.parted(i, true);
      for (size_t i = row; j + 1 < kPartialSide && i < row + kPartialSide; ++i) {
        cut |= cells_.parted(i, false);
      }
    }
    block.promise.classes = static_cast<uint16_t>(block.promise.classes & ~cut);
    block.uniform &= cut == 0;
    return block;
  }

  void fill(int32_t level, int32_t s, int32_t t, uint32_t node) {
    const int32_t size = 1 << (last_level_ - level);
    for (int32_t j = t * size; j < (t + 1) * size; ++j) {
      for (int32_t i = s * size; i < (s + 1) * size; ++i) tree_.leaf[leaf_index(i, j)] = node;
    }
  }

  [[nodiscard]] size_t leaf_index(int32_t s, int32_t t) const {
    return (static_cast<size_t>(t) << last_level_) + static_cast<size_t>(s);
  }

  void visit(int32_t level, int32_t s, int32_t t, uint32_t parent) {
    const Block& block = at(level, s, t);
    if (block.any == 0) return;
    const uint16_t above = parent == kNoNode ? uint16_t{0} : tree_.nodes[parent].promise.classes;
    if (cells_.partial && level == last_level_ && block.promise.classes != block.any) {
      // Classes that stand on all of it go with those that stand on a part.
      fill(level, s, t, parent);
      add_partial(level, s, t, parent, static_cast<uint16_t>(block.any & ~above));
      return;
    }
    uint32_t here = parent;
    const bool better = parent == kNoNode || block.promise != tree_.nodes[parent].promise;
    if (block.promise.classes != 0 && better) {
      here = static_cast<uint32_t>(tree_.nodes.size());
      add_node({.promise = block.promise}, level, s, t, parent);
    }
    if (block.uniform || level == last_level_) {
      if (!tree_.leaf.empty()) fill(level, s, t, here);
      return;
    }
    for (int32_t q = 0; q < 4; ++q) visit(level + 1, 2 * s + q % 2, 2 * t + q / 2, here);
  }

  // The classes that stand on a block, of which some do on a part of it only, and that no larger
  // node holds.
  void add_partial(int32_t level, int32_t s, int32_t t, uint32_t parent, uint16_t rest) {
    PartialBlock block(cells_, s << kPartialDepth, t << kPartialDepth, rest);
    const auto place = static_cast<uint32_t>(tree_.partial.size());
    tree_.leaf[leaf_index(s, t)] = static_cast<uint32_t>(tree_.nodes.size());
    tree_.partial.push_back(block.classes());
    for (const auto& [mask, promise] : block.divide()) {
      add_node({.promise = promise, .cells = mask, .partial = place}, level, s, t, parent);
    }
  }

  void add_node(PatchNode node, int32_t level, int32_t s, int32_t t, uint32_t parent) {
    if (parent != kNoNode) tree_.nodes[parent].terminal = false;
    node.level = static_cast<uint8_t>(level);
    node.s = static_cast<uint8_t>(s);
    node.t = static_cast<uint8_t>(t);
    node.parent = parent;
    tree_.nodes.push_back(node);
  }

  const PatchCells& cells_;
  int32_t last_level_ = 0;  // of blocks that are divided no further
  std::vector<std::vector<Block>> levels_;
  PatchTree tree_;
};

}  // namespace

PatchTree build_tree(const PatchCells& cells) { return TreeBuilder(cells).build(); }

}  // namespace throng::graph
