// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/air_rows.h"

#include <algorithm>
#include <array>
#include <bit>

// Builds an octree of free cells from rows of bits. Linear in the cells / 64.
namespace throng::world {

AirRows::AirRows(int32_t w, int32_t h, int32_t d, bool free)
    : width(w), height(h), depth(d), words((w + 63) / 64) {
  bits.assign(static_cast<size_t>(words) * static_cast<size_t>(h) * static_cast<size_t>(d),
              free ? ~uint64_t{0} : 0);
}

void AirRows::fill(int32_t x0, int32_t x1, int32_t y, int32_t z, bool free) {
  x0 = std::max(x0, 0);
  x1 = std::min(x1, width);
  if (x0 >= x1 || y < 0 || y >= height || z < 0 || z >= depth) return;
  uint64_t* words_of = row(y, z);
  for (int32_t w = x0 >> 6; w <= (x1 - 1) >> 6; ++w) {
    const int32_t from = std::max(x0 - w * 64, 0), to = std::min(x1 - w * 64, 64);
    const uint64_t mask = (~uint64_t{0} >> (64 - (to - from))) << from;
    if (free) {
      words_of[w] |= mask;
    } else {
      words_of[w] &= ~mask;
    }
  }
}

uint64_t AirRows::block(int32_t x, int32_t y, int32_t z) const {
  uint64_t cells = 0;
  for (int32_t k = 0; k < 4; ++k) {
    for (int32_t j = 0; j < 4; ++j) {
      const uint64_t four = row(y + j, z + k)[x >> 6] >> (x & 63) & 15;
      cells |= four << (4 * j + 16 * k);
    }
  }
  return cells;
}

namespace {

class TreeMaker {
 public:
  TreeMaker(const AirTreeSource& source, AirTreeData& tree) : source_(source), tree_(tree) {}

  uint32_t make(const AirCube& cube) {
    const int32_t x = source_.x + cube.x, y = cube.y - source_.base, z = source_.z + cube.z;
    if (cube.x >= source_.width || cube.z >= source_.depth) return air_word(AirKind::kFull, 0);
    const bool beyond = y >= source_.rows->height || y + cube.side <= 0;
    if (beyond && !source_.free_beyond) return air_word(AirKind::kFull, 0);
    if (cube.side == AirTree::kLeafSide) {
      const uint64_t cells =
          (beyond ? ~uint64_t{0} : source_.rows->block(x, y, z)) & inside(cube.x, cube.z);
      if (cells == 0) return air_word(AirKind::kFull, 0);
      if (cells == ~uint64_t{0}) return air_word(AirKind::kFree, 0);
      tree_.leaves.push_back(cells);
      return air_word(AirKind::kLeaf, static_cast<uint32_t>(tree_.leaves.size() - 1));
    }
    if (beyond && cube.side <= source_.largest && cube.x + cube.side <= source_.width &&
        cube.z + cube.side <= source_.depth) {
      return air_word(AirKind::kFree, 0);
    }
    const int32_t half = cube.side / 2;
    std::array<uint32_t, 8> children;
    bool all_full = true, all_free = cube.side <= source_.largest;
    for (size_t c = 0; c < 8; ++c) {
      const auto i = static_cast<int32_t>(c);
      children[c] = make(
          {cube.x + (i & 1) * half, cube.y + (i >> 1 & 1) * half, cube.z + (i >> 2) * half, half});
      all_full = all_full && air_kind(children[c]) == AirKind::kFull;
      all_free = all_free && air_kind(children[c]) == AirKind::kFree;
    }
    if (all_full) return air_word(AirKind::kFull, 0);
    if (all_free) return air_word(AirKind::kFree, 0);
    const auto first = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.insert(tree_.nodes.end(), children.begin(), children.end());
    return air_word(AirKind::kInner, first);
  }

 private:
  // Cells of a block that are the world's.
  [[nodiscard]] uint64_t inside(int32_t x, int32_t z) const {
    uint64_t columns = 0, rows = 0;
    for (int32_t i = 0; i < 4; ++i) {
      if (x + i < source_.width) columns |= uint64_t{0x1111111111111111} << i;
      if (z + i < source_.depth) rows |= uint64_t{0xffff} << (16 * i);
    }
    return columns & rows;
  }

  const AirTreeSource& source_;
  AirTreeData& tree_;
};

int32_t floor_to(int32_t value, int32_t side) { return value & -side; }

}  // namespace

AirTreeData build_air_tree(const AirTreeSource& source) {
  AirTreeData tree;
  tree.side = static_cast<int32_t>(std::bit_ceil(static_cast<uint32_t>(std::max(source.side, 8))));
  tree.base = floor_to(source.base, tree.side);
  const int32_t top = source.base + source.rows->height;
  tree.roots = static_cast<uint32_t>((top - tree.base + tree.side - 1) / tree.side);
  tree.nodes.resize(tree.roots);
  TreeMaker maker(source, tree);
  for (uint32_t r = 0; r < tree.roots; ++r) {
    const uint32_t word =
        maker.make({0, tree.base + static_cast<int32_t>(r) * tree.side, 0, tree.side});
    tree.nodes[r] = word;
  }
  return tree;
}

}  // namespace throng::world
