// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_width.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "world/cell_blocks.h"

// The width of a node: how far its middle is from the nearest cell that is more restrictive, by a
// flood over cells from its middle.
namespace throng::graph {
namespace {

uint64_t key_of(uint32_t patch, uint32_t cell) { return uint64_t{patch} << 32 | cell; }

}  // namespace

// Assigned to their patches, then sorted there; of one cell they keep the order of the pairs.
CrossCells::CrossCells(std::span<const CellPair> pairs, size_t patches, int32_t workers)
    : first_(patches + 1, 0), key_(2 * pairs.size()), cell_(2 * pairs.size()) {
  for (const CellPair& p : pairs) {
    ++first_[p.patch_a + 1];
    ++first_[p.patch_b + 1];
  }
  for (size_t p = 0; p < patches; ++p) first_[p + 1] += first_[p];
  using Entry = std::pair<uint32_t, Cell>;
  std::vector<Entry> assigned(2 * pairs.size());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (const CellPair& p : pairs) {
    assigned[next[p.patch_a]++] = {p.cell_a, {p.patch_b, p.cell_b, p.classes, p.side_a}};
    assigned[next[p.patch_b]++] = {p.cell_b, {p.patch_a, p.cell_a, p.classes, p.side_b}};
  }
  parallel_for(patches, workers, [&](size_t p) {
    std::stable_sort(assigned.begin() + first_[p], assigned.begin() + first_[p + 1],
                     [](const Entry& a, const Entry& b) { return a.first < b.first; });
    for (size_t i = first_[p]; i < first_[p + 1]; ++i) {
      key_[i] = assigned[i].first;
      cell_[i] = assigned[i].second;
    }
  });
}

std::span<const CrossCells::Cell> CrossCells::beside(uint32_t patch, uint32_t cell) const {
  const auto [first, last] =
      std::equal_range(key_.begin() + first_[patch], key_.begin() + first_[patch + 1], cell);
  return {cell_.data() + (first - key_.begin()), static_cast<size_t>(last - first)};
}

namespace {

// A set of keys that is emptied often: slots of earlier rounds count as free.
class KeySet {
 public:
  void clear() {
    count_ = 0;
    if (++round_ != 0) return;
    std::fill(slots_.begin(), slots_.end(), Slot{});
    round_ = 1;
  }

  // False if the key was there already.
  bool insert(uint64_t key) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    Slot& slot = slot_of(key);
    if (slot.round == round_) return false;
    slot = {key, round_};
    ++count_;
    return true;
  }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t round = 0;
  };

  // The key's slot, or the free one where it belongs.
  Slot& slot_of(uint64_t key) {
    const size_t mask = slots_.size() - 1;
    size_t i = (key * 0x9E3779B97F4A7C15U) >> 32 & mask;
    while (slots_[i].round == round_ && slots_[i].key != key) i = (i + 1) & mask;
    return slots_[i];
  }

  void grow() {
    std::vector<Slot> old(std::max<size_t>(64, 2 * slots_.size()));
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.round == round_) slot_of(slot.key) = slot;
    }
  }

  std::vector<Slot> slots_;  // a power of two, at most half full
  size_t count_ = 0;
  uint32_t round_ = 1;
};

class Flood {
 public:
  Flood(const NodeForest& forest, uint32_t home, const CrossCells& cross, double max_width,
        std::span<const CellBalls> balls)
      : forest_(forest),
        home_(home),
        cross_(cross),
        max_width_(max_width),
        balls_(balls),
        round_seen_(forest.trees[home].leaf_depth < forest.trees[home].depth
                        ? 0
                        : size_t{1} << (2 * forest.trees[home].depth),
                    0) {}

  // A partial node has a more restrictive cell in its block, so it promises none.
  double width(const PatchNode& node) {
    if (node.cells != 0) return 0;
    const uint32_t patch = home_;
    const PatchTree& tree = forest_.trees[patch];
    const int32_t size = 1 << (tree.depth - node.level);
    const int32_t s0 = node.s * size, t0 = node.t * size;
    // The middle of a block of an even number of cells is a corner of four.
    middle_ = {};
    int32_t count = 0;
    for (int32_t t = (size - 1) / 2; t <= size / 2; ++t) {
      for (int32_t s = (size - 1) / 2; s <= size / 2; ++s, ++count) {
        const CellBall b = balls_[patch][cell_of(tree, s0 + s, t0 + t)];
        middle_ = {middle_.x + b.x, middle_.y + b.y, middle_.z + b.z, 0};
      }
    }
    middle_ = {middle_.x / count, middle_.y / count, middle_.z / count, 0};
    promise_ = node.promise;
    nearest_ = max_width_;
    is_home_known_ = tree.leaf_depth < tree.depth;
    if (is_home_known_ && ends_on_tile(tree, s0 + size / 2, t0 + size / 2)) return nearest_;
    seen_.clear();
    ++round_;
    ring_.clear();
    if (is_home_known_) {
      enter_rim(tree);
    } else {
      for (int32_t i = (size - 1) / 2; i <= size / 2; ++i) {
        for (int32_t j = (size - 1) / 2; j <= size / 2; ++j) {
          enter(patch, cell_of(tree, s0 + i, t0 + j));
        }
      }
    }
    while (!ring_.empty()) {
      last_.swap(ring_);
      ring_.clear();
      for (const auto& [p, cell] : last_) spread(p, cell);
    }
    return nearest_;
  }

 private:
  // Of a level tile, rows of bits give the nearest cell that is more restrictive, and a straight
  // line there crosses none that is. Is that nearer than the tile's rim, beyond which only the
  // flood finds it? The middle is the corner before cell (s, t). [0 < s, t < 64]
  bool ends_on_tile(const PatchTree& tree, int32_t s, int32_t t) {
    const world::CellRows& open = open_rows(tree);
    for (int32_t beyond = 0; beyond < 64; ++beyond) {
      bool any = false;
      for (const int32_t row : {t - 1 - beyond, t + beyond}) {
        if (row < 0 || row >= 64) continue;
        const uint64_t shut = ~open[static_cast<size_t>(row)];
        const uint64_t before = shut << (64 - s), after = shut >> s;
        any |= distance(home_, cell_of(tree, s, row)) < nearest_;
        if (before != 0) {
          nearest_ = std::min(
              nearest_, distance(home_, cell_of(tree, s - 1 - std::countl_zero(before), row)));
        }
        if (after != 0) {
          nearest_ =
              std::min(nearest_, distance(home_, cell_of(tree, s + std::countr_zero(after), row)));
        }
      }
      if (!any) break;
    }
    const int32_t rim = std::min({s, t, 64 - s, 64 - t});
    return nearest_ <= distance(home_, cell_of(tree, s - rim, t));  // as far off as its nearest
  }

  // The flood continues over the tile's rim.
  void enter_rim(const PatchTree& tree) {
    for (int32_t i = 0; i < 64; ++i) {
      for (const uint32_t cell :
           {cell_of(tree, 0, i), cell_of(tree, 63, i), cell_of(tree, i, 0), cell_of(tree, i, 63)}) {
        if (distance(home_, cell) < nearest_) ring_.push_back({home_, cell});
      }
    }
  }

  // The cells of the patch that promise what the node does.
  const world::CellRows& open_rows(const PatchTree& tree) {
    for (const auto& [promise, rows] : open_) {
      if (promise == promise_) return rows;
    }
    world::CellRows rows{};
    const int32_t blocks = 1 << tree.leaf_depth, size = 64 / blocks;
    for (int32_t t = 0; t < blocks; ++t) {
      for (int32_t s = 0; s < blocks; ++s) {
        const uint32_t first = cell_of(tree, s * size, t * size);
        const uint32_t leaf = tree.leaf_of(first);
        const bool partial = tree.is_partial(first);
        if (!partial && (leaf == kNoNode || !covers(tree.nodes[leaf].promise, promise_))) continue;
        for (int32_t j = 0; j < size; ++j) {
          uint64_t bits = (uint64_t{1} << size) - 1;
          if (partial) {
            bits = 0;
            for (int32_t i = 0; i < size; ++i) {
              bits |= uint64_t{covers_here(tree, cell_of(tree, s * size + i, t * size + j))} << i;
            }
          }
          rows[static_cast<size_t>(t * size + j)] |= bits << (s * size);
        }
      }
    }
    return open_.emplace_back(promise_, rows).second;
  }

  // Does a cell promise what the node does?
  [[nodiscard]] bool covers_here(const PatchTree& tree, uint32_t cell) const {
    const uint32_t leaf = tree.nodes.empty() ? kNoNode : tree.leaf_of(cell);
    if (leaf == kNoNode) return false;
    Promise here = tree.nodes[leaf].promise;
    here.classes = tree.classes_on(cell);
    return covers(here, promise_);
  }

  static uint32_t cell_of(const PatchTree& tree, int32_t s, int32_t t) {
    return (static_cast<uint32_t>(t) << tree.depth) + static_cast<uint32_t>(s);
  }

  // The least distance at which a cell can be.
  [[nodiscard]] double distance(uint32_t patch, uint32_t cell) const {
    const CellBall b = balls_[patch][cell];
    const double x = b.x - middle_.x, y = b.y - middle_.y, z = b.z - middle_.z;
    return std::max(0.0, std::sqrt(x * x + y * y + z * z) - b.radius);
  }

  void enter(uint32_t patch, uint32_t cell) {
    if (patch == home_) {
      if (is_home_known_ || round_seen_[cell] == round_) return;
      round_seen_[cell] = round_;
    } else if (!seen_.insert(key_of(patch, cell))) {
      return;
    }
    const double far = distance(patch, cell);
    if (far >= nearest_) return;
    const PatchTree& tree = forest_.trees[patch];
    if (!covers_here(tree, cell)) {
      nearest_ = far;
      return;
    }
    ring_.push_back({patch, cell});
  }

  void spread(uint32_t patch, uint32_t cell) {
    const PatchTree& tree = forest_.trees[patch];
    const int32_t side = 1 << tree.depth;
    const int32_t s = static_cast<int32_t>(cell) & (side - 1);
    const int32_t t = static_cast<int32_t>(cell) >> tree.depth;
    constexpr std::array<std::array<int32_t, 2>, 4> kBeside = {{{-1, 0}, {0, 1}, {1, 0}, {0, -1}}};
    for (uint8_t edge = 0; edge < 4; ++edge) {
      const int32_t i = s + kBeside[edge][0], j = t + kBeside[edge][1];
      if (i >= 0 && j >= 0 && i < side && j < side) {
        enter(patch, cell_of(tree, i, j));
        continue;
      }
      bool open = true;
      for (const CrossCells::Cell& next : cross_.beside(patch, cell)) {
        if (next.side != edge || (promise_.classes & ~next.classes) != 0) continue;
        enter(next.patch, next.cell);
        open = false;
      }
      // Where the ground ends, so does the flood.
      if (open) nearest_ = std::min(nearest_, distance(patch, cell));
    }
  }

  const NodeForest& forest_;
  uint32_t home_;               // the patch whose nodes are measured
  bool is_home_known_ = false;  // the nearest cell in it was found without a flood
  const CrossCells& cross_;
  double max_width_;
  std::span<const CellBalls> balls_;
  std::vector<std::pair<Promise, world::CellRows>> open_;  // by what is promised
  CellBall middle_;
  Promise promise_;
  double nearest_ = 0;
  std::vector<uint32_t> round_seen_;  // by cell of that patch: in which flood
  uint32_t round_ = 0;
  KeySet seen_;  // cells of others
  std::vector<std::pair<uint32_t, uint32_t>> ring_, last_;
};

}  // namespace

std::vector<double> node_widths(const NodeForest& forest, uint32_t patch, const CrossCells& cross,
                                double max_width, std::span<const CellBalls> balls) {
  Flood flood(forest, patch, cross, max_width, balls);
  std::vector<double> widths;
  widths.reserve(forest.trees[patch].nodes.size());
  for (const PatchNode& node : forest.trees[patch].nodes) {
    widths.push_back(flood.width(node));
  }
  return widths;
}

}  // namespace throng::graph
